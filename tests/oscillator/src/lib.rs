//! Driven oscillator with an exact solution: a mass between two springs and a damper, which a shaker drives
//! or which is displaced and released. Displacement is measured in mm, the force on the foundation in N.
//!
//! ```text
//! m x'' + c (x' - b') + k (x - b) = F(t) - R sgn x'        reading of the force: y + lag y' = k (x - b) + c (x' - b')
//! ```
//!
//! Between two standstills every motion is a [sum](sum::Sum) of exponentials; [`motion`] joins these pieces,
//! so that no time integration is needed. Four effects ([`effect`]) and one unknown may be absent from the
//! model. [`record`] generates synthetic measurements with noise; [`simulator`] connects the model to a
//! worker; [`case_folder`] writes a case with such measurements. The crate depends on no search and reads no files.
pub mod case_folder;
pub mod effect;
pub mod motion;
pub mod record;
pub mod settings;
pub mod simulate;
pub mod simulator;
pub mod sum;
