//! Identification of the effects that explain the residual: every effect of the library is tested, the
//! likeliest are refitted and compared with generic forces, and the best is accepted or rejected.
//! Localisation in the machine is not part of this module.
pub mod candidate;
pub(crate) mod decide;
pub(crate) mod generic_force;
pub(crate) mod joint_refit;
pub mod low_orders;
pub mod refit;
pub(crate) mod round;
pub mod signature;
pub(crate) mod trace;
pub(crate) mod valley_search;
