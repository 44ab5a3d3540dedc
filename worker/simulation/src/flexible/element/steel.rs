//! Material of the back head.

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
}
