//! Division of a brick mesh into 10-node tetrahedra with matching faces, which gives the tests the same body
//! in the second element kind.
//!
//! Every brick is divided from its node of lowest rank towards the faces that do not contain it; every face
//! is divided from its own node of lowest rank, so that neighbours divide it alike. Ranks that are equal on
//! both sides of a plane give a mesh that is symmetric about it.
use std::collections::BTreeMap;

/// Faces of a brick, nodes counterclockwise as seen from outside.
const FACES: [[usize; 4]; 6] = [
    [0, 3, 2, 1],
    [4, 5, 6, 7],
    [0, 1, 5, 4],
    [1, 2, 6, 5],
    [2, 3, 7, 6],
    [3, 0, 4, 7],
];

/// Corners at the ends of a triangle's edges, in Gmsh's order of the mid-edge nodes; `OF_TETRAHEDRON`
/// likewise.
const OF_TRIANGLE: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];
const OF_TETRAHEDRON: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [3, 0], [2, 3], [3, 1]];

/// State of the division of a brick mesh into tetrahedra.
pub(crate) struct Split<R> {
    /// Positions of the nodes \[m\]: those of the bricks, then the added mid-edge nodes.
    pub(crate) nodes: Vec<[f64; 3]>,
    /// Index of the mid-edge node of each edge, keyed by the edge's end nodes in ascending order.
    pub(crate) middles: BTreeMap<[usize; 2], usize>,
    rank: R,
}

impl<R: Fn(usize) -> usize> Split<R> {
    /// Creates the division of a brick mesh from its nodes and their ranks; no two nodes of a brick may have
    /// equal rank.
    pub(crate) const fn new(nodes: Vec<[f64; 3]>, rank: R) -> Self {
        Self {
            nodes,
            middles: BTreeMap::new(),
            rank,
        }
    }

    /// Divides bricks into 10-node tetrahedra; returns their node indices.
    pub(crate) fn tetrahedra(&mut self, bricks: &[usize]) -> Vec<usize> {
        let mut tetrahedra = Vec::new();
        for brick in bricks.chunks_exact(8) {
            let apex = self.lowest(brick);
            let faces = FACES.map(|face| face.map(|k| brick[k]));
            for face in faces.iter().filter(|face| !face.contains(&apex)) {
                for [a, b, c] in self.corners(face) {
                    tetrahedra.extend(self.with_middles([a, c, b, apex], &OF_TETRAHEDRON));
                }
            }
        }
        tetrahedra
    }

    /// Divides quadrilateral faces into 6-node triangles; returns their node indices.
    pub(crate) fn triangles(&mut self, faces: &[usize]) -> Vec<usize> {
        let mut triangles = Vec::new();
        for face in faces.chunks_exact(4) {
            for corners in self.corners(face) {
                triangles.extend(self.with_middles(corners, &OF_TRIANGLE));
            }
        }
        triangles
    }

    fn lowest(&self, nodes: &[usize]) -> usize {
        let ranked = nodes.iter().copied().min_by_key(|&node| (self.rank)(node));
        ranked.expect("an element has nodes")
    }

    /// Returns the corners of the two triangles into which a quadrilateral face is divided, with the face's
    /// orientation.
    fn corners(&self, face: &[usize]) -> [[usize; 3]; 2] {
        let first = self.lowest(face);
        let at = face.iter().position(|&node| node == first);
        let at = at.expect("the lowest is one of them");
        let node = |k: usize| face[(at + k) % 4];
        [[first, node(1), node(2)], [first, node(2), node(3)]]
    }

    fn with_middles<const N: usize>(
        &mut self,
        nodes: [usize; N],
        edges: &[[usize; 2]],
    ) -> Vec<usize> {
        let mut all = nodes.to_vec();
        for edge in edges {
            let mut ends = edge.map(|k| nodes[k]);
            ends.sort_unstable();
            let count = self.nodes.len();
            let middle = *self.middles.entry(ends).or_insert(count);
            if middle == count {
                let [a, b] = ends.map(|node| self.nodes[node]);
                let half = |k: usize| 0.5 * (a[k] + b[k]);
                self.nodes.push([half(0), half(1), half(2)]);
            }
            all.push(middle);
        }
        all
    }
}
