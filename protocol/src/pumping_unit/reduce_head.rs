//! Reduction of the flexible back head from its mesh to modes along the rope arc and influence lines.
//!
//! The reduction travels as a model-specific job of the pumping unit ([`crate::job::Job::Own`]) with a
//! [`ReduceHeadSpec`] as request and a [`ReducedHead`] as answer. It does not depend on the case: mesh,
//! material, gauges and arc travel with the job (about 1 MB for 14,000 bricks, 60 bytes per 10-node
//! tetrahedron).
use super::{HeadSurface, Influence, TwinHead};
use serde::{Deserialize, Serialize};

/// Name of the job with the request [`ReduceHeadSpec`] and the answer [`ReducedHead`].
pub const REDUCE_HEAD: &str = "reduce_head";

/// Request for the reduction of a head: mesh, material, gauges, stations and modes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReduceHeadSpec {
    /// Mesh of the head in the beam frame.
    pub mesh: HeadMesh,
    /// Young's modulus of the head \[Pa\].
    pub young_pa: f64,
    /// Poisson's ratio of the head \[1\].
    pub poisson: f64,
    /// Density of the head [kg/m3].
    pub density_kg_m3: f64,
    /// Strain gauges of the head whose stress is returned.
    pub gauges: [HeadGauge; 4],
    /// Centre of the rope arc in the beam frame \[m\].
    pub center_m: [f64; 2],
    /// Angles of the s stations along the rope arc at which shapes and influence lines are returned,
    /// ascending \[deg\].
    pub arc_deg: Vec<f64>,
    /// Angles of the p points on the rope arc between which the static compliance is returned \[deg\].
    pub probes_deg: Vec<f64>,
    /// Number n of head modes to return.
    pub modes: usize,
    /// Symmetry families from which the modes are taken.
    pub families: Vec<ModeFamily>,
    /// Rope positions over a turn, used as static load patterns: the modes that couple most to them and to
    /// the beam's motion are returned. If empty, the lowest modes are returned.
    pub patterns: Vec<RopeWrap>,
    /// Pair of ropes on the head of a twin-rope machine, for which the antisymmetric tables are returned as
    /// well.
    pub pair: Option<RopePair>,
    /// Static load under which the stress of the gauges and its gradient are returned.
    pub wrap: RopeWrap,
    /// Unit loads under which the stress on the surface is returned; `None` for no surface.
    pub surface: Option<SurfaceRequest>,
    /// Whether the displacement fields of all modes are returned, and displacement and stress under the
    /// static load.
    pub fields: bool,
}

/// Finite-element mesh of a head that is symmetric about z = 0, whole or half.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HeadMesh {
    /// Positions of the mesh nodes \[m\].
    pub nodes_m: Vec<[f64; 3]>,
    /// Type of all elements of the mesh.
    pub kind: ElementKind,
    /// Node indices, element after element, in Gmsh's node order.
    pub elements: Vec<u32>,
    /// Indices of the nodes at the pin holes, which are fixed.
    pub held: Vec<u32>,
    /// Faces of the surface under the rope: node indices, face after face.
    pub rope_surface: Vec<u32>,
    /// Whether the mesh is only the half z >= 0 of the head.
    pub half: bool,
}

/// Unit loads under which the stress on the surface of a head is requested: all of them may be more than one message
/// holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SurfaceRequest {
    /// Ends of the intervals of the rope's arc, ascending from its fixed end \[deg\].
    pub breaks_deg: Vec<f64>,
    /// Indices of the loads whose stress is returned, in this order, among those of
    /// [`HeadSurface::stress_mpa`](super::HeadSurface::stress_mpa).
    pub returned: Vec<u32>,
}

impl SurfaceRequest {
    /// Returns the number of the loads that are not modes, which come first.
    pub const fn statics(&self) -> usize {
        // one fewer intervals than ends, two forces, three accelerations
        self.breaks_deg.len() + 4
    }
}

/// Type of the elements of a mesh, the same for all.
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
    /// Returns the number of nodes of an element of this type.
    pub const fn nodes(self) -> usize {
        match self {
            Self::Hexahedron => 8,
            Self::Tetrahedron => 10,
        }
    }

    /// Returns the number of nodes of an element face of this type.
    pub const fn face_nodes(self) -> usize {
        match self {
            Self::Hexahedron => 4,
            Self::Tetrahedron => 6,
        }
    }
}

/// Strain gauge; its stress reading is Young's modulus times the mean strain over its length.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HeadGauge {
    /// Centre of the gauge in the beam frame \[m\].
    pub position_m: [f64; 3],
    /// Unit vector along the gauge in the beam frame.
    pub direction: [f64; 3],
    /// Gauge length \[m\].
    pub length_m: f64,
}

/// Symmetry of the head's modes about the plane z = 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ModeFamily {
    /// Lateral (z) displacement changes sign across z = 0: the modes excited by a rope over the whole width.
    Symmetric,
    /// In-plane displacement changes sign across z = 0.
    Antisymmetric,
}

