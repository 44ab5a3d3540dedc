//! A mesh of hexahedra as plain numbers, and its half on one side of the symmetry plane.
//!
//! A head that is its own mirror image in z = 0 vibrates either symmetrically (`u_z = 0` on the
//! plane) or antisymmetrically (`u_x = u_y = 0` there), so half the mesh is enough for both. Knows
//! nothing of stiffness, files or groups.
use super::ReductionError;
use std::collections::{BTreeMap, BTreeSet};

/// Two positions closer than this are one \[m\].
const TOLERANCE: f64 = 1e-6;

/// A head as it was meshed, in the beam frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Positions \[m\].
    pub nodes: Vec<[f64; 3]>,
    /// Indices of nodes, in Gmsh's order.
    pub hexahedra: Vec<[usize; 8]>,
    /// Nodes that are held in all directions: the pin holes.
    pub held: Vec<usize>,
    /// Quadrilaterals of the surface that the rope lies on.
    pub rim: Vec<[usize; 4]>,
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
        if self.hexahedra.is_empty() || self.rim.is_empty() || self.held.is_empty() {
            return wrong("it has no hexahedra, no rope surface or no held nodes");
        }
        if !(self.hexahedra.iter().flatten().all(inside)
            && self.rim.iter().flatten().all(inside)
            && self.held.iter().all(inside))
        {
            return wrong("an element names a node that does not exist");
        }
        if !self.nodes.iter().flatten().all(|x| x.is_finite()) {
            return wrong("a position is not a finite number");
        }
        Ok(())
    }

    /// Positions of an element's nodes.
    pub(super) fn corners(&self, element: &[usize; 8]) -> [[f64; 3]; 8] {
        element.map(|node| self.nodes[node])
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
    /// Cuts a mesh at z = 0.
    ///
    /// # Errors
    /// [`ReductionError::Mesh`] as [`Mesh::check`] does; [`ReductionError::NotMirrored`] if the
    /// mesh is not its own mirror image.
    pub(super) fn new(whole: &Mesh) -> Result<Self, ReductionError> {
        whole.check()?;
        let here = |node: &usize| whole.nodes[*node][2] > -TOLERANCE;
        let kept: Vec<usize> = (0..whole.nodes.len()).filter(here).collect();
        let places: BTreeMap<[i64; 3], usize> = kept
            .iter()
            .enumerate()
            .map(|(half, &node)| (cell(&whole.nodes[node]), half))
            .collect();
        let mut source = Vec::with_capacity(whole.nodes.len());
        for node in &whole.nodes {
            let image = node[2] <= -TOLERANCE;
            let place = [node[0], node[1], if image { -node[2] } else { node[2] }];
            let half = find(&places, &place).ok_or(ReductionError::NotMirrored {
                x: node[0],
                y: node[1],
                z: node[2],
            })?;
            source.push((half, image));
        }
        let nodes: Vec<[f64; 3]> = kept.iter().map(|&node| whole.nodes[node]).collect();
        let on_plane = nodes.iter().map(|node| node[2].abs() < TOLERANCE).collect();
        let half = |node: usize| source[node].0;
        let held: BTreeSet<usize> = whole.held.iter().map(|&node| half(node)).collect();
        let rim = |face: &&[usize; 4]| face.iter().all(here);
        let mesh = Mesh {
            hexahedra: Self::hexahedra(whole, &source)?,
            held: held.into_iter().collect(),
            rim: whole.rim.iter().filter(rim).map(|f| f.map(half)).collect(),
            nodes,
        };
        Ok(Self {
            mesh,
            on_plane,
            source,
        })
    }

    /// Elements of the half; each must have its image.
    fn hexahedra(
        whole: &Mesh,
        source: &[(usize, bool)],
    ) -> Result<Vec<[usize; 8]>, ReductionError> {
        let mut here = Vec::new();
        let mut images = BTreeSet::new();
        let sorted = |element: &[usize; 8]| {
            let mut nodes = *element;
            nodes.sort_unstable();
            nodes
        };
        for element in &whole.hexahedra {
            let middle: f64 = element.iter().map(|&node| whole.nodes[node][2]).sum();
            let half = element.map(|node| source[node].0);
            if middle > 0.0 {
                here.push((half, element));
            } else {
                images.insert(sorted(&half));
            }
        }
        if here.len() == images.len() {
            let lonely = here.iter().find(|(half, element)| {
                !images.contains(&sorted(half)) || element.iter().any(|&node| source[node].1)
            });
            if lonely.is_none() {
                return Ok(here.into_iter().map(|(half, _)| half).collect());
            }
        }
        let [x, y, z] = here
            .iter()
            .find(|(half, _)| !images.contains(&sorted(half)))
            .map_or([0.0; 3], |(_, element)| whole.nodes[element[0]]);
        Err(ReductionError::NotMirrored { x, y, z })
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
