//! What this record could tell apart, before any verdict: detection limits of single effects, and
//! how far two effects lie apart once recalibration has taken its share.
//!
//! `D_jk^2 = lambda_min(G~_j^T (I - P_G~k) G~_j)` with projected signatures per physical size: two
//! effects of size eta are told apart where `eta^2 D^2 > 11`. (Eriksson, Frisk, Krysander: distinguishability;
//! Doehler, Mevel, Zhang: min-max test.)
use crate::tangent::Tangent;
use nalgebra::DMatrix;
use statrs::distribution::{ChiSquared, ContinuousCDF as _};

/// An effect of size 1 is told apart from another where `D^2` exceeds this.
pub const APART: f64 = 11.0;

/// What an effect has to overcome to be seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hurdle {
    /// Tail probability that its own score test must fall below.
    pub p_value: f64,
    /// The misfit; variances are inflated by its square.
    pub phi: f64,
}

/// Normal quantile of the power at which a limit is stated: 90 %.
const POWER: f64 = 1.281_551_565_544_6;

/// The size from which one size of an effect is seen in nine records of ten, in units of its
/// signature's size; infinite if recalibration absorbs it.
///
/// `signature` holds all sizes of the effect, of which `column` is the one that is there;
/// `one_sided` says that it is the only one and has a sign. With `m` sizes and a noncentrality `d^2`
/// the statistic has mean `m + d^2` and variance `2 m + 4 d^2`, and must exceed the test's quantile.
pub fn detection_limit(
    signature: &DMatrix<f64>,
    column: usize,
    one_sided: bool,
    tangent: &Tangent,
    hurdle: &Hurdle,
) -> f64 {
    let one = signature.columns(column, 1);
    let own = one.dot(&tangent.project_columns(&one.into_owned()));
    if own.is_nan() || own <= 1e-9 * one.norm_squared() {
        return f64::INFINITY;
    }
    let m = signature.ncols() as f64;
    let p_value = if one_sided {
        2.0 * hurdle.p_value
    } else {
        hurdle.p_value
    };
    let quantile =
        ChiSquared::new(m).map_or(f64::INFINITY, |law| law.inverse_cdf(1.0 - p_value.min(0.5)));
    // m + d^2 - q sqrt(2 m + 4 d^2) = quantile, solved for s = sqrt(2 m + 4 d^2)
    let s = 2.0 * POWER
        + (4.0 * POWER * POWER + 4.0 * quantile - 2.0 * m)
            .max(0.0)
            .sqrt();
    let noncentrality = (0.25 * (s * s - 2.0 * m)).max(0.0);
    hurdle.phi * (noncentrality / own).sqrt()
}

/// How alike two effects are once recalibration has taken its share: the squared cosine of the
/// smallest angle between a direction of the first and the span of the second; 0 where either is
/// absorbed.
pub fn likeness(a: &DMatrix<f64>, b: &DMatrix<f64>, tangent: &Tangent) -> f64 {
    let visible = |g: &DMatrix<f64>| {
        let projected = tangent.project_columns(g);
        (projected.norm_squared() > 1e-9 * g.norm_squared()).then(|| orthonormal(&projected))
    };
    match (visible(a), visible(b)) {
        (Some(a), Some(b)) => {
            let overlap = a.tr_mul(&b);
            let eigen = overlap.tr_mul(&overlap).symmetric_eigenvalues();
            eigen.max().clamp(0.0, 1.0)
        }
        _ => 0.0,
    }
}

/// `D_jk^2` for every pair: row j, column k: how much of effect j per unit size no amount of
/// effect k, and no recalibration, explains.
pub fn distances(signatures: &[DMatrix<f64>], tangent: &Tangent) -> DMatrix<f64> {
    let projected: Vec<DMatrix<f64>> = signatures
        .iter()
        .map(|g| tangent.project_columns(g))
        .collect();
    let bases: Vec<DMatrix<f64>> = projected.iter().map(orthonormal).collect();
    DMatrix::from_fn(signatures.len(), signatures.len(), |j, k| {
        let left = &projected[j] - &bases[k] * bases[k].tr_mul(&projected[j]);
        left.tr_mul(&left).symmetric_eigenvalues().min().max(0.0)
    })
}

