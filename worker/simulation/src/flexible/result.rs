//! Results of the model reduction of a head: modes, static influence lines, and the antisymmetric tables for
//! two ropes.
use super::{gauge::Term, request::Family};

/// Vibration mode of the head with unit modal mass.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Symmetry family of the mode.
    pub family: Family,
    /// Angular frequency of the mode [rad/s].
    pub frequency: f64,
    /// Outward radial displacement of the mode at the stations [kg^-1/2]; length s.
    pub radial: Vec<f64>,
    /// Tangential displacement of the mode at the stations, towards increasing angle psi [kg^-1/2]; length s.
    pub tangential: Vec<f64>,
    /// Stress of the mode at the gauges [Pa per unit modal coordinate]; length g.
    pub gauge_stress: Vec<f64>,
    /// Participation factors of the mode: integrals of density times `(phi_x, phi_y, x phi_y - y phi_x)`, its
    /// coupling to base acceleration in x, in y and about the origin.
    pub participation: [f64; 3],
    /// Largest share of any load pattern's static energy that the mode holds \[1\]; 0 without patterns.
    pub coupling: f64,
    /// Displacement of every node of the whole mesh in this mode; empty unless requested.
    pub field: Vec<[f64; 3]>,
}

/// Reduced model of a head, with s stations, g gauges, p probes and n modes.
#[derive(Clone, Debug, PartialEq)]
pub struct Reduction {
    /// Modes kept, lowest frequency first; length n.
    pub modes: Vec<Mode>,
    /// Candidate modes not kept because they couple less to the load patterns, lowest frequency first; empty
    /// without patterns.
    pub left_out: Vec<LeftOut>,
    /// Gauge stress per newton of inward normal force at each station [Pa/N]; s x g.
    pub normal_influence: Vec<Vec<f64>>,
    /// Gauge stress per newton of tangential force towards increasing psi at each station [Pa/N]; s x g.
    pub tangential_influence: Vec<Vec<f64>>,
    /// Static gauge stress per unit acceleration of the base in x, in y and about the pivot; 3 x g.
    pub inertia_stress: [Vec<f64>; 3],
    /// Stress of the gauges under the wrapped rope \[Pa\]; length g, empty without a wrapped rope.
    pub wrap_reading: Vec<f64>,
    /// Change of that stress when a gauge is moved along x, y and z [Pa/m], `None` where the body ends on both
    /// sides; length g, empty without a wrapped rope.
    pub wrap_gradient: Vec<[Option<f64>; 3]>,
    /// Outward radial displacement at probe j per newton inwards at probe i [m/N]; p x p.
    pub compliance: Vec<Vec<f64>>,
    /// Displacement of every mesh node under the wrapped rope \[m\]; empty unless fields are requested.
    pub wrap_field: Vec<[f64; 3]>,
    /// Stress at the centre of every element under the wrapped rope \[Pa\]: xx, yy, zz, xy, yz, zx; empty
    /// unless fields are requested.
    pub wrap_stress: Vec<[f64; 6]>,
    /// Stress on the surface under each load; `None` unless requested.
    pub surface: Option<SurfaceStress>,
    /// Antisymmetric modes and influence lines for a pair of ropes; `None` for a single rope.
    pub sway: Option<SwayTables>,
    /// Mass of the head \[kg\].
    pub mass: f64,
    /// Centre of mass of the head in the plane z = 0 \[m\].
    pub center_of_mass: [f64; 2],
    /// Moment of inertia of the head about the origin [kg m2].
    pub inertia: f64,
    /// Number of unknown displacements of the finite element model of the half.
    pub unknowns: usize,
    /// Number of linear solves (Lanczos steps) for all modes.
    pub lanczos_steps: usize,
}

/// Candidate mode that was computed but not kept in the reduced model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeftOut {
    /// Symmetry family of the mode.
    pub family: Family,
    /// Angular frequency of the mode [rad/s].
    pub frequency: f64,
    /// Largest share of any load pattern's static energy that the mode holds \[1\].
    pub coupling: f64,
}

/// Antisymmetric modes and influence lines of a reduced head: `a` modes of unit modal mass, lowest frequency
/// first, evaluated at the stations at `z = +offset`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SwayTables {
    /// Angular frequencies of the antisymmetric modes [rad/s]; length a.
    pub frequencies: Vec<f64>,
    /// Outward radial displacement of each mode at the stations [kg^-1/2]; a x s.
    pub radial: Vec<Vec<f64>>,
    /// Tangential displacement of each mode at the stations, towards increasing angle psi [kg^-1/2]; a x s.
    pub tangential: Vec<Vec<f64>>,
    /// Displacement of each mode along z at the stations [kg^-1/2]; a x s.
    pub lateral: Vec<Vec<f64>>,
    /// Stress of each mode at the gauges [Pa per unit modal coordinate]; a x g.
    pub gauge_stress: Vec<Vec<f64>>,
    /// Gauge stress per pair of unit forces at each station, inwards at z = +offset and outwards at z =
    /// -offset [Pa/N]; s x g.
    pub normal_influence: Vec<Vec<f64>>,
    /// Gauge stress per pair of unit forces at each station, towards increasing psi at z = +offset and
    /// opposite at z = -offset [Pa/N]; s x g.
    pub tangential_influence: Vec<Vec<f64>>,
    /// Gauge stress per pair of unit forces along +z at each station, at z = +offset and z = -offset [Pa/N];
    /// s x g.
    pub lateral_influence: Vec<Vec<f64>>,
}

/// Stress on the surface of the half z >= 0 of a head, under each of l loads.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceStress {
    /// Points of the surface, s of them: one at each node, several where faces meet at an edge.
    pub points: Vec<SurfacePoint>,
    /// Faces of the surface: indices of the points at their corners; a triangle repeats its last one.
    pub faces: Vec<[usize; 4]>,
    /// Stress at the points under each load: xx, yy, zz, xy, yz, zx, l x s. Loads, in this order: 1 N in all, inwards and
    /// uniform over each interval of the arc \[Pa/N\]; 1 N at the rope's fixed end, inwards and towards increasing psi
    /// \[Pa/N\]; unit accelerations of the base in x, in y and about the pivot; unit coordinates of the modes.
    pub stress: Vec<Vec<[f64; 6]>>,
}

/// Point of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Position of the point \[m\].
    pub place: [f64; 3],
    /// Outward unit normal at the point: the mean of its faces.
    pub normal: [f64; 3],
    /// Whether the point is held fixed.
    pub held: bool,
}

/// Terms of nodal displacements whose sum gives a gauge's reading on the half model.
pub(super) type Row = Vec<Term>;
