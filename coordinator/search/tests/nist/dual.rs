//! Dual numbers: values with their derivatives by a model's parameters, so that a model is written once and
//! its Jacobian columns are exact. Independent of any model.
//!
//! `f(a + a' e) = f(a) + f'(a) a' e` with `e^2 = 0` (forward differentiation).
use std::ops::{Add, Div, Mul, Neg, Sub};

pub(crate) const MOST: usize = 9;

/// Value with its derivatives by the parameters of a regression model.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dual {
    pub(crate) value: f64,
    pub(crate) by: [f64; MOST],
}

impl Dual {
    /// Creates the dual number of the model parameter with index `place`: derivative 1 by itself, 0 by the
    /// others.
    pub(crate) fn parameter(place: usize, value: f64) -> Self {
        let by = std::array::from_fn(|k| if k == place { 1.0 } else { 0.0 });
        Self { value, by }
    }

    /// Applies a function of one argument to this number by the chain rule, given the function's value and
    /// slope.
    fn through(self, value: f64, slope: f64) -> Self {
        let by = self.by.map(|own| slope * own);
        Self { value, by }
    }

    /// Applies a function of two arguments to this number and `other` by the chain rule, given the function's
    /// value and partial derivatives.
    fn with(self, other: Self, value: f64, [own, others]: [f64; 2]) -> Self {
        let by = std::array::from_fn(|k| own * self.by[k] + others * other.by[k]);
        Self { value, by }
    }

    pub(crate) fn exp(self) -> Self {
        let value = self.value.exp();
        self.through(value, value)
    }

    pub(crate) fn ln(self) -> Self {
        self.through(self.value.ln(), 1.0 / self.value)
    }

    pub(crate) fn sin(self) -> Self {
        self.through(self.value.sin(), self.value.cos())
    }

    pub(crate) fn cos(self) -> Self {
        self.through(self.value.cos(), -self.value.sin())
    }

    pub(crate) fn atan(self) -> Self {
        let slope = 1.0 / (1.0 + self.value * self.value);
        self.through(self.value.atan(), slope)
    }

    pub(crate) fn square(self) -> Self {
        self * self
    }

    /// Raises this number, which must be positive, to any power.
    pub(crate) fn pow(self, exponent: Self) -> Self {
        (exponent * self.ln()).exp()
    }
}

impl From<f64> for Dual {
    fn from(value: f64) -> Self {
        let by = [0.0; MOST];
        Self { value, by }
    }
}

impl<T: Into<Self>> Add<T> for Dual {
    type Output = Self;

    fn add(self, other: T) -> Self {
        let other = other.into();
        self.with(other, self.value + other.value, [1.0, 1.0])
    }
}

impl<T: Into<Self>> Sub<T> for Dual {
    type Output = Self;

    fn sub(self, other: T) -> Self {
        let other = other.into();
        self.with(other, self.value - other.value, [1.0, -1.0])
    }
}

impl<T: Into<Self>> Mul<T> for Dual {
    type Output = Self;

    fn mul(self, other: T) -> Self {
        let other = other.into();
        self.with(other, self.value * other.value, [other.value, self.value])
    }
}

impl<T: Into<Self>> Div<T> for Dual {
    type Output = Self;

    fn div(self, other: T) -> Self {
        let other = other.into();
        let value = self.value / other.value;
        self.with(other, value, [1.0 / other.value, -value / other.value])
    }
}

impl Neg for Dual {
    type Output = Self;

    fn neg(self) -> Self {
        self.through(-self.value, -1.0)
    }
}
