//! Identification of the effects that explain the residual: every effect of the library is tested, the
//! likeliest are refitted and compared with generic forces, and the best is accepted or rejected.
//! Localisation in the machine is not part of this module.
pub(crate) mod challenge;
pub(crate) mod decide;
pub mod low_orders;
pub mod refit;
pub(crate) mod round;
pub mod signature;
pub mod suspect;
pub(crate) mod together;
pub(crate) mod valley_search;
