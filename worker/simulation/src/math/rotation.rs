//! Finite rotations: cross-product matrices, rotation vectors and their derivatives.
use crate::math::elementary::atan2;
use nalgebra::{Matrix3, Vector3};

/// Returns the matrix of the cross product: `skew(a) b = a x b`.
#[inline]
pub fn skew(a: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::new(0.0, -a.z, a.y, a.z, 0.0, -a.x, -a.y, a.x, 0.0)
}

/// Returns the rotation matrix about z that turns the x axis into `(cosine, sine)`.
pub fn about_z(sine: f64, cosine: f64) -> Matrix3<f64> {
    Matrix3::new(cosine, -sine, 0.0, sine, cosine, 0.0, 0.0, 0.0, 1.0)
}

/// Returns the rotation vector (axis times angle, |.| <= pi) of the rotation `R_WI R_WJ^T` of frame I
/// relative to frame J, in the world frame W \[rad\].
///
/// Computed from the skew-symmetric part of the matrix, so that small angles keep full precision.
pub fn rotation_vector(R_WI: &Matrix3<f64>, R_WJ: &Matrix3<f64>) -> Vector3<f64> {
    let R = R_WI * R_WJ.transpose();
    let axial = Vector3::new(
        R[(2, 1)] - R[(1, 2)],
        R[(0, 2)] - R[(2, 0)],
        R[(1, 0)] - R[(0, 1)],
    ) * 0.5;
    let cosine = (R.trace() - 1.0) * 0.5;
    let sine2 = axial.norm_squared();
    if cosine > 0.0 && sine2 < 1e-3 {
        // asin(s)/s as a series: exact to 1e-17 for angles below 0.03 rad
        return axial
            * (1.0
                + sine2
                    * (1.0 / 6.0
                        + sine2
                            * (3.0 / 40.0
                                + sine2
                                    * (15.0 / 336.0
                                        + sine2 * (105.0 / 3456.0 + sine2 * 945.0 / 42240.0)))));
    }
    let sine = sine2.sqrt();
    let angle = atan2(sine, cosine);
    if sine > 1e-6 {
        return axial * (angle / sine);
    }
    // half a turn: the axis is the dominant column of R + I
    let S = R + Matrix3::identity();
    let k = (0..3)
        .max_by(|&a, &b| S[(a, a)].total_cmp(&S[(b, b)]))
        .unwrap_or(0);
    let axis = S.column(k).into_owned();
    axis * (angle / axis.norm().max(1e-300))
}

/// Returns the inverse of the left Jacobian of the rotation vector `theta`: `d theta = J^-1 d alpha` for a
/// further rotation `d alpha` in the world frame. Its transpose is the inverse of the right Jacobian.
pub fn inverse_left_jacobian(theta: &Vector3<f64>) -> Matrix3<f64> {
    let a2 = theta.norm_squared();
    let factor = if a2 < 1e-2 {
        1.0 / 12.0 + a2 * (1.0 / 720.0 + a2 / 30240.0)
    } else {
        let a = a2.sqrt();
        let (s, c) = crate::math::elementary::sin_cos(a);
        1.0 / a2 - (1.0 + c) / (2.0 * a * s)
    };
    let S = skew(theta);
    Matrix3::identity() - S * 0.5 + S * S * factor
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::elementary::sin_cos;

    fn exp(theta: &Vector3<f64>) -> Matrix3<f64> {
        let a = theta.norm();
        let S = skew(theta);
        let (s, c) = sin_cos(a);
        Matrix3::identity() + S * (s / a) + S * S * ((1.0 - c) / (a * a))
    }

    #[test]
    fn rotation_vector_inverts_the_exponential() {
        let base = exp(&Vector3::new(0.3, -1.1, 0.7));
        for scale in [1e-9, 1e-4, 0.02, 0.04, 0.5, 2.0, 3.1] {
            let theta = Vector3::new(0.36, -0.48, 0.8) * scale;
            let found = rotation_vector(&(exp(&theta) * base), &base);
            assert!(
                (found - theta).norm() < 2e-15 * (1.0 + 10.0 * scale),
                "{scale}: {found}"
            );
        }
    }

    #[test]
    fn inverse_left_jacobian_is_the_derivative() {
        for scale in [0.05, 0.2, 1.5] {
            let theta = Vector3::new(0.36, -0.48, 0.8) * scale;
            let J = inverse_left_jacobian(&theta);
            let base = Matrix3::identity();
            for k in 0..3 {
                let mut d = Vector3::zeros();
                d[k] = 1e-6;
                let plus = rotation_vector(&(exp(&d) * exp(&theta)), &base);
                let minus = rotation_vector(&(exp(&-d) * exp(&theta)), &base);
                let column = (plus - minus) / 2e-6;
                assert!((column - J.column(k)).norm() < 1e-8, "{scale} {k}");
            }
        }
    }
}
