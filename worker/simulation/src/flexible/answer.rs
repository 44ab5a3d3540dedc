//! A reduced head: modes, static influence lines, what two ropes ask for beside.
use super::request::Family;

/// One mode of unit modal mass.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Its family.
    pub family: Family,
    /// Angular frequency [rad/s].
    pub frequency: f64,
    /// Outward radial displacement at the stations [kg^-1/2]; s.
    pub radial: Vec<f64>,
    /// Tangential displacement towards increasing psi; s.
    pub tangential: Vec<f64>,
    /// Stress at the gauges [Pa per unit modal coordinate]; g.
    pub gauge_stress: Vec<f64>,
    /// Integrals of density times `(phi_x, phi_y, x phi_y - y phi_x)`.
    pub participation: [f64; 3],
    /// Largest share of any load pattern's static energy that it holds \[1\]; 0 without patterns.
    pub coupling: f64,
    /// Displacement of every node of the whole mesh; empty unless asked for.
    pub field: Vec<[f64; 3]>,
}

/// A reduced head.
#[derive(Clone, Debug, PartialEq)]
pub struct Reduction {
    /// Modes, lowest first; n.
    pub modes: Vec<Mode>,
    /// Modes that couple less to the load patterns, lowest first; empty without patterns.
    pub left_out: Vec<LeftOut>,
    /// Stress per newton of inward normal force [Pa/N], station by station; s x g.
    pub normal_influence: Vec<Vec<f64>>,
    /// Stress per newton of tangential force towards increasing psi; s x g.
    pub tangential_influence: Vec<Vec<f64>>,
    /// Stress per unit base acceleration in x, y and about the pivot; 3 x g.
    pub inertia_stress: [Vec<f64>; 3],
    /// Outward radial displacement at probe j per inward newton at probe i [m/N]; p x p.
    pub compliance: Vec<Vec<f64>>,
    /// Displacement of every node under the wrapped rope \[m\]; empty without one.
    pub wrap_field: Vec<[f64; 3]>,
    /// Stress at every element's centre under the wrapped rope \[Pa\]: xx, yy, zz, xy, yz, zx.
    pub wrap_stress: Vec<[f64; 6]>,
    /// What two ropes ask for, where there are two.
    pub sway: Option<SwayTables>,
    /// Mass \[kg\].
    pub mass: f64,
    /// Centre of mass in the plane \[m\].
    pub center_of_mass: [f64; 2],
    /// Moment of inertia about the origin [kg m2].
    pub inertia: f64,
    /// Unknown displacements of the symmetric half.
    pub unknowns: usize,
    /// Solves that all modes took.
    pub lanczos_steps: usize,
}

/// A mode that was looked at and not kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeftOut {
    /// Its family.
    pub family: Family,
    /// Angular frequency [rad/s].
    pub frequency: f64,
    /// Largest share of any load pattern's static energy that it would hold \[1\].
    pub coupling: f64,
}

/// The antisymmetric side of a reduced head; a modes of unit modal mass, lowest first, seen at the
/// stations at `z = +offset`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SwayTables {
    /// Angular frequencies [rad/s]; a.
    pub frequencies: Vec<f64>,
    /// Outward radial displacement [kg^-1/2]; a x s.
    pub radial: Vec<Vec<f64>>,
    /// Tangential displacement towards increasing psi; a x s.
    pub tangential: Vec<Vec<f64>>,
    /// Displacement along z; a x s.
    pub lateral: Vec<Vec<f64>>,
    /// Stress at the gauges [Pa per unit modal coordinate]; a x g.
    pub gauge_stress: Vec<Vec<f64>>,
    /// Stress per newton inwards at +offset and one outwards at -offset [Pa/N]; s x g.
    pub normal_influence: Vec<Vec<f64>>,
    /// Stress per newton towards increasing psi at +offset and one back at -offset; s x g.
    pub tangential_influence: Vec<Vec<f64>>,
    /// Stress per newton along +z at either; s x g.
    pub lateral_influence: Vec<Vec<f64>>,
}

/// Row of `u_y` factors of a gauge on the half, and whether the gauge sits on the image.
pub(super) type Row = (Vec<(usize, f64)>, bool);
