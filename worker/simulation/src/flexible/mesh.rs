//! Mesh of a head as plain numbers, and its half on one side of the symmetry plane.
//!
//! A head that is symmetric about z = 0 vibrates either symmetrically (`u_z = 0` on the plane) or
//! antisymmetrically (`u_x = u_y = 0` there), so half the mesh is enough for both. The mesh may be given as
//! that half, because free meshers do not produce symmetric meshes. This module knows nothing of stiffness,
//! files or groups.
use super::{
    element::{Element, ElementKind},
    error::ReductionError,
};
use std::collections::{BTreeMap, BTreeSet};

/// Distance below which two node positions count as equal when mirror images are matched \[m\].
const TOLERANCE: f64 = 1e-6;

/// Finite element mesh of a head, in the beam frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Positions of the nodes \[m\].
    pub nodes: Vec<[f64; 3]>,
    /// Kind of element that the mesh consists of.
    pub kind: ElementKind,
    /// Node indices of all elements, one element after the other, each in Gmsh's order of nodes.
    pub elements: Vec<usize>,
    /// Indices of the nodes held fixed in all directions, which are those on the pin holes.
    pub held: Vec<usize>,
    /// Node indices of all faces of the surface under the rope, face after face.
    pub rope_faces: Vec<usize>,
    /// Whether the mesh is only the half z >= 0 of the head instead of the whole.
    pub half: bool,
}

impl Mesh {
    /// Checks that every index refers to a node, that every position is finite, and that elements, rope
    /// surface and held nodes exist.
    ///
    /// # Errors
    /// [`ReductionError::Mesh`] with a description of the defect.
    pub(super) fn check(&self) -> Result<(), ReductionError> {
        let count = self.nodes.len();
        let inside = |node: &usize| *node < count;
        let wrong = |what| Err(ReductionError::Mesh { what });
        if self.elements.is_empty() || self.rope_faces.is_empty() || self.held.is_empty() {
            return wrong("it has no elements, no rope surface or no held nodes");
        }
        let law = self.law();
        if !(self.elements.len().is_multiple_of(law.nodes())
            && self.rope_faces.len().is_multiple_of(law.face().nodes()))
        {
            return wrong(
                "the number of node indices is not a multiple of the nodes per element or per face of the rope surface",
            );
        }
        if ![&self.elements, &self.rope_faces, &self.held]
            .into_iter()
            .flatten()
            .all(inside)
        {
            return wrong(
                "an element, a face of the rope surface or the list of held nodes refers to a node that does not exist",
            );
        }
        if !self.nodes.iter().flatten().all(|x| x.is_finite()) {
            return wrong("a position is not a finite number");
        }
        Ok(())
    }

    /// Returns the implementation of shape functions, stiffness and mass for the mesh's element kind.
    pub(super) fn law(&self) -> &'static dyn Element {
        self.kind.law()
    }

    /// Iterates over the elements as slices of node indices.
    pub(super) fn elements(&self) -> impl Iterator<Item = &[usize]> {
        self.elements.chunks_exact(self.law().nodes())
    }

    /// Iterates over the faces of the rope surface as slices of node indices.
    pub(super) fn faces(&self) -> impl Iterator<Item = &[usize]> {
        self.rope_faces.chunks_exact(self.law().face().nodes())
    }

    /// Returns the positions of an element's nodes \[m\].
    pub(super) fn places(&self, element: &[usize]) -> Vec<[f64; 3]> {
        element.iter().map(|&node| self.nodes[node]).collect()
    }
}

/// Half z >= 0 of a head's mesh, with the correspondence of its nodes to those of the whole mesh.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Half {
    /// Mesh of the half z >= 0.
    pub(super) mesh: Mesh,
    /// Whether each node of the half lies on the plane z = 0.
    pub(super) on_plane: Vec<bool>,
    /// Correspondence of each node of the whole mesh: index of the node in the half, and whether the node is
    /// its mirror image (z < 0).
    pub(super) source: Vec<(usize, bool)>,
}

