//! A driven oscillator in closed form: a mass between two springs and a damper, which a shaker drives
//! or which is drawn aside and let go. Displacement is read in mm, the force on the foundation in N.
//!
//! ```text
//! m x'' + c (x' - b') + k (x - b) = F(t) - R sgn x'        reading of the force: y + lag y' = k (x - b) + c (x' - b')
//! ```
//!
//! Between two standstills every motion is a [sum](sum::Sum) of exponentials; [`motion`] puts them
//! together, so that nothing is integrated step by step. Four effects ([`effect`]) and one unknown may be missing in it.
//! [`record`] draws what a test rig would measure; [`simulator`] is how a worker sees it all. Nothing
//! here knows of searches or of files.
pub mod effect;
pub mod motion;
pub mod record;
pub mod settings;
pub mod simulate;
pub mod simulator;
pub mod sum;
