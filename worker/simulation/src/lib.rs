//! Rigid-flexible multibody dynamics of a double-horse-head pumping unit.
//!
//! Pure `f64`, SI units, radians; no clock, no files, no threads. The crank's motion is prescribed and every
//! rope joint is a force, so there are no constraints left and the equations of motion are a stiff ordinary
//! differential equation
//!
//! `M(q) a = Q(q, v, t)`
//!
//! in the rod angle, the suspension height, the beam angle, the modal coordinates of the back head and the
//! coordinates of every rope cylinder: three per cylinder of a rope in the plane of the machine, six per
//! cylinder of a rope that may leave the plane ([`model`] chooses).
#![expect(
    non_snake_case,
    reason = "notation of mechanics: R_WB, orientation of B in W, is a matrix and r_wb would be a vector"
)]
pub mod drive;
pub mod effect;
pub mod element;
pub mod flexible;
pub mod integrator;
pub mod linear;
pub mod math;
pub mod model;
mod norm;
pub mod observe;
pub mod reference;
pub mod rig;
pub mod run;
pub mod sensitivity;
pub mod settle;
mod state;
pub mod statistics;
pub mod system;
pub mod verdict;
