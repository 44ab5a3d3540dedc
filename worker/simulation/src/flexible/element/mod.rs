//! Kinds of finite elements: what the head asks of one, whatever its shape.
//!
//! A kind is one file and one line of [`ElementKind::law`]. Knows one element in its place, no mesh.
mod face;
mod hexahedron;
#[cfg(test)]
mod tests;
mod tetrahedron;

pub(super) use face::{Crossing, Cut, Face};

use nalgebra::{DMatrix, Matrix3, SMatrix, Vector3};

/// What a mesh is made of: one kind throughout. Bricks and tetrahedra do not fit face to face, so a
/// mesh of both would be cracked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ElementKind {
    /// Bricks of 8 nodes with incompatible modes; faces of 4 nodes.
    #[default]
    Hexahedron,
    /// Quadratic tetrahedra of 10 nodes, edges straight or curved; faces of 6 nodes.
    Tetrahedron,
}

impl ElementKind {
    pub(super) const fn law(self) -> &'static dyn Element {
        match self {
            Self::Hexahedron => &hexahedron::Hexahedron,
            Self::Tetrahedron => &tetrahedron::Tetrahedron,
        }
    }
}

/// Isotropic, linear elastic material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steel {
    /// Young's modulus \[Pa\].
    pub young: f64,
    /// Poisson's ratio \[1\].
    pub poisson: f64,
    /// Density [kg/m3].
    pub density: f64,
}

impl Steel {
    /// Lamé's coefficients \[Pa\]: first, and the shear modulus.
    fn lame(&self) -> (f64, f64) {
        let shear = self.young / (2.0 * (1.0 + self.poisson));
        (
            2.0 * shear * self.poisson / (1.0 - 2.0 * self.poisson),
            shear,
        )
    }
}

/// What one element weighs in a structure; rows and columns node by node, x y z.
#[derive(Clone, Debug)]
pub(super) struct Matrices {
    /// Stiffness over the nodes alone [N/m].
    pub(super) stiffness: DMatrix<f64>,
    /// Mass over the nodes alone \[kg\].
    pub(super) mass: DMatrix<f64>,
}

/// An element whose volume vanishes or is negative somewhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct InsideOut;

/// Steps of Newton's method towards a point within an element.
const STEPS: usize = 30;

/// A kind of element on its reference body. Nodes are always all of one element, in Gmsh's order;
/// points are coordinates of the reference body.
pub(super) trait Element: Sync {
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
    pub(super) fn jacobian(&self, nodes: &[[f64; 3]], point: &[f64; 3]) -> Matrix3<f64> {
        jacobian(&self.slopes(point), nodes)
    }

    /// Coordinates of a place in the reference body, if Newton finds them.
    pub(super) fn invert(&self, nodes: &[[f64; 3]], place: &Vector3<f64>) -> Option<[f64; 3]> {
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
    pub(super) fn center_stress(
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

/// `d x_column / d xi_row` from the slopes of the shape functions.
fn jacobian(slopes: &[Vector3<f64>], nodes: &[[f64; 3]]) -> Matrix3<f64> {
    let mut jacobian = Matrix3::zeros();
    for (slope, node) in slopes.iter().zip(nodes) {
        jacobian += slope * Vector3::from(*node).transpose();
    }
    jacobian
}

/// Adds one integration point to a stiffness: for gradients `g` and an isotropic material the block
/// of shapes i, j is `lambda g_i g_j' + mu (g_j g_i' + g_i . g_j)`.
fn add_stiffness<const ALL: usize>(
    full: &mut SMatrix<f64, ALL, ALL>,
    gradients: &[Vector3<f64>],
    (first, shear): (f64, f64),
    volume: f64,
) {
    for (i, a) in gradients.iter().enumerate() {
        for (j, b) in gradients.iter().enumerate() {
            let both = shear * volume * a.dot(b);
            for k in 0..3 {
                for l in 0..3 {
                    let mut entry = volume * (first * a[k] * b[l] + shear * a[l] * b[k]);
                    if k == l {
                        entry += both;
                    }
                    full[(3 * i + k, 3 * j + l)] += entry;
                }
            }
        }
    }
}

/// Adds one integration point to the mass between shapes, the same for every direction.
fn add_weight<const SHAPES: usize>(
    weight: &mut [[f64; SHAPES]; SHAPES],
    shapes: &[f64; SHAPES],
    mass: f64,
) {
    for (row, a) in weight.iter_mut().zip(shapes) {
        for (entry, b) in row.iter_mut().zip(shapes) {
            *entry += mass * a * b;
        }
    }
}