/// Rope wrapped around the head, at rest; a static load of the reduction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RopeWrap {
    /// Tension of the wrapped rope \[N\].
    pub tension_n: f64,
    /// Angle on the rope arc at which the rope is fixed to the head \[deg\].
    pub anchor_deg: f64,
    /// Angle on the rope arc at which the rope leaves the head \[deg\].
    pub leaves_deg: f64,
}

/// Two ropes side by side on the head of a twin-rope machine.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RopePair {
    /// Distance of each rope from the plane z = 0 \[m\].
    pub offset_m: f64,
    /// Number of antisymmetric head modes to return.
    pub modes: usize,
}

/// Result of the reduction of a head: modes, influence lines, compliance and mass properties.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReducedHead {
    /// The n returned modes, lowest first.
    pub modes: Vec<HeadMode>,
    /// Modes that were computed but couple less than the returned ones, lowest first; empty unless the
    /// request has load patterns.
    pub left_out: Vec<OmittedMode>,
    /// Static gauge stress per newton of rope force, at each station along the rope arc.
    pub influence: Influence,
    /// Static gauge stress per unit acceleration of the beam along x and y [MPa per m/s2] and about the pivot
    /// [MPa per rad/s2]; 3 x 4.
    pub inertia_stress_mpa: [[f64; 4]; 3],
    /// Stress of each gauge under the static load \[MPa\].
    pub wrap_stress_mpa: [f64; 4],
    /// Change of that stress when the gauge is moved along x, y and z [MPa/m]; `None` along an axis on which
    /// the body ends on both sides of the gauge.
    pub wrap_gradient_mpa_per_m: [[Option<f64>; 3]; 4],
    /// Outward radial displacement of the arc at point j per newton of inward force at point i [m/N]; p x p.
    pub compliance_m_per_n: Vec<Vec<f64>>,
    /// Antisymmetric modes and influence lines of the head for twin ropes; `None` unless requested.
    pub twin: Option<TwinHead>,
    /// Mass of the meshed steel \[kg\].
    pub mass_kg: f64,
    /// Centre of mass of the meshed steel, x and y \[m\].
    pub center_of_mass_m: [f64; 2],
    /// Moment of inertia of the meshed steel about the pivot [kg m2].
    pub inertia_about_pivot_kg_m2: f64,
    /// Number of unknown displacements in the finite-element model of half the head, which is solved.
    pub unknowns: usize,
    /// Number of linear solves (Lanczos steps) with which the modes were computed.
    pub lanczos_steps: usize,
    /// Wall time of the reduction on the worker \[s\].
    pub wall_s: f64,
    /// Stress on the surface under unit loads; `None` unless requested.
    pub surface: Option<HeadSurface>,
    /// Displacement and stress fields over the whole mesh; `None` unless requested.
    pub fields: Option<HeadFields>,
}

impl ReducedHead {
    /// Returns whether the modes were selected by their coupling to load patterns.
    pub const fn coupled(&self) -> bool {
        !self.left_out.is_empty()
    }
}

/// Mode shape of the head with unit modal mass.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HeadMode {
    /// Symmetry family of the mode.
    pub family: ModeFamily,
    /// Natural frequency of the mode \[Hz\].
    pub frequency_hz: f64,
    /// Outward radial displacement of the mode at each station along the rope arc [m per unit modal
    /// coordinate].
    pub radial: Vec<f64>,
    /// Tangential displacement of the mode towards increasing psi at each station along the rope arc [m per
    /// unit modal coordinate].
    pub tangential: Vec<f64>,
    /// Stress of the mode at each gauge [MPa per unit modal coordinate].
    pub gauge_stress_mpa: [f64; 4],
    /// Integrals over the head of density times `(phi_x, phi_y, x phi_y - y phi_x)`, with the mode shape
    /// `phi`.
    pub participation: [f64; 3],
    /// Largest share of a load pattern's static energy that this mode represents \[1\]; 0 without load
    /// patterns.
    pub coupling: f64,
}

/// Mode of the head that was computed but not returned, because its coupling to the load is weaker.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OmittedMode {
    /// Symmetry family of the mode.
    pub family: ModeFamily,
    /// Natural frequency of the mode \[Hz\].
    pub frequency_hz: f64,
    /// Largest share of a load pattern's static energy that this mode would represent \[1\].
    pub coupling: f64,
}

/// Displacement and stress fields over the whole mesh of the head, for pictures, in single precision.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HeadFields {
    /// Displacement field of each mode: one displacement per node [m per unit modal coordinate].
    pub modes: Vec<Vec<[f32; 3]>>,
    /// Displacement of each node under the wrapped rope \[m\].
    pub wrap_m: Vec<[f32; 3]>,
    /// Stress at the centre of each element under the wrapped rope: xx, yy, zz, xy, yz, zx \[MPa\].
    pub wrap_stress_mpa: Vec<[f32; 6]>,
}
