//! Many travelling salesmen: allocation, min-sum and min-max routes, tour splitting, improvement and certified bounds
