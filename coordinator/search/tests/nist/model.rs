//! Regression models of NIST's data sets, as the files of the sets state them.
use crate::dual::Dual;
use std::f64::consts::PI;

/// Regression model: function of parameters and predictors.
pub(crate) type Model = fn(&[Dual], &[f64]) -> Dual;

/// NIST data sets with their regression models, from lower to higher level of difficulty.
pub(crate) const MODELS: [(&str, Model); 27] = [
    ("Misra1a", saturation),
    ("Chwirut2", chwirut),
    ("Chwirut1", chwirut),
    ("Lanczos3", lanczos),
    ("Gauss1", gauss),
    ("Gauss2", gauss),
    ("DanWood", |b, x| Dual::from(x[0]).pow(b[1]) * b[0]),
    ("Misra1b", |b, x| {
        b[0] * (-(b[1] * (0.5 * x[0]) + 1.0).pow(Dual::from(-2.0)) + 1.0)
    }),
    ("Kirby2", |b, x| {
        polynomial(&b[..3], x[0]) / (polynomial(&b[3..], x[0]) * x[0] + 1.0)
    }),
    ("Hahn1", cubic),
    ("Nelson", |b, x| b[0] - b[1] * x[0] * (-b[2] * x[1]).exp()),
    ("MGH17", |b, x| {
        b[0] + b[1] * (-b[3] * x[0]).exp() + b[2] * (-b[4] * x[0]).exp()
    }),
    ("Lanczos1", lanczos),
    ("Lanczos2", lanczos),
    ("Gauss3", gauss),
    ("Misra1c", |b, x| {
        b[0] * (-(b[1] * (2.0 * x[0]) + 1.0).pow(Dual::from(-0.5)) + 1.0)
    }),
    ("Misra1d", |b, x| b[0] * b[1] * x[0] / (b[1] * x[0] + 1.0)),
    ("Roszman1", |b, x| {
        b[0] - b[1] * x[0] - (b[2] / (-b[3] + x[0])).atan() / PI
    }),
    ("ENSO", |b, x| {
        let wave = |period: Dual, cos: Dual, sin: Dual| {
            let angle = Dual::from(2.0 * PI * x[0]) / period;
            cos * angle.cos() + sin * angle.sin()
        };
        b[0] + wave(Dual::from(12.0), b[1], b[2]) + wave(b[3], b[4], b[5]) + wave(b[6], b[7], b[8])
    }),
    ("MGH09", |b, x| {
        let square = x[0] * x[0];
        b[0] * (b[1] * x[0] + square) / (b[2] * x[0] + b[3] + square)
    }),
    ("Thurber", cubic),
    ("BoxBOD", saturation),
    ("Rat42", |b, x| b[0] / ((b[1] - b[2] * x[0]).exp() + 1.0)),
    ("MGH10", |b, x| b[0] * (b[1] / (b[2] + x[0])).exp()),
    ("Eckerle4", |b, x| {
        b[0] / b[1] * (((-b[2] + x[0]) / b[1]).square() * -0.5).exp()
    }),
    ("Rat43", |b, x| {
        b[0] / ((b[1] - b[2] * x[0]).exp() + 1.0).pow(Dual::from(1.0) / b[3])
    }),
    ("Bennett5", |b, x| {
        b[0] * (b[1] + x[0]).pow(Dual::from(-1.0) / b[2])
    }),
];

fn saturation(b: &[Dual], x: &[f64]) -> Dual {
    b[0] * (-(-b[1] * x[0]).exp() + 1.0)
}

fn chwirut(b: &[Dual], x: &[f64]) -> Dual {
    (-b[0] * x[0]).exp() / (b[1] + b[2] * x[0])
}

fn lanczos(b: &[Dual], x: &[f64]) -> Dual {
    let term = |k: usize| b[k] * (-b[k + 1] * x[0]).exp();
    term(0) + term(2) + term(4)
}

fn gauss(b: &[Dual], x: &[f64]) -> Dual {
    let bell = |k: usize| b[k] * (-((-b[k + 1] + x[0]) / b[k + 2]).square()).exp();
    b[0] * (-b[1] * x[0]).exp() + bell(2) + bell(5)
}

fn cubic(b: &[Dual], x: &[f64]) -> Dual {
    polynomial(&b[..4], x[0]) / (polynomial(&b[4..], x[0]) * x[0] + 1.0)
}

/// Computes the polynomial `c_0 + c_1 x + ...`.
fn polynomial(coefficients: &[Dual], x: f64) -> Dual {
    let add = |sum: Dual, own: &Dual| sum * x + *own;
    coefficients.iter().rev().fold(Dual::from(0.0), add)
}
