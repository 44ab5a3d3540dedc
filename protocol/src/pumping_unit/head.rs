//! Reduced model of the flexible back head: fixed-interface modes and static influence lines.
//!
//! Both are tables over the angle `psi` along the rope arc (about the arc's centre, beam frame).
use serde::{Deserialize, Serialize};

/// Mass-normalised fixed-interface modes of the back head, as stored in a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ModalHead {
    /// Natural frequencies of the n modes, ascending \[Hz\].
    pub frequencies_hz: Vec<f64>,
    /// Modal damping ratio, the same for every mode \[1\].
    pub damping_ratio: f64,
    /// Angles of the s stations along the rope arc at which shapes are tabulated, ascending \[deg\].
    pub arc_deg: Vec<f64>,
    /// Outward radial shape of each of n modes at each of s stations along the rope arc [m per unit modal
    /// coordinate].
    pub radial: Vec<Vec<f64>>,
    /// Tangential shape (towards increasing psi) of each of n modes at each of s stations along the rope arc
    /// [m per unit modal coordinate].
    pub tangential: Vec<Vec<f64>>,
    /// Gauge stress of each of n modes at each of four gauges [MPa per unit modal coordinate].
    pub gauge_stress_mpa: Vec<[f64; 4]>,
    /// Integrals over the head of density times `(phi_x, phi_y, x phi_y - y phi_x)`, with the shape `phi` of
    /// each mode; n x 3.
    pub participation: Vec<[f64; 3]>,
    /// Static gauge stress per unit acceleration of the beam along x and y [MPa per m/s2] and about the pivot
    /// [MPa per rad/s2]; 3 x 4.
    pub inertia_stress_mpa: [[f64; 4]; 3],
    /// Method that recovers gauge stress from modes and forces.
    pub stress: StressRecovery,
    /// Mass of the meshed steel \[kg\].
    pub mass_kg: f64,
    /// Static influence lines of the gauges.
    pub influence: Influence,
}

/// Method that recovers gauge stress from modal coordinates and forces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StressRecovery {
    /// Mode acceleration: exact static stress by influence lines, plus the deviation of the modes from their
    /// own static response.
    #[default]
    ModeAcceleration,
    /// Mode displacement: stress from the modes alone; the static contribution of truncated modes is lost.
    ModeDisplacement,
}

/// Static influence lines: gauge stress per unit force of the rope, depending on the force's position on the
/// rope arc.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Influence {
    /// Angles of the s stations along the rope arc at which the influence lines are tabulated, ascending
    /// \[deg\].
    pub psi_deg: Vec<f64>,
    /// Stress of each of four gauges per newton of inward normal force at each of s stations [MPa/N].
    pub normal_mpa_per_n: Vec<[f64; 4]>,
    /// Stress of each of four gauges per newton of tangential force towards increasing psi at each of s
    /// stations [MPa/N].
    pub tangential_mpa_per_n: Vec<[f64; 4]>,
}
