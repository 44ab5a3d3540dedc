//! Interface of an element kind: shape functions on the reference element, stiffness, mass and stress.
use super::face::Face;
use super::integral::jacobian;
use super::steel::Steel;
use nalgebra::{DMatrix, Matrix3, Vector3};

/// Stiffness and mass matrices of one element; rows and columns are ordered node by node, with x, y, z of
/// each node together.
#[derive(Clone, Debug)]
pub(in crate::flexible) struct Matrices {
    /// Element stiffness matrix over the nodal displacements [N/m].
    pub(in crate::flexible) stiffness: DMatrix<f64>,
    /// Element mass matrix over the nodal displacements \[kg\].
    pub(in crate::flexible) mass: DMatrix<f64>,
}

/// Error: an element whose Jacobian determinant is zero or negative at some integration point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::flexible) struct InsideOut;

/// Largest number of Newton steps in the search for the reference coordinates of a position.
const STEPS: usize = 30;

/// Element kind, defined on its reference element. Arguments `nodes` are the positions of all nodes of one
/// element, in Gmsh's order; points are reference coordinates.
pub(in crate::flexible) trait Element: Sync {
    /// Returns the number of nodes per element, called n below.
    fn nodes(&self) -> usize;

    /// Returns the kind of the element's faces.
    fn face(&self) -> &'static dyn Face;

    fn center(&self) -> [f64; 3];

    /// Returns the values of the n nodal shape functions at a point of the reference element.
    fn shape(&self, point: &[f64; 3]) -> Vec<f64>;

    /// Returns the gradients of the n nodal shape functions with respect to the reference coordinates, at a
    /// point.
    fn slopes(&self, point: &[f64; 3]) -> Vec<Vector3<f64>>;

    /// Returns how far a point lies outside the reference element, in reference coordinates; negative inside.
    fn outside(&self, point: &[f64; 3]) -> f64;

    /// Computes stiffness and mass of an element from the positions of its nodes \[m\].
    ///
    /// # Errors
    /// [`InsideOut`] if the determinant of the Jacobian is not positive at an integration point.
    fn matrices(&self, nodes: &[[f64; 3]], steel: &Steel) -> Result<Matrices, InsideOut>;

    /// Computes the stress \[Pa\] at the element's corners under each of several displacement fields, given at the
    /// element's nodes: xx, yy, zz, xy, yz, zx, extrapolated from the integration points of the stiffness.
    ///
    /// # Errors
    /// As [`Self::matrices`].
    fn corner_stress(
        &self,
        nodes: &[[f64; 3]],
        steel: &Steel,
        fields: &[Vec<[f64; 3]>],
    ) -> Result<Vec<Vec<[f64; 6]>>, InsideOut>;

    /// Returns the corners of each face of the element, outward seen counter-clockwise; a triangle repeats its last
    /// corner.
    fn faces(&self) -> &'static [[usize; 4]];
}

impl dyn Element {
    /// Computes the Jacobian `d x_column / d xi_row` of an element at a point of the reference element.
    pub(in crate::flexible) fn jacobian(
        &self,
        nodes: &[[f64; 3]],
        point: &[f64; 3],
    ) -> Matrix3<f64> {
        jacobian(&self.slopes(point), nodes)
    }

    /// Computes the reference coordinates of a position in an element by Newton's method, or `None` if the
    /// iteration does not converge.
    pub(in crate::flexible) fn invert(
        &self,
        nodes: &[[f64; 3]],
        place: &Vector3<f64>,
    ) -> Option<[f64; 3]> {
        let mut point = self.center();
        for _ in 0..STEPS {
            let mut here = Vector3::zeros();
            for (share, node) in self.shape(&point).iter().zip(nodes) {
                here += *share * Vector3::from(*node);
            }
            // the rows of the Jacobian are reference directions
            let inverse = self.jacobian(nodes, &point).transpose().try_inverse()?;
            let step = inverse * (place - here);
            for (x, dx) in point.iter_mut().zip(&step) {
                *x = (*x + dx).clamp(-3.0, 3.0);
            }
            if step.amax() < 1e-13 {
                return Some(point);
            }
        }
        None
    }

    /// Computes the stress at the element's centre \[Pa\] from the nodal displacements: xx, yy, zz, xy, yz,
    /// zx. The incompatible modes have zero gradient there and do not contribute.
    pub(in crate::flexible) fn center_stress(
        &self,
        steel: &Steel,
        nodes: &[[f64; 3]],
        displacement: &[[f64; 3]],
    ) -> [f64; 6] {
        let slopes = self.slopes(&self.center());
        let Some(inverse) = jacobian(&slopes, nodes).try_inverse() else {
            return [0.0; 6];
        };
        let mut slope = Matrix3::zeros();
        for (reference, u) in slopes.iter().zip(displacement) {
            slope += Vector3::from(*u) * (inverse * reference).transpose();
        }
        steel.stress(&slope)
    }
}
