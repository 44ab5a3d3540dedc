//! Isolability of effects from a record, before any verdict: detection limits of single effects, and
//! distances between pairs of effects after recalibration has absorbed its share.
//!
//! `D_jk^2 = g~_j^T (I - P_G~k) g~_j` with projected signatures: two effects are distinguishable where `D^2 >
//! 11`. (Eriksson, Frisk, Krysander: distinguishability; Doehler, Mevel, Zhang: min-max test.)
use crate::linear::tangent::Tangent;
use crate::thresholds::APART;
use nalgebra::DMatrix;
use statrs::distribution::{ChiSquared, ContinuousCDF as _};

/// Requirements that an effect must meet to be detected, used for detection limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DetectionThreshold {
    /// Largest p-value of an effect's own score test at which the effect counts as detected.
    pub p_value: f64,
    /// Variance of the residual in units of the noise variance.
    pub dispersion: f64,
}

/// Standard normal quantile of the detection probability for which a limit is stated: 90 %.
const POWER: f64 = 1.281_551_565_544_6;

/// Returns the detection limit of one size of an effect: the size that is detected in 90 % of records, in
/// units of the signature's size; infinite if recalibration absorbs it.
///
/// `signature` holds all sizes of the effect, of which `column` is the one that is present; `one_sided`
/// states that it is the only one and has a sign. With `m` sizes and a noncentrality `d^2` the statistic has
/// mean `m + d^2` and variance `2 m + 4 d^2`, and must exceed the test's quantile.
pub fn detection_limit(
    signature: &DMatrix<f64>,
    column: usize,
    one_sided: bool,
    tangent: &Tangent,
    hurdle: &DetectionThreshold,
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
    (hurdle.dispersion * noncentrality / own).sqrt()
}

/// Returns the similarity of two effects after recalibration has absorbed its share: the squared cosine of
/// the smallest principal angle between their projected signatures; 0 where either is absorbed.
pub fn similarity(a: &DMatrix<f64>, b: &DMatrix<f64>, tangent: &Tangent) -> f64 {
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

/// Returns `D_jk^2` for every pair of effects (row j, column k): the squared length of the part of effect j's
/// signature that neither effect k nor recalibration explains. Of an effect with several size parameters the
/// least visible one counts. Effects have the sizes to which their signatures belong.
pub fn distances(signatures: &[DMatrix<f64>], tangent: &Tangent) -> DMatrix<f64> {
    let projected: Vec<DMatrix<f64>> = signatures
        .iter()
        .map(|g| tangent.project_columns(g))
        .collect();
    let bases: Vec<DMatrix<f64>> = projected.iter().map(orthonormal).collect();
    DMatrix::from_fn(signatures.len(), signatures.len(), |j, k| {
        let left = &projected[j] - &bases[k] * bases[k].tr_mul(&projected[j]);
        let each = left.column_iter().map(|column| column.norm_squared());
        each.fold(f64::INFINITY, f64::min)
    })
}

/// Distinguishability of a pair of effects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Separation {
    /// Indices of the two effects, in ascending order.
    pub members: [usize; 2],
    /// Smaller of the two distances `D^2` of the pair, divided by the distance needed to tell them apart at
    /// this dispersion.
    pub relative_distance: f64,
}

/// Returns the distinguishability of all pairs of effects, which are given by their signatures, for a
/// residual of the given dispersion.
pub fn pairs(signatures: &[DMatrix<f64>], tangent: &Tangent, dispersion: f64) -> Vec<Separation> {
    let distances = distances(signatures, tangent);
    let n = signatures.len();
    let of = |j: usize, k: usize| Separation {
        members: [j, k],
        relative_distance: distances[(j, k)].min(distances[(k, j)]) / (APART * dispersion),
    };
    (0..n)
        .flat_map(|j| (j + 1..n).map(move |k| of(j, k)))
        .collect()
}

/// Returns an orthonormal basis of the span of the columns.
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

    fn c_of(third: f64) -> DVector<f64> {
        DVector::from_column_slice(&[0.0, 0.0, third])
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
        let near = pairs(
            &[
                column(&[30.0, 0.0, 0.0]),
                column(&[30.0, 3.0, 0.0]),
                column(&[0.0, 0.0, 9.0]),
            ],
            &tangent,
            1.0,
        );
        let alike: Vec<[usize; 2]> = near
            .iter()
            .filter(|pair| pair.relative_distance < 1.0)
            .map(|pair| pair.members)
            .collect();
        assert_eq!(alike, vec![[0, 1]]);
        // a size that hides behind the other effect is the one that counts
        let two =
            DMatrix::from_columns(&[c_of(9.0), c_of(0.0) + column(&[3.0, 0.0, 0.0]).column(0)]);
        let d = distances(&[two, column(&[1.0, 0.0, 0.0])], &tangent);
        assert!(d[(0, 1)] < 1e-9);
    }

    /// Checks the power of a detection limit for one size whose estimate has standard deviation 1: detected
    /// in nine of ten records where `P(|N(d, 1)| > sqrt(quantile)) = 0.9`.
    #[test]
    fn a_limit_has_the_power_that_it_states() {
        let tangent = nothing(1);
        let hurdle = DetectionThreshold {
            p_value: 1e-3,
            dispersion: 1.0,
        };
        let limit = |strength: f64, hurdle: &DetectionThreshold| {
            detection_limit(&column(&[strength]), 0, false, &tangent, hurdle)
        };
        // chi2_1 above 10.828 at p = 0.001, so d = 3.291 + 1.282
        let plain = limit(1.0, &hurdle);
        assert!((plain / (3.291 + 1.282) - 1.0).abs() < 0.03, "{plain}");
        // ten times the signature is seen at a tenth of the size; four times the variance at twice it
        assert!((10.0 * limit(10.0, &hurdle) / plain - 1.0).abs() < 1e-9);
        let doubtful = DetectionThreshold {
            dispersion: 4.0,
            ..hurdle
        };
        assert!((limit(1.0, &doubtful) / plain - 2.0).abs() < 1e-9);
        // a sign halves the tail
        let signed = detection_limit(&column(&[1.0]), 0, true, &tangent, &hurdle);
        assert!((signed / (3.090 + 1.282) - 1.0).abs() < 0.03, "{signed}");
    }
}
