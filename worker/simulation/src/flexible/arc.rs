//! Rim displacement of a flexible head under its rope: the displacement at one angle of the rope arc,
//! averaged over the head's width.
//!
//! At an angle psi about the arc's centre the rope crosses the rim along a line of constant psi. Every
//! element face crossed by the line is cut from edge to edge, with the face's own shape functions. The same
//! weights distribute a force over the rim. Independent of ropes and modes.
use super::{
    element::{Crossing, Cut},
    error::ReductionError,
    mesh::Mesh,
};
use crate::math::elementary::{atan2, sin_cos};
use std::collections::BTreeMap;

/// Station on the rim: an angle, its radial and tangential directions, and nodal weights (sum 1) that average
/// over the rim's width there.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Station {
    /// Angle of the station about the arc's centre \[rad\].
    pub(super) psi: f64,
    /// Unit vector of the outward radial direction.
    pub(super) radial: [f64; 2],
    /// Unit vector of the direction of increasing psi.
    pub(super) tangential: [f64; 2],
    /// Indices of mesh nodes with their weights in the average over the rim's width.
    pub(super) weights: Vec<(usize, f64)>,
}

impl Station {
    fn new(psi: f64, weights: impl Iterator<Item = (usize, f64)>) -> Self {
        let (s, c) = sin_cos(psi);
        Self {
            psi,
            radial: [c, s],
            tangential: [-s, c],
            weights: weights.collect(),
        }
    }

    /// Computes the rim's mean displacement \[m\] at the station, along `direction` in the plane, from a
    /// displacement field.
    pub(super) fn mean(&self, field: &[[f64; 3]], direction: [f64; 2]) -> f64 {
        let along = |u: &[f64; 3]| u[0] * direction[0] + u[1] * direction[1];
        self.weights
            .iter()
            .map(|&(node, weight)| weight * along(&field[node]))
            .sum()
    }

    /// Computes the rim's mean displacement \[m\] at the station along z, from a displacement field.
    pub(super) fn mean_along_z(&self, field: &[[f64; 3]]) -> f64 {
        let weights = self.weights.iter();
        weights.map(|&(node, weight)| weight * field[node][2]).sum()
    }

    /// Distributes a force \[N\] at the station along `direction` over the rim's width; returns forces on all
    /// nodes.
    pub(super) fn force(&self, nodes: usize, direction: [f64; 2], size: f64) -> Vec<[f64; 3]> {
        let mut forces = vec![[0.0; 3]; nodes];
        self.add_force(&mut forces, direction, size);
        forces
    }

    /// Adds to nodal forces a force \[N\] along `direction`, distributed at the station over the rim's width.
    pub(super) fn add_force(&self, forces: &mut [[f64; 3]], direction: [f64; 2], size: f64) {
        for &(node, weight) in &self.weights {
            forces[node][0] += size * weight * direction[0];
            forces[node][1] += size * weight * direction[1];
        }
    }
}

/// Rim of a head's mesh (the surface under the rope), in polar angles about the arc's centre.
#[derive(Clone, Debug)]
pub(super) struct Rim<'a> {
    mesh: &'a Mesh,
    /// Angle of every rim node by its index \[rad\], 0 to 2 pi.
    angles: BTreeMap<usize, f64>,
    span: [f64; 2],
}

impl<'a> Rim<'a> {
    /// Creates the rim of a mesh about a centre \[m\]. The rim must not cross the positive x direction.
    pub(super) fn new(mesh: &'a Mesh, center: [f64; 2]) -> Self {
        let mut span = [f64::INFINITY, f64::NEG_INFINITY];
        let mut angles = BTreeMap::new();
        for &node in &mesh.rope_faces {
            let [x, y, _] = mesh.nodes[node];
            let angle = atan2(y - center[1], x - center[0]).rem_euclid(std::f64::consts::TAU);
            span = [span[0].min(angle), span[1].max(angle)];
            angles.insert(node, angle);
        }
        Self { mesh, angles, span }
    }

    /// Computes the station at an angle \[rad\], averaged over the width.
    ///
    /// # Errors
    /// [`ReductionError::Station`] if the rim does not reach the angle.
    pub(super) fn station(&self, psi: f64) -> Result<Station, ReductionError> {
        let at = self.within(psi)?;
        let mut weights = BTreeMap::new();
        for cut in self.cuts(at) {
            let [p, q] = cut.ends();
            let length = (p - q).abs();
            for (point, share) in cut.points() {
                add(&mut weights, point, share * length);
            }
        }
        let total: f64 = weights.values().sum();
        if total <= 0.0 {
            return Err(self.missing(psi));
        }
        Ok(Station::new(
            psi,
            weights.into_iter().map(|(n, w)| (n, w / total)),
        ))
    }

    /// Computes a station that is the single rim point at an angle \[rad\] and a lateral position z \[m\].
    ///
    /// # Errors
    /// As [`Self::station`]; [`ReductionError::OutsideRim`] if the rim is narrower than z.
    pub(super) fn station_beside(&self, psi: f64, z: f64) -> Result<Station, ReductionError> {
        let at = self.within(psi)?;
        let spans = |cut: &Cut| {
            let [p, q] = cut.ends();
            (p <= z) != (q <= z)
        };
        let cut = self
            .cuts(at)
            .find(spans)
            .ok_or(ReductionError::OutsideRim {
                psi_deg: psi.to_degrees(),
                offset: z,
            })?;
        let mut weights = BTreeMap::new();
        for (point, share) in cut.at(z) {
            add(&mut weights, point, share);
        }
        Ok(Station::new(psi, weights.into_iter()))
    }

    /// Clamps an angle to the rim's angular range; an angle outside by more than a hundredth of a degree, to which
    /// meshes are written, is an error.
    fn within(&self, psi: f64) -> Result<f64, ReductionError> {
        let [from, to] = self.span;
        let slack = 2e-4;
        if !(from - slack..=to + slack).contains(&psi) {
            return Err(self.missing(psi));
        }
        Ok(psi.clamp(from + 1e-12, to - 1e-12))
    }

    fn missing(&self, psi: f64) -> ReductionError {
        let [from, to] = self.span;
        ReductionError::Station {
            psi_deg: psi.to_degrees(),
            from_deg: from.to_degrees(),
            to_deg: to.to_degrees(),
        }
    }

    /// Returns the cuts of the line at an angle with all faces of the rim.
    fn cuts(&self, psi: f64) -> impl Iterator<Item = Cut> + '_ {
        let kind = self.mesh.law().face();
        let seen = |node: usize| [self.angles[&node], self.mesh.nodes[node][2]];
        let faces = self.mesh.faces();
        faces.filter_map(move |face| kind.cut(face, &seen, psi))
    }
}

/// Adds the nodal weights of a point on a face, multiplied by a share, to `weights`.
fn add(weights: &mut BTreeMap<usize, f64>, point: &Crossing, share: f64) {
    for &(node, of_point) in &point.nodes {
        *weights.entry(node).or_insert(0.0) += share * of_point;
    }
}
