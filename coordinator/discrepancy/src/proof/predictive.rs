//! The predictive score: how much likelier a record that took no part in a fit is with an effect than without it.
//!
//! At a fit with residual Jacobian `J` and prior precision `L` the unknowns are Gaussian with precision
//! `A = J^T J + L`. A whitened record with residual `z` and Jacobian `J_h` at that point then has the covariance
//! `I + J_h A^-1 J_h^T`, and with `b = J_h^T z`, `K = A + J_h^T J_h`
//!
//! `ln p = -1/2 (z^T z - b^T K^-1 b + ln |K| - ln |A|)`
//!
//! up to a constant of the record. What the fit leaves open is integrated out, so directions that the fitted record
//! does not see decide nothing. With `dS = ln p(with) - ln p(without)`, `E exp dS = 1` where the effect is not there,
//! so that `P(dS >= T) <= exp(-T)` however many effects were tried on the fitted record (Markov's inequality).
//!
//! Residuals and Jacobians of both models are divided by one scale, the smaller of their misfits: a model that is
//! wrong by more than the noise predicts no better than that. Entries whose noise was estimated from few cycles are
//! wider than Gaussian, which widens the scale once more.
use crate::laboratory::Laboratory;
use crate::linear::evidence::{deviation, log_determinant};
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::proof::compare::{Portion, Shown};
use nalgebra::{DMatrix, DVector};
use search::least_squares::{Linearized, Variable};

/// Largest factor by which noise variances from few cycles widen the scale.
const WIDEST: f64 = 1.5;

/// How much likelier one record that took no part in the fit is with an answer than without it.
#[derive(Clone, Debug, PartialEq)]
pub struct Prediction {
    /// Index of the condition.
    pub condition: usize,
    /// What of the records it is; never [`Portion::Fitted`].
    pub part: Portion,
    /// The predictive score (nats).
    pub nats: f64,
}

/// Predictive scores of a model against another one.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Scores {
    /// Record by record.
    pub(crate) records: Vec<Prediction>,
    /// Of all of them as one record; none where there is none.
    pub(crate) together: Option<f64>,
}

/// Scores a model on everything that took no part in the fit, against one without some of its effects; `freedom` is
/// that of a variance of the noise. Records on which one of them fails are left out.
///
/// # Errors
/// Those of the laboratory.
pub(crate) async fn scores<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    shown: &[Shown<'_>],
    [with, without]: [&Fit; 2],
    freedom: f64,
) -> Result<Scores, L::Error> {
    let scale = scale([with, without], freedom);
    let mut found = Scores::default();
    let mut all = [Vec::new(), Vec::new()];
    for one in shown.iter().filter(|one| one.part != Portion::Fitted) {
        let with_it = predicted(experiments, one, with).await?;
        let without_it = predicted(experiments, one, without).await?;
        let (Some(with_it), Some(without_it)) = (with_it, without_it) else {
            continue;
        };
        let nats =
            log_predictive(with, &with_it, scale) - log_predictive(without, &without_it, scale);
        found.records.push(Prediction {
            condition: one.record.condition,
            part: one.part,
            nats,
        });
        all[0].push(with_it);
        all[1].push(without_it);
    }
    if !found.records.is_empty() {
        let [with_it, without_it] = all.map(|own| Predicted::stacked(&own));
        found.together = Some(
            log_predictive(with, &with_it, scale) - log_predictive(without, &without_it, scale),
        );
    }
    Ok(found)
}

/// A record as a fit predicts it. Held-out cycles of the fitted condition need no simulation.
async fn predicted<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    shown: &Shown<'_>,
    fit: &Fit,
) -> Result<Option<Predicted>, L::Error> {
    let scale = &shown.scale;
    if shown.part == Portion::Cycles {
        return Ok(Some(Predicted {
            residual: scale.left(&fit.curves),
            jacobian: scale.weigh(fit.search.best().jacobian.clone()),
        }));
    }
    let Some(seen) = experiments.linearized(fit, shown.record).await? else {
        return Ok(None);
    };
    let residual = scale.left(&seen.curves);
    let mut jacobian = DMatrix::zeros(residual.len(), fit.x().len());
    for (k, change) in seen.changes.iter().enumerate() {
        if let Some(change) = change {
            jacobian.set_column(k, &-scale.whiten(change));
        }
    }
    let jacobian = scale.weigh(jacobian);
    Ok(Some(Predicted { residual, jacobian }))
}

