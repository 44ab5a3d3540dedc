//! Twin ropes side by side on each head in place of one rope, and the response of the back head to the
//! difference of their tensions.
use super::Influence;
use serde::{Deserialize, Serialize};

/// Twin ropes. The values of a rope in [`super::Ropes`], [`super::Contact`] and the genes are those of both
/// ropes together: each has half of every stiffness, damping and mass.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TwinRopes {
    /// Distance of each rope from the machine's plane z = 0 \[m\].
    pub offset_m: f64,
    /// Length of the back rope at -z minus that of the one at +z \[m\].
    pub back_length_difference_m: f64,
    /// Length of the front rope at -z minus that of the one at +z \[m\].
    pub front_length_difference_m: f64,
    /// Number of out-of-plane (antisymmetric) modes that are simulated.
    pub modes: usize,
    /// Out-of-plane (antisymmetric) model of the back head.
    pub head: TwinHead,
}

/// Antisymmetric part of the reduced back head: mass-normalised modes and influence lines at `z = +offset_m`,
/// at the stations of [`super::ModalHead`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TwinHead {
    /// Natural frequencies of the a antisymmetric modes, ascending \[Hz\].
    pub frequencies_hz: Vec<f64>,
    /// Outward radial shape per mode and station [m per unit modal coordinate]; a x s.
    pub radial: Vec<Vec<f64>>,
    /// Tangential shape (towards increasing psi) per mode and station [m per unit modal coordinate]; a x s.
    pub tangential: Vec<Vec<f64>>,
    /// Lateral shape along z per mode and station [m per unit modal coordinate]; a x s.
    pub lateral: Vec<Vec<f64>>,
    /// Gauge stress per mode and gauge [MPa per unit modal coordinate]; a x 4.
    pub gauge_stress_mpa: Vec<[f64; 4]>,
    /// Static gauge stress per pair of opposite unit forces on the two ropes [MPa/N]. Normal: inwards at +z
    /// and outwards at -z. Tangential: towards increasing psi at +z, opposite at -z.
    pub influence: Influence,
    /// Static gauge stress per newton along +z on either rope [MPa/N]; s x 4.
    pub lateral_mpa_per_n: Vec<[f64; 4]>,
}
