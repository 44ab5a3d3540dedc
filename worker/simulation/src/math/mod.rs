//! Mathematics of the dynamics: elementary functions with the same bits everywhere, rotations,
//! splines. Knows nothing of machines.
pub mod elementary;
pub mod harmonics;
pub mod rotation;
pub mod spline;
