//! Two ropes side by side on each head in place of one, and how the back head answers to what they
//! pull against each other.
use super::Influence;
use serde::{Deserialize, Serialize};

/// Twin ropes. What [`super::Ropes`], [`super::Contact`] and the genes state of a rope is of both
/// together: each has half of every stiffness, damping and mass.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TwinRopes {
    /// Distance of either rope from the machine's plane \[m\].
    pub offset_m: f64,
    /// By how much the back rope at -z is longer than the one at +z \[m\].
    pub back_length_difference_m: f64,
    /// The same of the front ropes \[m\].
    pub front_length_difference_m: f64,
    /// Number of modes out of the plane that are simulated.
    pub modes: usize,
    /// The back head out of its plane.
    pub head: TwinHead,
}

/// The antisymmetric side of the reduced back head: mass-normalised modes and influence lines at
/// `z = +offset_m`, over the same stations as those of [`super::ModalHead`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TwinHead {
    /// Natural frequencies, ascending \[Hz\]; length a.
    pub frequencies_hz: Vec<f64>,
    /// Outward radial shape per mode and station [m per unit modal coordinate]; a x s.
    pub radial: Vec<Vec<f64>>,
    /// Tangential shape (towards increasing psi); a x s.
    pub tangential: Vec<Vec<f64>>,
    /// Shape along z; a x s.
    pub lateral: Vec<Vec<f64>>,
    /// Gauge stress per mode and gauge [MPa per unit modal coordinate]; a x 4.
    pub gauge_stress_mpa: Vec<[f64; 4]>,
    /// Stress per pair of opposite newtons: inwards at +z and outwards at -z; towards increasing psi
    /// at +z and back at -z.
    pub influence: Influence,
    /// Stress per newton along +z on either rope [MPa/N]; s x 4.
    pub lateral_mpa_per_n: Vec<[f64; 4]>,
}
