//! Localisation of the disagreement between simulation and measurement: three maps, each with its own control
//! of false alarms, a test of whiteness, and the parameters that would have to vary along the abscissa or
//! with the condition.
//!
//! The maps are visual hints. The tests of named effects are far more powerful, and where motion is slow all
//! forces along one load path look nearly alike, so joints are given as sets.
pub mod joint;
pub(crate) mod latent;
pub mod order;
pub mod parameter_drift;
pub mod residual;
pub mod summary;
pub mod whiteness;
pub mod window_test;
