//! Mathematics of the dynamics: bitwise reproducible elementary functions, harmonics, rotations, splines.
//! Independent of the machine model.
pub mod elementary;
pub mod harmonics;
pub mod real;
pub mod rotation;
pub mod spline;
pub mod vector;
