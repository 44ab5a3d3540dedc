//! The meshed head: nodes, elements of one kind, named groups, and the volume that they fill.
use super::volume;
use protocol::pumping_unit::ElementKind;
use std::collections::BTreeMap;

/// A mesh with named groups.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Node positions in the beam frame \[m\].
    pub nodes_m: Vec<[f64; 3]>,
    /// What its elements are.
    pub kind: ElementKind,
    /// Elements per volume group: indices of nodes, element after element, in Gmsh's order.
    pub volumes: BTreeMap<String, Vec<usize>>,
    /// Faces per surface group: indices of nodes, face after face.
    pub surfaces: BTreeMap<String, Vec<usize>>,
    /// Whether it is the half z >= 0 of the head: it has a group [`SYMMETRY`].
    pub half: bool,
}

/// The group of all elements.
pub const VOLUME: &str = "steel";
/// The groups of the held pin holes and of the loaded rim.
pub const SURFACES: [&str; 3] = ["pin_a", "pin_b", "rope_surface"];
/// The group of the cut face in the plane z = 0, which only a half has.
pub const SYMMETRY: &str = "symmetry";

impl Mesh {
    /// Volume of the head \[m3\]: of all elements, twice that of a half.
    pub fn volume_m3(&self) -> f64 {
        let elements = self.volumes.values();
        let elements = elements.flat_map(|group| group.chunks_exact(self.kind.nodes()));
        let sum: f64 = elements
            .filter_map(|element| self.element_volume_m3(element))
            .sum();
        if self.half { 2.0 * sum } else { sum }
    }

    /// Volume of one element \[m3\]; none if it is inside out.
    pub(super) fn element_volume_m3(&self, element: &[usize]) -> Option<f64> {
        let place = |&node: &usize| self.nodes_m.get(node).copied().unwrap_or_default();
        let places: Vec<[f64; 3]> = element.iter().map(place).collect();
        volume::of(self.kind, &places)
    }
}
