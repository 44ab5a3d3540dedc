//! Loads of the back head over a revolution, and its surface stress under unit loads: together they give the stress
//! history of every point of the surface.
use serde::{Deserialize, Serialize};

/// Loads of the back head over the recorded revolution, one value per crank angle reached.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HeadLoads {
    /// Inward normal force of the rope in each interval of [`super::Machine::load_breaks_deg`], interval by interval \[N\].
    pub normal_n: Vec<Vec<f32>>,
    /// Force of the rope's fixed end on the head, inwards and towards increasing psi \[N\].
    pub anchor_n: [Vec<f32>; 2],
    /// Acceleration of the beam frame along its x and y, with gravity as an acceleration upwards [m/s2], and about the
    /// pivot [rad/s2].
    pub acceleration: [Vec<f32>; 3],
    /// Modal coordinates less their static response to these loads, mode by mode [kg^1/2 m].
    pub modal: Vec<Vec<f32>>,
}

impl HeadLoads {
    /// Iterates over the load curves, in the order of the unit loads of [`HeadSurface::stress_mpa`].
    pub fn curves(&self) -> impl Iterator<Item = &[f32]> {
        let curves = self.normal_n.iter().chain(&self.anchor_n);
        let curves = curves.chain(&self.acceleration).chain(&self.modal);
        curves.map(Vec::as_slice)
    }
}

/// Stress on the surface of the half z >= 0 of a head under unit loads.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HeadSurface {
    /// Positions of the points of the surface: one at each node, several where faces meet at an edge \[m\].
    pub places_m: Vec<[f64; 3]>,
    /// Outward unit normal at each point.
    pub normals: Vec<[f32; 3]>,
    /// Whether each point is held fixed.
    pub held: Vec<bool>,
    /// Faces: indices of the points at their corners; a triangle repeats its last one.
    pub faces: Vec<[u32; 4]>,
    /// Stress at each point under each requested unit load: xx, yy, zz, xy, yz, zx. Loads: 1 N in all, inwards and uniform over
    /// each interval of [`super::Machine::load_breaks_deg`], and 1 N at the rope's fixed end, inwards and towards increasing psi
    /// [MPa/N]; unit accelerations of the beam along x and y [MPa per m/s2] and about the pivot [MPa per rad/s2]; unit
    /// coordinates of the modes [MPa per kg^1/2 m].
    pub stress_mpa: Vec<Vec<[f32; 6]>>,
}
