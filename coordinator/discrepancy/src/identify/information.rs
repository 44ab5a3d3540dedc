//! Fisher information of a fit: covariances, and the eigenvectors of the information of the unknowns.
//!
//! Whitened residuals have variance 1, so the information of a record is `J^T J`; priors add their own. The
//! information of the record is divided by the dispersion (Cramér-Rao bound, widened).
use super::answer::{Direction, DirectionPart};
use crate::estimate::spread::Spread;
use crate::model::fit::Fit;
use nalgebra::{DMatrix, DVector};
use protocol::case::Scale;
use search::least_squares::Variable;

/// Returns the Fisher information `J^T J` of a Jacobian plus that of the priors.
pub(super) fn with_priors(jacobian: &DMatrix<f64>, variables: &[Variable]) -> DMatrix<f64> {
    let mut information = jacobian.tr_mul(jacobian);
    for (k, v) in variables.iter().enumerate() {
        if let Some(prior) = v.prior {
            information[(k, k)] += 1.0 / (prior.deviation * prior.deviation);
        }
    }
    information
}

/// Returns the inverse of an information matrix, the covariance; `None` if some combination of variables is
/// not determined.
pub(super) fn inverse(information: DMatrix<f64>) -> Option<DMatrix<f64>> {
    Some(information.cholesky()?.inverse())
}

/// Returns the correlation of two variables from their covariance matrix.
pub(super) fn correlation(covariance: &DMatrix<f64>, i: usize, j: usize) -> f64 {
    covariance[(i, j)] / (covariance[(i, i)] * covariance[(j, j)]).sqrt()
}

/// Returns the information of the first `unknowns` variables after marginalising the others (Schur
/// complement). The priors of the others are included, those of the unknowns are not.
fn of_unknowns(jacobian: &DMatrix<f64>, variables: &[Variable], unknowns: usize) -> DMatrix<f64> {
    let whole = with_priors(jacobian, variables);
    let rest = whole.nrows() - unknowns;
    let own = jacobian.columns(0, unknowns);
    let mut information = own.tr_mul(&own);
    let others = whole.view((unknowns, unknowns), (rest, rest)).into_owned();
    if let Some(factor) = others.cholesky() {
        let coupling = whole.view((unknowns, 0), (rest, unknowns)).into_owned();
        information -= coupling.tr_mul(&factor.solve(&coupling));
    }
    information
}

/// Minimum absolute component of an unknown that is listed in a direction.
const LEAST_PART: f64 = 0.1;
/// Minimum absolute component of an unknown that is named in a direction's description.
const NAMED: f64 = 0.3;
/// Standard deviation (decades) from which a direction counts as undetermined: the 95 % interval is then a
/// factor of a thousand either way.
const BLIND: f64 = 1.5;

/// Returns the eigenvectors of the information of a fit's unknowns, best determined first.
pub(super) fn directions(fit: &Fit, spread: &Spread) -> Vec<Direction> {
    let unknowns = fit.model.space.dimension();
    let jacobian = &fit.search.best().jacobian;
    let scaled = jacobian / spread.dispersion.sqrt();
    let eigen = of_unknowns(&scaled, fit.variables(), unknowns).symmetric_eigen();
    let mut order: Vec<usize> = (0..unknowns).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    let largest = order.first().map_or(0.0, |&k| eigen.eigenvalues[k]);
    let direction = |k: usize| {
        // sixteen digits of the largest are rounding
        let seen = eigen.eigenvalues[k] > 1e-14 * largest;
        let deviation = if seen {
            let along = eigen.eigenvectors.column(k);
            // the root of the mean square of the growths, by how much of each unknown lies along it
            let growth = along.iter().zip(spread.growth.iter());
            let square: f64 = growth.map(|(part, own)| (part * own).powi(2)).sum();
            (square / eigen.eigenvalues[k]).sqrt()
        } else {
            f64::INFINITY
        };
        described(fit, eigen.eigenvectors.column(k).into_owned(), deviation)
    };
    order.into_iter().map(direction).collect()
}

fn described(fit: &Fit, mut along: DVector<f64>, deviation: f64) -> Direction {
    // the largest part is positive
    let sign = along.iter().fold(0.0_f64, |largest, part| {
        if part.abs() > largest.abs() {
            *part
        } else {
            largest
        }
    });
    along *= sign.signum();
    let axes = fit.model.space.axes();
    let mut order: Vec<usize> = (0..along.len()).collect();
    order.sort_by(|&a, &b| along[b].abs().total_cmp(&along[a].abs()).then(a.cmp(&b)));
    order.retain(|&k| along[k].abs() >= LEAST_PART);
    let named: Vec<usize> = order
        .iter()
        .copied()
        .filter(|&k| along[k].abs() >= NAMED)
        .collect();
    let name = |k: usize| axes[k].unknown.name.as_str();
    let mut words = named
        .first()
        .map_or_else(String::new, |&k| name(k).to_owned());
    for &k in named.iter().skip(1) {
        let link = if along[k] > 0.0 {
            " with "
        } else {
            " against "
        };
        words.extend([link, name(k)]);
    }
    let linear = named
        .iter()
        .all(|&k| axes[k].unknown.scale == Scale::Linear);
    words.push_str(": ");
    words.push_str(&seen_to(deviation, linear));
    Direction {
        sd_decades: deviation,
        parts: order
            .into_iter()
            .map(|k| DirectionPart {
                name: name(k).to_owned(),
                part: along[k],
            })
            .collect(),
        words,
    }
}

/// Describes in words the precision with which the record determines a direction.
fn seen_to(deviation: f64, linear: bool) -> String {
    /// Half width of a 95 % interval in standard deviations.
    const NORMAL: f64 = 1.96;
    let half = NORMAL * deviation;
    if deviation >= BLIND {
        "not determined by this record".to_owned()
    } else if linear {
        format!(
            "determined to {:.2} % of half the search interval",
            100.0 * half
        )
    } else if half < 0.2 {
        format!("determined to {:.2} %", 100.0 * (libm::exp10(half) - 1.0))
    } else {
        format!("determined to a factor of {:.1}", libm::exp10(half))
    }
}
