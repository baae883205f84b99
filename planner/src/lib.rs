//! Mission planning for teams of quadcopters that fly one full circle around each of many targets
