//! Strain gauges: from a place on the steel to a row that reads stress off a displacement field.
//!
//! A gauge reads `E (u_y(p + l/2) - u_y(p - l/2)) / l`: the mean vertical strain over its length,
//! times Young's modulus.
use super::{
    ReductionError,
    hexahedron::{jacobian, shape},
    mesh::Mesh,
};
use nalgebra::Vector3;

/// A gauge that measures vertical strain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gauge {
    /// Its middle in the beam frame \[m\].
    pub position: [f64; 3],
    /// Its length along y \[m\].
    pub length: f64,
}

/// Steps of Newton's method towards a point within an element.
const STEPS: usize = 30;
/// How far outside the reference cube a point may lie and still belong to the element.
const SLACK: f64 = 1e-3;

impl Gauge {
    /// Factors of `u_y` per node: their sum of products is the reading \[Pa\].
    ///
    /// # Errors
    /// [`ReductionError::Gauge`], with `number`, if an end is not on the steel.
    pub(super) fn row(
        &self,
        mesh: &Mesh,
        young: f64,
        number: usize,
    ) -> Result<Vec<(usize, f64)>, ReductionError> {
        let mut row = Vec::with_capacity(16);
        for side in [1.0, -1.0] {
            let [x, y, z] = self.position;
            let end = Vector3::new(x, y + 0.5 * side * self.length, z);
            let (nodes, point) = locate(mesh, &end, number)?;
            let factor = side * young / self.length;
            row.extend(nodes.into_iter().zip(shape(&point).map(|n| factor * n)));
        }
        Ok(row)
    }
}

/// The element that holds a point, and where.
fn locate(
    mesh: &Mesh,
    place: &Vector3<f64>,
    number: usize,
) -> Result<([usize; 8], [f64; 3]), ReductionError> {
    let mut best: Option<([usize; 8], [f64; 3], f64)> = None;
    let mut nearest = f64::INFINITY;
    for element in &mesh.hexahedra {
        let corners = mesh.corners(element);
        let center = corners
            .iter()
            .fold(Vector3::zeros(), |sum, node| sum + Vector3::from(*node))
            / 8.0;
        let size = corners
            .iter()
            .map(|node| (Vector3::from(*node) - center).norm())
            .fold(0.0, f64::max);
        let distance = (place - center).norm() - size;
        nearest = nearest.min(distance.max(0.0));
        // Newton wanders off for points far outside; they are not inside anyway
        if distance > 0.0 {
            continue;
        }
        let Some(point) = invert(&corners, place) else {
            continue;
        };
        let outside = point.iter().fold(0.0_f64, |most, x| most.max(x.abs())) - 1.0;
        if best.as_ref().is_none_or(|(.., least)| outside < *least) {
            best = Some((*element, point, outside));
        }
    }
    match best {
        Some((element, point, outside)) if outside <= SLACK => Ok((element, point)),
        Some(_) | None => Err(ReductionError::Gauge {
            gauge: number,
            distance_mm: nearest * 1e3,
        }),
    }
}

/// Coordinates of a point in the reference cube, if Newton finds them.
fn invert(corners: &[[f64; 3]; 8], place: &Vector3<f64>) -> Option<[f64; 3]> {
    let mut point = [0.0; 3];
    for _ in 0..STEPS {
        let mut here = Vector3::zeros();
        for (share, node) in shape(&point).iter().zip(corners) {
            here += *share * Vector3::from(*node);
        }
        // the rows of the Jacobian are reference directions
        let step = jacobian(corners, &point).transpose().try_inverse()? * (place - here);
        for (x, dx) in point.iter_mut().zip(&step) {
            *x = (*x + dx).clamp(-3.0, 3.0);
        }
        if step.amax() < 1e-13 {
            return Some(point);
        }
    }
    None
}
