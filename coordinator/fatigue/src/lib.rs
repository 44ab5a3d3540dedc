//! Fatigue life of a stress history: rainflow cycles, mean stress correction, curves of allowable stress range, and
//! the linear accumulation of damage.
//!
//! Stresses are in megapascals. A history is one period of a repeated load, so that its start does not matter. The
//! module knows neither machines nor files.
mod curve;
mod damage;
mod mean_stress;
mod rainflow;
mod surface;
mod tensor;

pub use curve::{Curve, CurveError, categories};
pub use damage::{Assessment, damage};
pub use mean_stress::MeanStress;
pub use rainflow::{Residue, StressCycle, cycles};
pub use surface::{Criterion, LoadPeriod, PointDamage, StressedSurface};
pub use tensor::{Tensor, directions, normal_stress, signed_von_mises, von_mises};