/// Effects grouped such that members of one group cannot be told apart at size 1; singletons are
/// isolable.
pub fn classes(distances: &DMatrix<f64>) -> Vec<Vec<usize>> {
    let n = distances.nrows();
    let mut group: Vec<usize> = (0..n).collect();
    for j in 0..n {
        for k in 0..j {
            if distances[(j, k)].min(distances[(k, j)]) < APART {
                let (from, to) = (group[j].max(group[k]), group[j].min(group[k]));
                for g in &mut group {
                    if *g == from {
                        *g = to;
                    }
                }
            }
        }
    }
    let mut classes: Vec<Vec<usize>> = Vec::new();
    for first in 0..n {
        let members: Vec<usize> = (0..n).filter(|&i| group[i] == first).collect();
        if !members.is_empty() {
            classes.push(members);
        }
    }
    classes
}

/// Orthonormal basis of the columns' span.
fn orthonormal(columns: &DMatrix<f64>) -> DMatrix<f64> {
    let svd = columns.clone().svd(true, false);
    let largest = svd.singular_values.max();
    let kept: Vec<usize> = (0..svd.singular_values.len())
        .filter(|&i| svd.singular_values[i] > 1e-9 * largest)
        .collect();
    svd.u.map_or_else(
        || DMatrix::zeros(columns.nrows(), 0),
        |u| u.select_columns(&kept),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DVector;
    use search::least_squares::Linearized;

    fn nothing(n: usize) -> Tangent {
        let at = Linearized {
            x: Vec::new(),
            residual: DVector::zeros(n),
            jacobian: DMatrix::zeros(n, 0),
        };
        Tangent::new(&at, &[])
    }

    fn column(values: &[f64]) -> DMatrix<f64> {
        DMatrix::from_column_slice(values.len(), 1, values)
    }

    #[test]
    fn limits_and_distances_follow_the_geometry() {
        let tangent = nothing(3);
        let (a, b) = (column(&[30.0, 0.0, 0.0]), column(&[30.0, 4.0, 0.0]));
        let c = column(&[0.0, 0.0, 5.0]);
        let d = distances(&[a, b, c], &tangent);
        // a's part across b: 30 sin(angle), angle = atan(4/30)
        let sine = 4.0 / (30.0_f64 * 30.0 + 16.0).sqrt();
        assert!((d[(0, 1)] - (30.0 * sine).powi(2)).abs() < 1e-9);
        assert!((d[(1, 0)] - 16.0).abs() < 1e-9);
        assert!((d[(2, 0)] - 25.0).abs() < 1e-9);
        assert_eq!(classes(&d), vec![vec![0], vec![1], vec![2]]);
        let near = distances(
            &[
                column(&[30.0, 0.0, 0.0]),
                column(&[30.0, 3.0, 0.0]),
                column(&[0.0, 0.0, 9.0]),
            ],
            &tangent,
        );
        assert_eq!(classes(&near), vec![vec![0, 1], vec![2]]);
    }

    /// One size whose estimate has deviation 1: found in nine of ten records where
    /// `P(|N(d, 1)| > sqrt(quantile)) = 0.9`.
    #[test]
    fn a_limit_has_the_power_that_it_states() {
        let tangent = nothing(1);
        let hurdle = Hurdle {
            p_value: 1e-3,
            phi: 1.0,
        };
        let limit = |strength: f64, hurdle: &Hurdle| {
            detection_limit(&column(&[strength]), 0, false, &tangent, hurdle)
        };
        // chi2_1 above 10.828 at p = 0.001, so d = 3.291 + 1.282
        let plain = limit(1.0, &hurdle);
        assert!((plain / (3.291 + 1.282) - 1.0).abs() < 0.03, "{plain}");
        // ten times the signature is seen at a tenth of the size; twice the misfit at twice it
        assert!((10.0 * limit(10.0, &hurdle) / plain - 1.0).abs() < 1e-9);
        let doubtful = Hurdle { phi: 2.0, ..hurdle };
        assert!((limit(1.0, &doubtful) / plain - 2.0).abs() < 1e-9);
        // a sign halves the tail
        let signed = detection_limit(&column(&[1.0]), 0, true, &tangent, &hurdle);
        assert!((signed / (3.090 + 1.282) - 1.0).abs() < 0.03, "{signed}");
    }
}
