//! Twin ropes side by side on each head in place of one rope, and the response of the back head to the
//! difference of their tensions.
use super::Influence;
use serde::{Deserialize, Serialize};

/// Twin ropes. The rope's values in [`super::Ropes`], [`super::Contact`] and the searched coefficients are
/// those of both ropes together: each rope has half of every stiffness, damping and mass.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TwinRopes {
    /// Distance of each rope from the machine's plane z = 0 \[m\].
    pub offset_m: f64,
    /// Length of the back rope at -z minus that of the one at +z \[m\].
    pub back_length_difference_m: f64,
    /// Length of the front rope at -z minus that of the one at +z \[m\].
    pub front_length_difference_m: f64,
    /// Number of out-of-plane (antisymmetric) modes of the back head that are simulated.
    pub modes: usize,
    /// Out-of-plane (antisymmetric) model of the back head.
    pub head: TwinHead,
}

/// Antisymmetric part of the reduced back head: mass-normalised modes and influence lines at `z = +offset_m`,
/// at the stations of [`super::ModalHead`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TwinHead {
    /// Natural frequencies of the antisymmetric modes, ascending \[Hz\].
    pub frequencies_hz: Vec<f64>,
    /// Outward radial shape of each antisymmetric mode at each station along the rope arc [m per unit modal
    /// coordinate].
    pub radial: Vec<Vec<f64>>,
    /// Tangential shape (towards increasing psi) of each antisymmetric mode at each station along the rope
    /// arc [m per unit modal coordinate].
    pub tangential: Vec<Vec<f64>>,
    /// Lateral shape (along z) of each antisymmetric mode at each station along the rope arc [m per unit
    /// modal coordinate].
    pub lateral: Vec<Vec<f64>>,
    /// Stress of each antisymmetric mode at each of four gauges [MPa per unit modal coordinate].
    pub gauge_stress_mpa: Vec<[f64; 4]>,
    /// Static gauge stress per pair of opposite unit forces on the two ropes [MPa/N]. Normal: inwards at +z
    /// and outwards at -z. Tangential: towards increasing psi at +z, opposite at -z.
    pub influence: Influence,
    /// Static stress of each of four gauges per newton along +z on either rope, at each station along the
    /// rope arc [MPa/N].
    pub lateral_mpa_per_n: Vec<[f64; 4]>,
}
