//! Scalar stress of a tensor, as fatigue curves need it.
use std::f64::consts::PI;

/// Stress tensor \[MPa\]: xx, yy, zz, xy, yz, zx.
pub type Tensor = [f64; 6];

/// Returns the equivalent stress of von Mises \[MPa\].
pub fn von_mises([xx, yy, zz, xy, yz, zx]: &Tensor) -> f64 {
    let square = |x: f64| x * x;
    let normal = square(xx - yy) + square(yy - zz) + square(zz - xx);
    let shear = square(*xy) + square(*yz) + square(*zx);
    (0.5 * normal + 3.0 * shear).sqrt()
}

/// Returns the equivalent stress of von Mises with the sign of the mean normal stress \[MPa\].
pub fn signed_von_mises(tensor: &Tensor) -> f64 {
    let trace = tensor[0] + tensor[1] + tensor[2];
    von_mises(tensor).copysign(trace)
}

/// Returns the normal stress on the plane with a unit normal \[MPa\].
pub fn normal_stress([xx, yy, zz, xy, yz, zx]: &Tensor, [a, b, c]: &[f64; 3]) -> f64 {
    xx * a * a + yy * b * b + zz * c * c + 2.0 * (xy * a * b + yz * b * c + zx * c * a)
}

/// Returns `count` unit vectors in the tangent plane of a surface with a unit normal, equally spaced over half a turn:
/// the normals of planes perpendicular to the surface.
pub fn directions(normal: &[f64; 3], count: u32) -> Vec<[f64; 3]> {
    let [x, y, z] = *normal;
    // the axis that is farthest from the normal spans the plane
    let axis = if x.abs() <= y.abs() && x.abs() <= z.abs() {
        [1.0, 0.0, 0.0]
    } else if y.abs() <= z.abs() {
        [0.0, 1.0, 0.0]
    } else {
        [0.0, 0.0, 1.0]
    };
    let first = unit(cross(normal, &axis));
    let second = cross(normal, &first);
    let direction = |k: u32| {
        let (s, c) = libm::sincos(PI * f64::from(k) / f64::from(count));
        [0, 1, 2].map(|axis| c * first[axis] + s * second[axis])
    };
    (0..count).map(direction).collect()
}

fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn unit(vector: [f64; 3]) -> [f64; 3] {
    let length = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
    vector.map(|x| x / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_uniaxial_stress_is_found_in_its_direction() {
        // 120 MPa along (0.6, 0.8, 0)
        let tensor = [43.2, 76.8, 0.0, 57.6, 0.0, 0.0];
        assert!((von_mises(&tensor) - 120.0).abs() < 1e-9);
        assert!((signed_von_mises(&tensor.map(|s| -s)) + 120.0).abs() < 1e-9);
        assert!((normal_stress(&tensor, &[0.6, 0.8, 0.0]) - 120.0).abs() < 1e-9);
        let planes = directions(&[0.0, 0.0, 1.0], 180);
        let most = planes.iter().map(|plane| normal_stress(&tensor, plane));
        assert!((most.fold(0.0, f64::max) - 120.0).abs() < 0.05);
    }

    #[test]
    fn directions_lie_in_the_surface() {
        for normal in [
            [0.0, 0.0, 1.0],
            [1.0, 0.0, 0.0],
            [0.6, 0.0, -0.8],
            [0.48, 0.6, 0.64],
        ] {
            for own in directions(&normal, 6) {
                let dot: f64 = own.iter().zip(&normal).map(|(a, b)| a * b).sum();
                let square: f64 = own.iter().map(|x| x * x).sum();
                assert!(dot.abs() < 1e-12 && (square - 1.0).abs() < 1e-12);
            }
        }
    }
}
