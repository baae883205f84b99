//! Quadcopter dynamics: loiter speed and states, differentiable models, integration, control and simulation
