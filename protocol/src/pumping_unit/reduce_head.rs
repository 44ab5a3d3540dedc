//! Reduce the flexible back head: from its mesh to modes along the rope arc and influence lines.
//!
//! It travels as a job of the pumping unit's own ([`crate::job::Job::Own`]), which this asks and
//! [`ReducedHead`] answers. Depends on nothing of the case: mesh, material, gauges and arc travel with the job (about 1 MB
//! for 14,000 bricks, 60 bytes per 10-node tetrahedron).
use super::{Influence, TwinHead};
use serde::{Deserialize, Serialize};

/// Name of the job that takes a [`ReduceHeadSpec`] and gives a [`ReducedHead`].
pub const REDUCE_HEAD: &str = "reduce_head";

/// What to reduce, and to what.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReduceHeadSpec {
    /// The head in the beam frame.
    pub mesh: HeadMesh,
    /// Young's modulus \[Pa\].
    pub young_pa: f64,
    /// Poisson's ratio \[1\].
    pub poisson: f64,
    /// Density [kg/m3].
    pub density_kg_m3: f64,
    /// The four gauges.
    pub gauges: [HeadGauge; 4],
    /// Centre of the rope arc \[m\].
    pub center_m: [f64; 2],
    /// Stations of shapes and influence lines, ascending \[deg\]; s.
    pub arc_deg: Vec<f64>,
    /// Stations of the static compliance \[deg\]; p.
    pub probes_deg: Vec<f64>,
    /// Number of modes n.
    pub modes: usize,
    /// Families of modes to take them from.
    pub families: Vec<ModeFamily>,
    /// Ropes as they lie in a turn: the modes that couple most to them and to the beam's motion are
    /// returned. Without any, the lowest.
    pub patterns: Vec<RopeWrap>,
    /// Two ropes on the head, where there are two: their tables are wanted as well.
    pub pair: Option<RopePair>,
    /// A static load whose field is wanted; with it the whole fields of all modes are returned.
    pub fields: Option<RopeWrap>,
}

/// A mesh that is its own mirror image in z = 0, or the half of one.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HeadMesh {
    /// Positions \[m\].
    pub nodes_m: Vec<[f64; 3]>,
    /// What its elements are.
    pub kind: ElementKind,
    /// Indices of nodes, element after element, in Gmsh's order.
    pub elements: Vec<u32>,
    /// Nodes of the pin holes, which are held.
    pub held: Vec<u32>,
    /// Faces of the surface under the rope: indices of nodes, face after face.
    pub rope_surface: Vec<u32>,
    /// Whether it is the half z >= 0 of the head.
    pub half: bool,
}

/// What a mesh consists of: all its elements are of one kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ElementKind {
    /// 8-node bricks with 4-node faces.
    #[default]
    Hexahedron,
    /// 10-node tetrahedra with 6-node faces.
    Tetrahedron,
}

impl ElementKind {
    /// Nodes of an element.
    pub const fn nodes(self) -> usize {
        match self {
            Self::Hexahedron => 8,
            Self::Tetrahedron => 10,
        }
    }

    /// Nodes of a face.
    pub const fn face_nodes(self) -> usize {
        match self {
            Self::Hexahedron => 4,
            Self::Tetrahedron => 6,
        }
    }
}

/// A strain gauge along y, read as stress: Young's modulus times strain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HeadGauge {
    /// Its middle in the beam frame \[m\].
    pub position_m: [f64; 3],
    /// Its length \[m\].
    pub length_m: f64,
}

/// How modes mirror in z = 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ModeFamily {
    /// Sideways displacement changes sign: the modes that a rope over the whole width drives.
    Symmetric,
    /// Displacement in the plane of motion changes sign.
    Antisymmetric,
}

/// A rope wrapped around the head, at rest.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RopeWrap {
    /// Its tension \[N\].
    pub tension_n: f64,
    /// Where it is fixed \[deg\].
    pub anchor_deg: f64,
    /// Where it leaves the arc \[deg\].
    pub leaves_deg: f64,
}

/// Two ropes side by side on the head.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RopePair {
    /// Distance of either from the plane z = 0 \[m\].
    pub offset_m: f64,
    /// Number of antisymmetric modes.
    pub modes: usize,
}

/// A reduced head.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReducedHead {
    /// Modes, lowest first; n.
    pub modes: Vec<HeadMode>,
    /// Modes that couple less, lowest first; empty without patterns.
    pub left_out: Vec<LeftOutMode>,
    /// Static gauge stress per newton at the stations.
    pub influence: Influence,
    /// Static gauge stress per unit base acceleration in x, y [MPa per m/s2] and about the pivot
    /// [MPa per rad/s2]; 3 x 4.
    pub inertia_stress_mpa: [[f64; 4]; 3],
    /// Outward radial displacement at probe j per inward newton at probe i [m/N]; p x p.
    pub compliance_m_per_n: Vec<Vec<f64>>,
    /// What two ropes ask for; none unless asked for.
    pub twin: Option<TwinHead>,
    /// Mass of the meshed steel \[kg\].
    pub mass_kg: f64,
    /// Its centre \[m\].
    pub center_of_mass_m: [f64; 2],
    /// Its moment of inertia about the pivot [kg m2].
    pub inertia_about_pivot_kg_m2: f64,
    /// Unknown displacements of the half that was solved.
    pub unknowns: usize,
    /// Solves that the modes took.
    pub lanczos_steps: usize,
    /// Wall time on the worker \[s\].
    pub wall_s: f64,
    /// Whole fields; none unless asked for.
    pub fields: Option<HeadFields>,
}

impl ReducedHead {
    /// Whether its modes were picked by how they couple to load patterns.
    pub const fn coupled(&self) -> bool {
        !self.left_out.is_empty()
    }
}

/// One mode of unit modal mass.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HeadMode {
    /// Its family.
    pub family: ModeFamily,
    /// Natural frequency \[Hz\].
    pub frequency_hz: f64,
    /// Outward radial displacement at the stations [m per unit modal coordinate]; s.
    pub radial: Vec<f64>,
    /// Tangential displacement towards increasing psi; s.
    pub tangential: Vec<f64>,
    /// Gauge stress [MPa per unit modal coordinate].
    pub gauge_stress_mpa: [f64; 4],
    /// Integrals of density times `(phi_x, phi_y, x phi_y - y phi_x)`.
    pub participation: [f64; 3],
    /// Largest share of any load pattern's static energy that it holds \[1\]; 0 without patterns.
    pub coupling: f64,
}

/// A mode that was looked at and not returned.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LeftOutMode {
    /// Its family.
    pub family: ModeFamily,
    /// Natural frequency \[Hz\].
    pub frequency_hz: f64,
    /// Largest share of any load pattern's static energy that it would hold \[1\].
    pub coupling: f64,
}

/// Fields over the whole mesh, for pictures: single precision.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HeadFields {
    /// Displacement per mode and node [m per unit modal coordinate].
    pub modes: Vec<Vec<[f32; 3]>>,
    /// Displacement per node under the wrapped rope \[m\].
    pub wrap_m: Vec<[f32; 3]>,
    /// Stress per element, at its centre, under the wrapped rope: xx, yy, zz, xy, yz, zx
    /// \[MPa\].
    pub wrap_stress_mpa: Vec<[f32; 6]>,
}
