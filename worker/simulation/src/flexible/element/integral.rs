//! Contributions of one integration point, shared by all element kinds: Jacobian, stiffness and mass.
use nalgebra::{Matrix3, SMatrix, Vector3};

/// Returns the Jacobian `d x_column / d xi_row` from the gradients of the shape functions.
pub(super) fn jacobian(slopes: &[Vector3<f64>], nodes: &[[f64; 3]]) -> Matrix3<f64> {
    let mut jacobian = Matrix3::zeros();
    for (slope, node) in slopes.iter().zip(nodes) {
        jacobian += slope * Vector3::from(*node).transpose();
    }
    jacobian
}

/// Adds the contribution of one integration point to a stiffness matrix: for gradients `g` and an isotropic
/// material the block of shapes i, j is `lambda g_i g_j' + mu (g_j g_i' + g_i . g_j)`.
pub(super) fn add_stiffness<const ALL: usize>(
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

/// Adds the contribution of one integration point to the scalar mass matrix of the shape functions, which is
/// the same for x, y and z.
pub(super) fn add_weight<const SHAPES: usize>(
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

/// Returns the stress at a point as the sum of the stresses at the integration points, times the share of each.
pub(super) fn extrapolated(shares: &[f64], inside: &[[f64; 6]]) -> [f64; 6] {
    let mut stress = [0.0; 6];
    for (share, inside) in shares.iter().zip(inside) {
        for (stress, inside) in stress.iter_mut().zip(inside) {
            *stress += share * inside;
        }
    }
    stress
}
