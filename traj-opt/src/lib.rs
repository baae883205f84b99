//! Optimal control by direct transcription: a structure-exploiting interior-point method, mesh refinement and an adaptive integrator
