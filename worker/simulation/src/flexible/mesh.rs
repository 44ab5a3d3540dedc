//! A mesh as plain numbers, and its half on one side of the symmetry plane.
//!
//! A head that is its own mirror image in z = 0 vibrates either symmetrically (`u_z = 0` on the
//! plane) or antisymmetrically (`u_x = u_y = 0` there), so half the mesh is enough for both. It may
//! come as that half: free meshers do not mirror. Knows nothing of stiffness, files or groups.
use super::{
    element::{Element, ElementKind},
    error::ReductionError,
};
use std::collections::{BTreeMap, BTreeSet};

/// Two positions closer than this are one \[m\].
const TOLERANCE: f64 = 1e-6;

/// A head as it was meshed, in the beam frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Positions \[m\].
    pub nodes: Vec<[f64; 3]>,
    /// What all elements are.
    pub kind: ElementKind,
    /// Indices of nodes, element after element, in Gmsh's order.
    pub elements: Vec<usize>,
    /// Nodes that are held in all directions: the pin holes.
    pub held: Vec<usize>,
    /// Indices of nodes, face after face, of the surface that the rope lies on.
    pub rim: Vec<usize>,
    /// Whether this is the half z >= 0 of the head; it is the whole otherwise.
    pub half: bool,
}

impl Mesh {
    /// Every index names a node, every position is finite, and there is something to reduce.
    ///
    /// # Errors
    /// [`ReductionError::Mesh`] saying what is missing.
    pub(super) fn check(&self) -> Result<(), ReductionError> {
        let count = self.nodes.len();
        let inside = |node: &usize| *node < count;
        let wrong = |what| Err(ReductionError::Mesh { what });
        if self.elements.is_empty() || self.rim.is_empty() || self.held.is_empty() {
            return wrong("it has no elements, no rope surface or no held nodes");
        }
        let law = self.law();
        if !(self.elements.len().is_multiple_of(law.nodes())
            && self.rim.len().is_multiple_of(law.face().nodes()))
        {
            return wrong("an element or a face of the rope surface lacks nodes");
        }
        if ![&self.elements, &self.rim, &self.held]
            .into_iter()
            .flatten()
            .all(inside)
        {
            return wrong("an element names a node that does not exist");
        }
        if !self.nodes.iter().flatten().all(|x| x.is_finite()) {
            return wrong("a position is not a finite number");
        }
        Ok(())
    }

    /// How its elements behave.
    pub(super) fn law(&self) -> &'static dyn Element {
        self.kind.law()
    }

    /// Nodes of every element.
    pub(super) fn elements(&self) -> impl Iterator<Item = &[usize]> {
        self.elements.chunks_exact(self.law().nodes())
    }

    /// Nodes of every face of the rim.
    pub(super) fn faces(&self) -> impl Iterator<Item = &[usize]> {
        self.rim.chunks_exact(self.law().face().nodes())
    }

    /// Positions of an element's nodes.
    pub(super) fn places(&self, element: &[usize]) -> Vec<[f64; 3]> {
        element.iter().map(|&node| self.nodes[node]).collect()
    }
}

/// The half of a mesh with z >= 0.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Half {
    /// The half.
    pub(super) mesh: Mesh,
    /// Whether a node of the half lies on the plane.
    pub(super) on_plane: Vec<bool>,
    /// For every node of the whole mesh its node of the half, and whether it is an image.
    pub(super) source: Vec<(usize, bool)>,
}

impl Half {
    /// Cuts a mesh at z = 0, unless it is the half already.
    ///
    /// # Errors
    /// [`ReductionError::Mesh`] as [`Mesh::check`] does, or for a half that is none;
    /// [`ReductionError::NotMirrored`] if the whole is not its own mirror image.
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
            rim: rim.flatten().map(half).collect(),
            half: true,
            nodes,
        };
        Ok(Self {
            mesh,
            on_plane,
            source,
        })
    }

    /// Elements of the half; each must have its image.
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

    /// A displacement field of the whole mesh from that of its half.
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

/// For every node of a whole mesh its node among those of the half, and whether it is an image.
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

/// The cell of a grid of tolerances that a position lies in.
#[expect(
    clippy::cast_possible_truncation,
    reason = "positions of a machine part in millionths of a metre"
)]
fn cell(node: &[f64; 3]) -> [i64; 3] {
    node.map(|x| (x / TOLERANCE).round() as i64)
}

/// A node at a place, in its cell or one beside it.
fn find(places: &BTreeMap<[i64; 3], usize>, place: &[f64; 3]) -> Option<usize> {
    let [x, y, z] = cell(place);
    (0..27).find_map(|k| {
        // offsets 0, 1, -1: the cell itself comes first
        let offset = |digit: i64| [0, 1, -1][usize::try_from(digit % 3).unwrap_or(0)];
        let at = [x + offset(k), y + offset(k / 3), z + offset(k / 9)];
        places.get(&at).copied()
    })
}
