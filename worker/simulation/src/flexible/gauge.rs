//! Strain gauges: linear map from the displacement field to the stress reading of a gauge at a given
//! position.
//!
//! A gauge along the unit vector d reads `E d . (u(p + l/2 d) - u(p - l/2 d)) / l`: the mean strain over its
//! length times Young's modulus, from the displacements of the elements that contain its ends. This is the
//! quantity that a bonded strip measures, for elements of any kind; it is also more accurate than stress at a
//! point, which jumps between elements.
use super::{error::ReductionError, mesh::Mesh};
use nalgebra::Vector3;

/// Strain gauge on a head.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gauge {
    /// Position of the gauge's middle in the beam frame \[m\].
    pub position: [f64; 3],
    /// Unit vector along the gauge in the beam frame.
    pub direction: [f64; 3],
    /// Length of the gauge \[m\].
    pub length: f64,
}

/// Contribution of the displacement of one node to the reading of a gauge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Term {
    /// Index of the node.
    pub(super) node: usize,
    /// Factors of the node's displacements along x, y and z [Pa/m].
    pub(super) factors: [f64; 3],
    /// Whether the displacement is that of the node's mirror image, which the half of a mesh lacks.
    pub(super) image: bool,
}

/// Largest distance, in reference coordinates, by which a point may lie outside an element and still be
/// assigned to it.
const SLACK: f64 = 1e-3;

/// Largest distance by which an end of a gauge may lie outside the body \[m\]: places are measured no better, and straight
/// edges lie beside a curved surface. The displacement there is that of the nearest element, continued.
const OFF_BODY: f64 = 1e-3;

impl Gauge {
    /// Computes the gauge's reading as a linear function of nodal displacements; the reading \[Pa\] is the
    /// sum over all terms. On the half of a mesh, an end of the gauge at z < 0 is looked up at its mirror
    /// image.
    ///
    /// # Errors
    /// [`ReductionError::Gauge`], with `number`, if an end of the gauge lies in no element.
    pub(super) fn row(
        &self,
        mesh: &Mesh,
        young: f64,
        number: usize,
    ) -> Result<Vec<Term>, ReductionError> {
        let mut row = Vec::with_capacity(16);
        for side in [1.0, -1.0] {
            let along = Vector3::from(self.direction);
            let mut end = Vector3::from(self.position) + 0.5 * side * self.length * along;
            let image = mesh.half && end.z < 0.0;
            if image {
                end.z = -end.z;
            }
            let (nodes, point) = locate(mesh, &end, number)?;
            let factor = side * young / self.length;
            let shape = mesh.law().shape(&point);
            row.extend(nodes.iter().zip(shape).map(|(&node, share)| Term {
                node,
                factors: self.direction.map(|along| factor * share * along),
                image,
            }));
        }
        Ok(row)
    }

    /// Computes how the gauge's reading under a load changes when the gauge is moved along x, y and z [Pa/m],
    /// by differences over its own length; on one side only where the other has left the body. Returns `None`
    /// for an axis on which both have. `reading` evaluates a row under the load.
    pub(super) fn gradient(
        &self,
        mesh: &Mesh,
        young: f64,
        reading: &dyn Fn(&[Term]) -> f64,
    ) -> [Option<f64>; 3] {
        [0, 1, 2].map(|axis| {
            let moved = |by: f64| {
                let mut there = *self;
                there.position[axis] += by;
                let row = there.row(mesh, young, 0).ok()?;
                Some((by, reading(&row)))
            };
            let step = 0.5 * self.length;
            let ends = [-step, 0.0, step].map(moved);
            let mut inside = ends.into_iter().flatten();
            let (first, last) = (inside.next()?, inside.last()?);
            Some((last.1 - first.1) / (last.0 - first.0))
        })
    }
}

/// Finds the element that contains a position, or is at most [`OFF_BODY`] from it, and the reference coordinates in it.
fn locate<'a>(
    mesh: &'a Mesh,
    place: &Vector3<f64>,
    number: usize,
) -> Result<(&'a [usize], [f64; 3]), ReductionError> {
    let law = mesh.law();
    let mut best: Option<(&[usize], [f64; 3], f64)> = None;
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
        // Newton wanders off for points far outside; they are not inside anyway
        if (place - center).norm() - size > OFF_BODY {
            continue;
        }
        let Some(point) = law.invert(&nodes, place) else {
            continue;
        };
        let outside = law.outside(&point);
        let is_near = outside <= SLACK || outside * size <= OFF_BODY;
        if is_near && best.as_ref().is_none_or(|(.., least)| outside < *least) {
            best = Some((element, point, outside));
        }
    }
    best.map(|(element, point, _)| (element, point))
        .ok_or(ReductionError::Gauge { gauge: number })
}
