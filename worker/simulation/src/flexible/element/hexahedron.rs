//! 8-node brick element with incompatible modes: stiffness and mass of one element.
//!
//! Displacement is `sum_i N_i d_i + sum_k (1 - xi_k^2) a_k`. The nine amplitudes `a` are internal to the
//! element and are condensed out; they let a brick bend without locking ([Wilson1973]). Their gradients are
//! taken with the Jacobian at the element's centre and scaled by `det J0 / det J`, so that they integrate to
//! zero and distorted elements pass the patch test ([Taylor1976]). The incompatible modes also carry mass:
//! the inertia of the full displacement is condensed with the same static shapes (Guyan 1965); without this
//! the frequencies of a thin plate of one brick layer are up to 2 % too high. All integrals use 2 x 2 x 2
//! Gauss points. This module knows one element and no mesh.
//!
//! `CalculiX`'s C3D8I is this element without the factor `det J0 / det J`, for which reason it fails the
//! patch test. With the factor removed, this element reproduces the frequencies of C3D8I to 1e-4; with the
//! factor, to 0.6 %.
use super::face::{Face, Quadrilateral};
use super::integral::{add_stiffness, add_weight, extrapolated, jacobian};
use super::interface::{Element, InsideOut, Matrices};
use super::steel::Steel;
use nalgebra::{DMatrix, Matrix3, SMatrix, SVector, Vector3};

/// Number of nodal displacements of one element (24).
const DOFS: usize = 24;
/// Number of internal amplitudes of the incompatible modes (9) of one element.
const INNER: usize = 9;
/// Number of scalar shape functions: 8 nodes and 3 incompatible modes.
const SHAPES: usize = 8 + INNER / 3;
/// Matrix over all nodal displacements of one element.
type Square = SMatrix<f64, DOFS, DOFS>;

/// 8-node brick element with incompatible modes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hexahedron;

/// Corners of the reference cube, in Gmsh's order of nodes.
const CORNERS: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

/// Returns the nodal shape functions at a point of the reference cube.
fn shape(point: &[f64; 3]) -> [f64; 8] {
    CORNERS.map(|corner| {
        0.125
            * (1.0 + corner[0] * point[0])
            * (1.0 + corner[1] * point[1])
            * (1.0 + corner[2] * point[2])
    })
}

/// Returns the gradients of the nodal shape functions with respect to the reference coordinates.
fn slopes(point: &[f64; 3]) -> [Vector3<f64>; 8] {
    CORNERS.map(|[a, b, c]| {
        let [r, s, t] = [1.0 + a * point[0], 1.0 + b * point[1], 1.0 + c * point[2]];
        Vector3::new(a * s * t, b * r * t, c * r * s) * 0.125
    })
}

/// Returns the shape functions of the eight nodes, then those of the three incompatible modes, at a point of
/// the reference cube.
fn all_shapes(point: &[f64; 3]) -> [f64; SHAPES] {
    let nodes = shape(point);
    std::array::from_fn(|i| {
        nodes
            .get(i)
            .copied()
            .unwrap_or_else(|| 1.0 - point[i - 8] * point[i - 8])
    })
}

/// Returns the 2 x 2 x 2 Gauss points; all weights are 1.
fn gauss() -> [[f64; 3]; 8] {
    let at = 1.0 / 3.0_f64.sqrt();
    CORNERS.map(|corner| corner.map(|sign| sign * at))
}

impl Element for Hexahedron {
    fn nodes(&self) -> usize {
        CORNERS.len()
    }