/// A whitened record at a fitted point: residual, and its Jacobian by the fit's unknowns.
#[derive(Clone, Debug)]
pub(crate) struct Predicted {
    pub(crate) residual: DVector<f64>,
    pub(crate) jacobian: DMatrix<f64>,
}

impl Predicted {
    /// Several records as one.
    pub(crate) fn stacked(all: &[Self]) -> Self {
        let rows = all.iter().map(|one| one.residual.len()).sum();
        let columns = all.first().map_or(0, |one| one.jacobian.ncols());
        let mut stacked = Self {
            residual: DVector::zeros(rows),
            jacobian: DMatrix::zeros(rows, columns),
        };
        let mut at = 0;
        for one in all {
            let length = one.residual.len();
            stacked
                .residual
                .rows_mut(at, length)
                .copy_from(&one.residual);
            stacked
                .jacobian
                .rows_mut(at, length)
                .copy_from(&one.jacobian);
            at += length;
        }
        stacked
    }
}

/// The variance that both models' residuals are taken to have, in units of the noise's; `freedom` is that of a
/// variance of the noise.
pub(crate) fn scale(models: [&Fit; 2], freedom: f64) -> f64 {
    let per_freedom = |fit: &Fit| {
        let left = fit.entries().saturating_sub(fit.x().len()).max(1);
        fit.chi_squared() / left as f64
    };
    let [a, b] = models.map(per_freedom);
    let few = if freedom > 2.0 {
        (freedom / (freedom - 2.0)).min(WIDEST)
    } else {
        WIDEST
    };
    a.min(b).max(1.0) * few
}

/// The log density of a record after a fit (nats), up to a constant of the record; `scale` is the variance of a
/// residual. No number where the fit leaves an unknown open altogether.
pub(crate) fn log_predictive(fit: &Fit, record: &Predicted, scale: f64) -> f64 {
    predictive((fit.search.best(), fit.variables()), record, scale)
}

fn predictive((at, variables): (&Linearized, &[Variable]), record: &Predicted, scale: f64) -> f64 {
    // what lies on a bound, or moves nothing, is known as well as its bound
    let free: Vec<usize> = (0..variables.len())
        .filter(|&k| {
            let (x, v) = (at.x[k], &variables[k]);
            let moves = [&at.jacobian, &record.jacobian];
            let moves = moves.iter().any(|j| j.column(k).norm_squared() > 0.0);
            moves && x > v.lower && x < v.upper
        })
        .collect();
    let fitted = at.jacobian.select_columns(&free);
    let predicted = record.jacobian.select_columns(&free);
    let mut precision = fitted.tr_mul(&fitted) / scale;
    for (i, &k) in free.iter().enumerate() {
        let deviation = deviation(&variables[k]);
        precision[(i, i)] += 1.0 / (deviation * deviation);
    }
    let with = &precision + predicted.tr_mul(&predicted) / scale;
    let b = predicted.tr_mul(&record.residual) / scale;
    let square = record.residual.norm_squared() / scale;
    if free.is_empty() {
        return -0.5 * square;
    }
    let (Some(with), Some(precision)) = (with.cholesky(), precision.cholesky()) else {
        return f64::NAN;
    };
    let explained = b.dot(&with.solve(&b));
    -0.5 * (square - explained + log_determinant(&with) - log_determinant(&precision))
}

#[cfg(test)]
mod tests {
    use super::*;
    use search::least_squares::Prior;

    fn variable(deviation: f64, bounds: [f64; 2]) -> Variable {
        Variable {
            start: 0.0,
            lower: bounds[0],
            upper: bounds[1],
            step: 0.1,
            longest: f64::INFINITY,
            prior: Some(Prior {
                mean: 0.0,
                deviation,
            }),
        }
    }

