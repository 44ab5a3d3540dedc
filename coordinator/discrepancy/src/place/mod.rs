//! Where simulation and measurement disagree: three maps, each with its own control of false alarms,
//! whether what is left lies anywhere at all, and which parameters would have to wander with it.
//!
//! They are hints for the eye. The named test is far sharper than any of them, and where motion is slow
//! all forces along one load path look nearly alike, so joints come as sets.
pub mod along;
pub mod joint;
pub(crate) mod latent;
pub mod order;
pub mod residual;
pub mod wander;
pub mod whereabouts;
pub mod whiteness;