    fn face(&self) -> &'static dyn Face {
        &Quadrilateral
    }

    fn center(&self) -> [f64; 3] {
        [0.0; 3]
    }

    fn shape(&self, point: &[f64; 3]) -> Vec<f64> {
        shape(point).to_vec()
    }

    fn slopes(&self, point: &[f64; 3]) -> Vec<Vector3<f64>> {
        slopes(point).to_vec()
    }

    fn outside(&self, point: &[f64; 3]) -> f64 {
        point.iter().fold(0.0_f64, |most, x| most.max(x.abs())) - 1.0
    }

    /// Computes the element's stiffness and mass matrices after condensation of the incompatible modes.
    fn matrices(&self, nodes: &[[f64; 3]], steel: &Steel) -> Result<Matrices, InsideOut> {
        let points = integration_points(nodes)?;
        let mut weight = [[0.0; SHAPES]; SHAPES];
        for point in &points {
            let mass = steel.density * point.volume;
            add_weight(&mut weight, &all_shapes(&point.place), mass);
        }
        let full = stiffness(&points, steel);
        let outer = full.fixed_view::<DOFS, DOFS>(0, 0);
        let mixed = full.fixed_view::<INNER, DOFS>(DOFS, 0).into_owned();
        let follow = follow(&full)?;
        let stiffness: Square = outer - mixed.transpose() * follow;
        let mass = condensed(&weight, &follow);
        let dynamic = |matrix: &Square| DMatrix::from_column_slice(DOFS, DOFS, matrix.as_slice());
        Ok(Matrices {
            stiffness: dynamic(&stiffness),
            mass: dynamic(&mass),
        })
    }

    fn corner_stress(
        &self,
        nodes: &[[f64; 3]],
        steel: &Steel,
        fields: &[Vec<[f64; 3]>],
    ) -> Result<Vec<Vec<[f64; 6]>>, InsideOut> {
        let points = integration_points(nodes)?;
        let follow = follow(&stiffness(&points, steel))?;
        // the integration points are the corners of a smaller brick, beyond which the stress is continued
        let reach = 3.0_f64.sqrt();
        let shares = CORNERS.map(|corner| shape(&corner.map(|sign| sign * reach)));
        let corners = |field: &Vec<[f64; 3]>| {
            let outer = SVector::<f64, DOFS>::from_iterator(field.iter().flatten().copied());
            let inner = -(follow * outer);
            let stress = |point: &IntegrationPoint| {
                let mut slope = Matrix3::zeros();
                let amplitudes = outer.as_slice().chunks(3).chain(inner.as_slice().chunks(3));
                for (gradient, u) in point.gradients.iter().zip(amplitudes) {
                    slope += Vector3::from_column_slice(u) * gradient.transpose();
                }
                steel.stress(&slope)
            };
            let inside: Vec<[f64; 6]> = points.iter().map(stress).collect();
            let corner = |shares: &[f64; 8]| extrapolated(shares, &inside);
            shares.iter().map(corner).collect()
        };
        Ok(fields.iter().map(corners).collect())
    }

    fn faces(&self) -> &'static [[usize; 4]] {
        &[
            [0, 3, 2, 1],
            [0, 1, 5, 4],
            [0, 4, 7, 3],
            [1, 2, 6, 5],
            [2, 3, 7, 6],
            [4, 5, 6, 7],
        ]
    }
}

/// Number of all displacements of one element: those of its nodes and its internal amplitudes.
const ALL: usize = DOFS + INNER;

/// Integration point of an element.
struct IntegrationPoint {
    /// Reference coordinates of the point.
    place: [f64; 3],
    /// Gradients of all shape functions at the point [1/m].
    gradients: [Vector3<f64>; SHAPES],
    /// Volume that the point stands for \[m3\].
    volume: f64,
}

/// Computes the integration points of an element.
fn integration_points(nodes: &[[f64; 3]]) -> Result<Vec<IntegrationPoint>, InsideOut> {
    let center = jacobian(&slopes(&[0.0; 3]), nodes);
    let center_inverse = center.try_inverse().ok_or(InsideOut)?;
    let point = |place: [f64; 3]| {
        let slopes = slopes(&place);
        let jacobian = jacobian(&slopes, nodes);
        let volume = jacobian.determinant();
        if volume <= 0.0 {
            return Err(InsideOut);
        }
        let inverse = jacobian.try_inverse().ok_or(InsideOut)?;
        let mut gradients = [Vector3::zeros(); SHAPES];
        for (gradient, slope) in gradients.iter_mut().zip(slopes) {
            *gradient = inverse * slope;
        }
        let ratio = center.determinant() / volume;
        for (k, gradient) in gradients[8..].iter_mut().enumerate() {
            *gradient = center_inverse.column(k) * (-2.0 * place[k] * ratio);
        }
        Ok(IntegrationPoint {
            place,
            gradients,
            volume,
        })
    };
    gauss().into_iter().map(point).collect()
}

/// Computes the stiffness over all displacements of an element, before condensation.
fn stiffness(points: &[IntegrationPoint], steel: &Steel) -> Box<SMatrix<f64, ALL, ALL>> {
    let mut full = Box::new(SMatrix::<f64, ALL, ALL>::zeros());
    for point in points {
        add_stiffness(&mut full, &point.gradients, steel.lame(), point.volume);
    }
    full
}

/// Computes the matrix that gives minus the amplitudes of the incompatible modes from the nodal displacements.
fn follow(full: &SMatrix<f64, ALL, ALL>) -> Result<SMatrix<f64, INNER, DOFS>, InsideOut> {
    let mixed = full.fixed_view::<INNER, DOFS>(DOFS, 0).into_owned();
    let inner = full.fixed_view::<INNER, INNER>(DOFS, DOFS).into_owned();
    Ok(inner.cholesky().ok_or(InsideOut)?.solve(&mixed))
}

/// Computes the mass `T' M T` over the nodal displacements, with M the mass over all shape functions and `T =
/// (1, -follow)`: the amplitudes of the incompatible modes are `-follow` times the nodal displacements.
fn condensed(weight: &[[f64; SHAPES]; SHAPES], follow: &SMatrix<f64, INNER, DOFS>) -> Square {
    // M T, of which every direction is its own
    let part = |shape: usize, k: usize, column: usize| {
        let own = if column % 3 == k {
            weight[shape][column / 3]
        } else {
            0.0
        };
        let inner = (0..INNER / 3).map(|m| weight[shape][8 + m] * follow[(3 * m + k, column)]);
        own - inner.sum::<f64>()
    };
    let outer = Square::from_fn(|row, column| part(row / 3, row % 3, column));
    let inner =
        SMatrix::<f64, INNER, DOFS>::from_fn(|row, column| part(8 + row / 3, row % 3, column));
    outer - follow.transpose() * inner
}