    fn table(rows: usize, columns: usize, of: u64) -> DMatrix<f64> {
        let streams = search::random::Streams::new(of, 0);
        let mut stream = streams.at(0, search::random::Phase::Initial, 0);
        DMatrix::from_fn(rows, columns, |_, _| stream.normal())
    }

    /// The formula is the dense Gaussian's, less its constant.
    #[test]
    fn the_score_is_that_of_the_dense_gaussian() {
        let (fitted, predicted) = (table(12, 3, 1), table(7, 3, 2));
        let z = DVector::from_iterator(7, table(7, 1, 3).iter().copied());
        let deviations = [0.7, 2.0, 1.3];
        let variables = deviations.map(|own| variable(own, [-9.0, 9.0]));
        let at = Linearized {
            x: vec![0.1, -0.2, 0.3],
            residual: DVector::zeros(12),
            jacobian: fitted.clone(),
        };
        for scale in [1.0, 2.5] {
            let record = Predicted {
                residual: z.clone(),
                jacobian: predicted.clone(),
            };
            let priors = DVector::from_fn(3, |k, _| 1.0 / (deviations[k] * deviations[k]));
            let precision = fitted.tr_mul(&fitted) / scale + DMatrix::from_diagonal(&priors);
            let covariance = DMatrix::identity(7, 7) * scale
                + &predicted * precision.try_inverse().unwrap() * predicted.transpose();
            let solved = covariance.clone().lu().solve(&z).unwrap();
            let dense = -0.5 * (z.dot(&solved) + libm::log(covariance.determinant()));
            // both models have the constant -n/2 ln s^2 in common
            let constant = -0.5 * 7.0 * libm::log(scale);
            let own = predictive((&at, &variables), &record, scale) + constant;
            assert!((own - dense).abs() < 1e-10, "{own} {dense}");
        }
    }

    /// An unknown on its bound is not integrated out.
    #[test]
    fn what_stands_on_a_bound_is_known() {
        let at = Linearized {
            x: vec![9.0],
            residual: DVector::zeros(4),
            jacobian: table(4, 1, 5),
        };
        let record = Predicted {
            residual: DVector::from_element(3, 1.0),
            jacobian: table(3, 1, 6),
        };
        let own = predictive((&at, &[variable(1.0, [-9.0, 9.0])]), &record, 1.0);
        assert!((own + 1.5).abs() < 1e-12, "{own}");
    }

    /// Where nothing is there, a flexible model that was fitted to noise is rarely preferred by as much as a name needs.
    #[test]
    fn noise_is_predicted_no_better_by_what_was_fitted_to_it() {
        let streams = search::random::Streams::new(9, 0);
        let (mut claims, sets) = (0, 400);
        for draw in 0..sets {
            let mut stream = streams.at(0, search::random::Phase::Initial, draw);
            let mut noise = |n: usize| DVector::from_fn(n, |_, _| stream.normal());
            let (y, held) = (noise(40), noise(40));
            // the best of twenty candidates on the fitted record
            let best = (0..20)
                .map(|k| table(80, 1, 100 + k))
                .map(|g| {
                    let own = g.rows(0, 40).column(0).into_owned();
                    let size = own.dot(&y) / (own.norm_squared() + 0.25);
                    (own.dot(&y) * size, g, size)
                })
                .max_by(|a, b| a.0.total_cmp(&b.0))
                .unwrap();
            let (_, g, size) = best;
            let at = Linearized {
                x: vec![size],
                residual: DVector::zeros(40),
                jacobian: -g.rows(0, 40).into_owned(),
            };
            let record = Predicted {
                residual: &held - g.rows(40, 40).column(0) * size,
                jacobian: -g.rows(40, 40).into_owned(),
            };
            let with = predictive((&at, &[variable(2.0, [-9.0, 9.0])]), &record, 1.0);
            let needed = crate::thresholds::Thresholds::default().prediction;
            claims += u32::from(with + 0.5 * held.norm_squared() >= needed);
        }
        assert!(claims <= 20, "{claims} of {sets}");
    }
}
