//! Mesh of the head: nodes, elements of one kind and named groups, with their volume.
use super::volume;
use protocol::pumping_unit::ElementKind;
use std::collections::BTreeMap;

/// Finite-element mesh with named groups.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Node positions in the beam frame \[m\].
    pub nodes_m: Vec<[f64; 3]>,
    /// Kind that all elements of the mesh have.
    pub kind: ElementKind,
    /// Elements of each volume group: node indices, element after element, in Gmsh's order.
    pub volumes: BTreeMap<String, Vec<usize>>,
    /// Faces of each surface group: node indices, face after face.
    pub surfaces: BTreeMap<String, Vec<usize>>,
    /// Largest distance of a mid-edge node of a second-order brick, which the mesh leaves out, from
    /// its straight edge \[m\]; `None` if none was left out.
    pub straightened_m: Option<f64>,
    /// Whether the mesh covers only the half z >= 0 of the head, marked by a group [`SYMMETRY`].
    pub half: bool,
}

/// Name of the group of all elements.
pub const VOLUME: &str = "steel";
/// Names of the groups of the held pin holes and of the loaded rim.
pub const SURFACES: [&str; 3] = ["pin_a", "pin_b", "rope_surface"];
/// Name of the group of the cut face in the plane z = 0, present only in a half mesh.
pub const SYMMETRY: &str = "symmetry";

impl Mesh {
    /// Returns the volume of the head \[m3\]: the sum over all elements, doubled for a half mesh.
    pub fn volume_m3(&self) -> f64 {
        let elements = self.volumes.values();
        let elements = elements.flat_map(|group| group.chunks_exact(self.kind.nodes()));
        let sum: f64 = elements
            .filter_map(|element| self.element_volume_m3(element))
            .sum();
        if self.half { 2.0 * sum } else { sum }
    }

    /// Returns the volume of an element \[m3\]; `None` if it is inverted.
    pub(super) fn element_volume_m3(&self, element: &[usize]) -> Option<f64> {
        let place = |&node: &usize| self.nodes_m.get(node).copied().unwrap_or_default();
        let places: Vec<[f64; 3]> = element.iter().map(place).collect();
        volume::of(self.kind, &places)
    }
}
