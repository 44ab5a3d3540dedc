//! Strain gauges: linear map from the displacement field to the stress reading of a gauge at a given
//! position.
//!
//! A gauge reads `E (u_y(p + l/2) - u_y(p - l/2)) / l`: the mean vertical strain over its length times
//! Young's modulus, from the displacements of the elements that contain its ends. This is the quantity that a
//! bonded strip measures, for elements of any kind; it is also more accurate than stress at a point, which
//! jumps between elements.
use super::{error::ReductionError, mesh::Mesh};
use nalgebra::Vector3;

/// Strain gauge that measures vertical strain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gauge {
    /// Position of the gauge's middle in the beam frame \[m\].
    pub position: [f64; 3],
    /// Length of the gauge along y \[m\].
    pub length: f64,
}

/// Largest distance, in reference coordinates, by which a point may lie outside an element and still be
/// assigned to it.
const SLACK: f64 = 1e-3;

impl Gauge {
    /// Computes the gauge's reading as a linear function of nodal displacements: pairs of a node and a factor
    /// [Pa/m]; the reading \[Pa\] is the sum of factor times `u_y` of the node.
    ///
    /// # Errors
    /// [`ReductionError::Gauge`], with `number`, if an end of the gauge lies in no element.
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
            let shape = mesh.law().shape(&point);
            row.extend(nodes.iter().copied().zip(shape.iter().map(|n| factor * n)));
        }
        Ok(row)
    }
}

/// Finds the element that contains a position and the reference coordinates in it.
fn locate<'a>(
    mesh: &'a Mesh,
    place: &Vector3<f64>,
    number: usize,
) -> Result<(&'a [usize], [f64; 3]), ReductionError> {
    let law = mesh.law();
    let mut best: Option<(&[usize], [f64; 3], f64)> = None;
    let mut nearest = f64::INFINITY;
    for element in mesh.elements() {
        let nodes = mesh.places(element);
        let center = nodes
            .iter()
            .fold(Vector3::zeros(), |sum, node| sum + Vector3::from(*node))
            / nodes.len() as f64;
        let size = nodes
            .iter()
            .map(|node| (Vector3::from(*node) - center).norm())
            .fold(0.0, f64::max);
        let distance = (place - center).norm() - size;
        nearest = nearest.min(distance.max(0.0));
        // Newton wanders off for points far outside; they are not inside anyway
        if distance > 0.0 {
            continue;
        }
        let Some(point) = law.invert(&nodes, place) else {
            continue;
        };
        let outside = law.outside(&point);
        if best.as_ref().is_none_or(|(.., least)| outside < *least) {
            best = Some((element, point, outside));
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
