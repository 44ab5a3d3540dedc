//! What a kind of element gives: shape functions on its reference body, stiffness, mass and stress.
use super::face::Face;
use super::integral::jacobian;
use super::steel::Steel;
use nalgebra::{DMatrix, Matrix3, Vector3};

/// What one element weighs in a structure; rows and columns node by node, x y z.
#[derive(Clone, Debug)]
pub(in crate::flexible) struct Matrices {
    /// Stiffness over the nodes alone [N/m].
    pub(in crate::flexible) stiffness: DMatrix<f64>,
    /// Mass over the nodes alone \[kg\].
    pub(in crate::flexible) mass: DMatrix<f64>,
}

/// An element whose volume vanishes or is negative somewhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::flexible) struct InsideOut;

/// Steps of Newton's method towards a point within an element.
const STEPS: usize = 30;

/// A kind of element on its reference body. Nodes are always all of one element, in Gmsh's order;
/// points are coordinates of the reference body.
pub(in crate::flexible) trait Element: Sync {
    /// Number of nodes n.
    fn nodes(&self) -> usize;

    /// Its faces.
    fn face(&self) -> &'static dyn Face;

    /// A point well inside.
    fn center(&self) -> [f64; 3];

    /// Shape functions at a point; n.
    fn shape(&self, point: &[f64; 3]) -> Vec<f64>;

    /// Their slopes in the reference body; n.
    fn slopes(&self, point: &[f64; 3]) -> Vec<Vector3<f64>>;

    /// How far a point lies outside the reference body, in its coordinates; negative inside.
    fn outside(&self, point: &[f64; 3]) -> f64;

    /// Stiffness and mass of an element with its nodes in place \[m\].
    ///
    /// # Errors
    /// [`InsideOut`] if the Jacobian is not positive at an integration point.
    fn matrices(&self, nodes: &[[f64; 3]], steel: &Steel) -> Result<Matrices, InsideOut>;
}

impl dyn Element {
    /// `d x_column / d xi_row` at a point.
    pub(in crate::flexible) fn jacobian(
        &self,
        nodes: &[[f64; 3]],
        point: &[f64; 3],
    ) -> Matrix3<f64> {
        jacobian(&self.slopes(point), nodes)
    }

    /// Coordinates of a place in the reference body, if Newton finds them.
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

    /// Stress at the centre \[Pa\]: xx, yy, zz, xy, yz, zx. Incompatible modes have no slope there.
    pub(in crate::flexible) fn center_stress(
        &self,
        steel: &Steel,
        nodes: &[[f64; 3]],
        displacement: &[[f64; 3]],
    ) -> [f64; 6] {
        let (first, shear) = steel.lame();
        let slopes = self.slopes(&self.center());
        let Some(inverse) = jacobian(&slopes, nodes).try_inverse() else {
            return [0.0; 6];
        };
        let mut slope = Matrix3::zeros();
        for (reference, u) in slopes.iter().zip(displacement) {
            slope += Vector3::from(*u) * (inverse * reference).transpose();
        }
        let pressure = first * slope.trace();
        let normal = |k: usize| pressure + 2.0 * shear * slope[(k, k)];
        let sliding = |i: usize, j: usize| shear * (slope[(i, j)] + slope[(j, i)]);
        [
            normal(0),
            normal(1),
            normal(2),
            sliding(0, 1),
            sliding(1, 2),
            sliding(2, 0),
        ]
    }
}
