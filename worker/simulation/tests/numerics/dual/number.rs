//! Dual numbers, which carry the derivative with respect to one parameter, and planar vectors of dual
//! numbers.
use std::ops::{Add, Mul, Neg, Sub};

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Dual(pub(super) f64, pub(super) f64);

impl Add for Dual {
    type Output = Self;
    fn add(self, y: Self) -> Self {
        Self(self.0 + y.0, self.1 + y.1)
    }
}

impl Sub for Dual {
    type Output = Self;
    fn sub(self, y: Self) -> Self {
        Self(self.0 - y.0, self.1 - y.1)
    }
}

impl Mul for Dual {
    type Output = Self;
    fn mul(self, y: Self) -> Self {
        Self(self.0 * y.0, self.0 * y.1 + self.1 * y.0)
    }
}

impl Neg for Dual {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0, -self.1)
    }
}

pub(super) const fn number(x: f64) -> Dual {
    Dual(x, 0.0)
}

impl Dual {
    pub(super) fn sqrt(self) -> Self {
        let root = self.0.sqrt();
        Self(root, 0.5 * self.1 / root)
    }

    pub(super) fn over(self, y: Self) -> Self {
        let x = self.0 / y.0;
        Self(x, (self.1 - x * y.1) / y.0)
    }
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Vector(pub(super) [Dual; 2]);

impl Vector {
    pub(super) const fn new(x: f64, y: f64) -> Self {
        Self([number(x), number(y)])
    }

    /// Returns the unit vector at an angle from the x axis.
    pub(super) fn at(angle: Dual) -> Self {
        let (s, c) = angle.0.sin_cos();
        Self([Dual(c, -s * angle.1), Dual(s, c * angle.1)])
    }

    pub(super) fn plus(self, r: Self) -> Self {
        Self([self.0[0] + r.0[0], self.0[1] + r.0[1]])
    }

    pub(super) fn minus(self, r: Self) -> Self {
        self.plus(-r)
    }

    pub(super) fn times(self, k: Dual) -> Self {
        Self(self.0.map(|x| x * k))
    }

    pub(super) fn dot(self, r: Self) -> Dual {
        self.0[0] * r.0[0] + self.0[1] * r.0[1]
    }

    /// Returns `z x r`, the vector turned by 90 degrees counter-clockwise.
    pub(super) fn across(self) -> Self {
        Self([-self.0[1], self.0[0]])
    }

    /// Returns the z component of `r x f`.
    pub(super) fn moment(self, f: Self) -> Dual {
        self.across().dot(f)
    }
}

impl Neg for Vector {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.map(|x| -x))
    }
}