impl Half {
    /// Creates the half z >= 0 of a mesh by cutting it at z = 0; a mesh that is already the half is taken as
    /// it is.
    ///
    /// # Errors
    /// [`ReductionError::Mesh`] if [`Mesh::check`] fails or a mesh marked as half does not lie in z >= 0 and
    /// end on z = 0; [`ReductionError::NotMirrored`] if the whole mesh is not symmetric about z = 0.
    pub(super) fn new(whole: &Mesh) -> Result<Self, ReductionError> {
        whole.check()?;
        let here = |node: &usize| whole.nodes[*node][2] > -TOLERANCE;
        let kept: Vec<usize> = (0..whole.nodes.len()).filter(here).collect();
        let nodes: Vec<[f64; 3]> = kept.iter().map(|&node| whole.nodes[node]).collect();
        let on_plane: Vec<bool> = nodes.iter().map(|node| node[2].abs() < TOLERANCE).collect();
        if whole.half {
            if nodes.len() < whole.nodes.len() || !on_plane.contains(&true) {
                let what = "a half must lie in z >= 0 and end on the plane z = 0";
                return Err(ReductionError::Mesh { what });
            }
            return Ok(Self {
                mesh: whole.clone(),
                on_plane,
                source: kept.into_iter().map(|node| (node, false)).collect(),
            });
        }
        let source = images(whole, &nodes)?;
        let half = |node: &usize| source[*node].0;
        let held: BTreeSet<usize> = whole.held.iter().map(half).collect();
        let rim = whole.faces().filter(|face| face.iter().all(here));
        let mesh = Mesh {
            kind: whole.kind,
            elements: Self::elements(whole, &source)?,
            held: held.into_iter().collect(),
            rope_faces: rim.flatten().map(half).collect(),
            half: true,
            nodes,
        };
        Ok(Self {
            mesh,
            on_plane,
            source,
        })
    }

    /// Returns the node indices of the half's elements, after checking that each has a mirror image.
    fn elements(whole: &Mesh, source: &[(usize, bool)]) -> Result<Vec<usize>, ReductionError> {
        let mut here = Vec::new();
        let mut images = BTreeSet::new();
        let sorted = |element: &[usize]| {
            let mut nodes = element.to_vec();
            nodes.sort_unstable();
            nodes
        };
        for element in whole.elements() {
            let middle: f64 = element.iter().map(|&node| whole.nodes[node][2]).sum();
            let half: Vec<usize> = element.iter().map(|&node| source[node].0).collect();
            if middle > 0.0 {
                here.push((half, element));
            } else {
                images.insert(sorted(&half));
            }
        }
        let lonely = here.iter().find(|(half, element)| {
            !images.contains(&sorted(half)) || element.iter().any(|&node| source[node].1)
        });
        match lonely {
            None if here.len() == images.len() => {
                Ok(here.into_iter().flat_map(|(half, _)| half).collect())
            }
            _ => {
                let first = lonely.map_or(0, |(_, element)| element[0]);
                Err(not_mirrored(&whole.nodes[first]))
            }
        }
    }

    /// Extends a displacement field of the half to the whole mesh; `image` holds the signs of the mirrored
    /// components.
    pub(super) fn unfold(&self, half: &[[f64; 3]], image: [f64; 3]) -> Vec<[f64; 3]> {
        let unfolded = |&(node, is_image): &(usize, bool)| {
            let [x, y, z] = half[node];
            if is_image {
                [x * image[0], y * image[1], z * image[2]]
            } else {
                [x, y, z]
            }
        };
        self.source.iter().map(unfolded).collect()
    }
}

/// Returns, for every node of the whole mesh, the corresponding node of the half and whether it is a mirror
/// image.
fn images(whole: &Mesh, half: &[[f64; 3]]) -> Result<Vec<(usize, bool)>, ReductionError> {
    let places: BTreeMap<[i64; 3], usize> = half.iter().map(cell).zip(0..).collect();
    let source = whole.nodes.iter().map(|node| {
        let image = node[2] <= -TOLERANCE;
        let place = [node[0], node[1], if image { -node[2] } else { node[2] }];
        let half = find(&places, &place).ok_or_else(|| not_mirrored(node))?;
        Ok((half, image))
    });
    source.collect()
}

fn not_mirrored(&[x, y, z]: &[f64; 3]) -> ReductionError {
    ReductionError::NotMirrored { x, y, z }
}

/// Returns the grid cell, of edge length `TOLERANCE`, that contains a node position.
#[expect(
    clippy::cast_possible_truncation,
    reason = "positions of a machine part in millionths of a metre"
)]
fn cell(node: &[f64; 3]) -> [i64; 3] {
    node.map(|x| (x / TOLERANCE).round() as i64)
}

/// Finds the index of the node at a position, by searching its grid cell and the 26 neighbouring cells.
fn find(places: &BTreeMap<[i64; 3], usize>, place: &[f64; 3]) -> Option<usize> {
    let [x, y, z] = cell(place);
    (0..27).find_map(|k| {
        // offsets 0, 1, -1: the cell itself comes first
        let offset = |digit: i64| [0, 1, -1][usize::try_from(digit % 3).unwrap_or(0)];
        let at = [x + offset(k), y + offset(k / 3), z + offset(k / 9)];
        places.get(&at).copied()
    })
}
