//! Material of the back head.
use nalgebra::Matrix3;

/// Isotropic, linear elastic material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steel {
    /// Young's modulus of the material \[Pa\].
    pub young: f64,
    /// Poisson's ratio of the material \[1\].
    pub poisson: f64,
    /// Density of the material [kg/m3].
    pub density: f64,
}

impl Steel {
    /// Returns Lamé's first coefficient and the shear modulus \[Pa\].
    pub(super) fn lame(&self) -> (f64, f64) {
        let shear = self.young / (2.0 * (1.0 + self.poisson));
        (
            2.0 * shear * self.poisson / (1.0 - 2.0 * self.poisson),
            shear,
        )
    }

    /// Returns the stress \[Pa\] under a displacement gradient `d u_row / d x_column`: xx, yy, zz, xy, yz, zx.
    pub(super) fn stress(&self, slope: &Matrix3<f64>) -> [f64; 6] {
        let (first, shear) = self.lame();
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
