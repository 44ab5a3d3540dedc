//! The rope arc: what a rope at an angle feels of a displacement field, averaged over the width.
//!
//! At an angle psi about the arc's centre the rope crosses the rim along a line of constant psi.
//! Every face that the line crosses is cut at two of its edges; displacement is linear along an
//! edge and taken as linear along the cut. The same weights spread a force over the rim. Knows
//! nothing of ropes or modes.
use super::{ReductionError, mesh::Mesh};
use crate::math::elementary::{atan2, sin_cos};
use std::collections::BTreeMap;

/// Weights of nodes at one station, summing to 1.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Station {
    /// Angle about the arc's centre \[rad\].
    pub(super) psi: f64,
    /// Outward radial direction.
    pub(super) radial: [f64; 2],
    /// Direction of increasing psi.
    pub(super) tangential: [f64; 2],
    /// Nodes and their weights.
    pub(super) weights: Vec<(usize, f64)>,
}

impl Station {
    /// Mean displacement \[m\] along `direction` in the plane.
    pub(super) fn mean(&self, field: &[[f64; 3]], direction: [f64; 2]) -> f64 {
        let along = |u: &[f64; 3]| u[0] * direction[0] + u[1] * direction[1];
        self.weights
            .iter()
            .map(|&(node, weight)| weight * along(&field[node]))
            .sum()
    }

    /// A force \[N\] along `direction` over the width, as forces on all nodes.
    pub(super) fn force(&self, nodes: usize, direction: [f64; 2], size: f64) -> Vec<[f64; 3]> {
        let mut forces = vec![[0.0; 3]; nodes];
        self.add_force(&mut forces, direction, size);
        forces
    }

    /// Adds such a force.
    pub(super) fn add_force(&self, forces: &mut [[f64; 3]], direction: [f64; 2], size: f64) {
        for &(node, weight) in &self.weights {
            forces[node][0] += size * weight * direction[0];
            forces[node][1] += size * weight * direction[1];
        }
    }
}

/// The rim of a mesh, seen from the arc's centre.
#[derive(Clone, Debug)]
pub(super) struct Rim<'a> {
    mesh: &'a Mesh,
    /// Angle of every node of the rim \[rad\], 0 to 2 pi.
    angles: BTreeMap<usize, f64>,
    span: [f64; 2],
}

impl<'a> Rim<'a> {
    /// The rim of a mesh about a centre \[m\]. It must not cross the positive x direction.
    pub(super) fn new(mesh: &'a Mesh, center: [f64; 2]) -> Self {
        let mut span = [f64::INFINITY, f64::NEG_INFINITY];
        let mut angles = BTreeMap::new();
        for &node in mesh.rim.iter().flatten() {
            let [x, y, _] = mesh.nodes[node];
            let angle = atan2(y - center[1], x - center[0]).rem_euclid(std::f64::consts::TAU);
            span = [span[0].min(angle), span[1].max(angle)];
            angles.insert(node, angle);
        }
        Self { mesh, angles, span }
    }

    /// The station at an angle \[rad\].
    ///
    /// # Errors
    /// [`ReductionError::Station`] if the rim does not reach it.
    pub(super) fn station(&self, psi: f64) -> Result<Station, ReductionError> {
        // an end that a rounding error puts outside is still the end
        let [from, to] = self.span;
        let slack = 1e-6;
        let missing = || ReductionError::Station {
            psi_deg: psi.to_degrees(),
            from_deg: from.to_degrees(),
            to_deg: to.to_degrees(),
        };
        if !(from - slack..=to + slack).contains(&psi) {
            return Err(missing());
        }
        let at = psi.clamp(from + 1e-12, to - 1e-12);
        let mut weights = BTreeMap::new();
        for face in &self.mesh.rim {
            if let Some([p, q]) = self.cut(face, at) {
                let length = (p.height - q.height).abs();
                for point in [p, q] {
                    for (node, share) in point.nodes {
                        *weights.entry(node).or_insert(0.0) += 0.5 * length * share;
                    }
                }
            }
        }
        let total: f64 = weights.values().sum();
        if total <= 0.0 {
            return Err(missing());
        }
        let (s, c) = sin_cos(psi);
        Ok(Station {
            psi,
            radial: [c, s],
            tangential: [-s, c],
            weights: weights.into_iter().map(|(n, w)| (n, w / total)).collect(),
        })
    }

    /// Where a face is cut by the line at an angle: two points on its edges, or nothing.
    fn cut(&self, face: &[usize; 4], psi: f64) -> Option<[Crossing; 2]> {
        let mut found = (0..4).filter_map(|k| {
            let (a, b) = (face[k], face[(k + 1) % 4]);
            let (angle_a, angle_b) = (self.angles[&a], self.angles[&b]);
            // a node on the line belongs to the side above it: no edge is crossed twice
            if (angle_a <= psi) == (angle_b <= psi) {
                return None;
            }
            let share = (psi - angle_a) / (angle_b - angle_a);
            let height = |node: usize| self.mesh.nodes[node][2];
            Some(Crossing {
                nodes: [(a, 1.0 - share), (b, share)],
                height: height(a) * (1.0 - share) + height(b) * share,
            })
        });
        Some([found.next()?, found.next()?])
    }
}

/// A point on an edge.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    /// Ends of the edge and their shares.
    nodes: [(usize, f64); 2],
    /// Its z \[m\].
    height: f64,
}
