//! Predictive score: the log ratio of the densities, with and without an effect, of a record that took no
//! part in the fit.
//!
//! At a fit with residual Jacobian `J` and prior precision `L` the unknowns are Gaussian with precision `A =
//! J^T J + L`. A whitened record with residual `z` and Jacobian `J_h` at that point then has the covariance
//! `C_h + J_h A^-1 J_h^T`, and with `b = J_h^T C_h^-1 z`, `K = A + J_h^T C_h^-1 J_h`
//!
//! `ln p = -1/2 (z^T C_h^-1 z - b^T K^-1 b + ln |K| - ln |A| + ln |C_h|)`
//!
//! up to a constant of the record. Directions that the fit does not determine are integrated out, so they do
//! not influence the score. With `dS = ln p(with) - ln p(without)`, `E exp dS = 1` where the effect is
//! absent, so that `P(dS >= T) <= exp(-T)` however many effects were tried on the fitted record (Markov's
//! inequality).
//!
//! Each model has the smooth discrepancy that its fit needs
//! ([`linear::discrepancy`](crate::linear::discrepancy)): the coefficients of the fitted record are further
//! unknowns with unit priors, which held-out cycles share. Another record has a discrepancy of its own with the
//! same variances, `C_h = I + D_h D_h^T`, so that only what a law explains is predicted. Held-out cycles repeat
//! the discrepancy of the fitted ones and say nothing about the law: their score is shown, not required.
//!
//! Without a discrepancy residuals and Jacobians of both models are divided by one scale, the smaller of their
//! dispersions: a model that is wrong by more than the noise predicts no better than that.
use crate::inputs::Inputs;
use crate::laboratory::Laboratory;
use crate::linear::discrepancy::Discrepancy;
use crate::linear::evidence::{deviation, log_determinant, log_mean};
use crate::linear::score::misfit_tail;
use crate::linear::stack::stacked;
use crate::linear::tangent::free;
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::model::parameter::sizes;
use crate::thresholds::Thresholds;
use crate::validation::compare::{DataRole, ValidationRecord};
use crate::validation::scoring_metric::divide_by_student_deviation;
use nalgebra::{DMatrix, DVector};
use record::Record;
use record::metric::Metric;
use record::noise::NoiseSource;
use record::noise::STATED;
use search::least_squares::{Linearized, Variable};
use serde::{Deserialize, Serialize};

/// Predictive score of an answer on one record that took no part in the fit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Prediction {
    /// Index of the record's working condition in the case.
    pub condition: usize,
    /// Kind of held-out data that the record is; never [`DataRole::Fitted`].
    pub part: DataRole,
    /// Score: log ratio of the record's probability densities with and without the answer's effects (nats).
    pub nats: f64,
}

/// Predictive scores of one model relative to another.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Scores {
    /// Predictive score on each record.
    pub(crate) records: Vec<Prediction>,
    /// Predictive score on all records jointly that do not repeat the fitted one (nats); `None` where there is
    /// none.
    pub(crate) together: Option<f64>,
    /// Gain of log evidence on the fitted record, over the dispersion (nats).
    pub(crate) evidence: f64,
    /// Role and condition index of each record for which the model does not run.
    pub(crate) failed: Vec<(DataRole, usize)>,
}

/// Returns whether a record can score a prediction: it took no part in the fit, and its noise is estimated from cycles or
/// stated.
fn can_score(one: &ValidationRecord<'_>) -> bool {
    let known = !matches!(one.scale.known(), NoiseSource::Estimated);
    one.part != DataRole::Fitted && known && one.scale.len() > 0
}

/// Describes the records that could score a prediction and do not, because the model without the effects does not run
/// for them.
pub(crate) fn unscored(
    shown: &[ValidationRecord<'_>],
    scored: &[Prediction],
    inputs: &Inputs,
) -> Vec<String> {
    let is_scored = |one: &ValidationRecord<'_>| {
        let mut all = scored.iter();
        all.any(|own| own.part == one.part && own.condition == one.record.condition)
    };
    let left_out = shown.iter().filter(|one| can_score(one) && !is_scored(one));
    let words = |one: &ValidationRecord<'_>| {
        format!(
            "the model without the added effects does not run for {}: that record does not test them",
            one.part.words(&inputs.condition(one.record.condition))
        )
    };
    left_out.map(words).collect()
}

/// Computes the predictive scores of a model against another on all data that took no part in the fit.
/// Records whose noise is neither estimated from cycles nor stated are skipped, and those for which the other model does
/// not run.
///
/// # Errors
/// Those of the laboratory.
pub(crate) async fn scores<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    shown: &[ValidationRecord<'_>],
    [with, without]: [&Fit; 2],
) -> Result<Scores, L::Error> {
    let models = [with, without];
    let averages = Average::both(&experiments.on.metric, models);
    let mut found = Scores {
        evidence: with.gain_over(without),
        ..Scores::default()
    };
    let mut all = Vec::new();
    for one in shown.iter().filter(|one| can_score(one)) {
        let with_it = linearized(experiments, one, with).await?;
        let without_it = linearized(experiments, one, without).await?;
        let seen = match (with_it, without_it) {
            (Some(with_it), Some(without_it)) => [with_it, without_it],
            (None, _) => {
                found.failed.push((one.part, one.record.condition));
                continue;
            }
            (Some(_), None) => continue,
        };
        let fitted = &experiments.on.record;
        let own = [(one, seen)];
        found.records.push(Prediction {
            condition: one.record.condition,
            part: one.part,
            nats: ratio(&averages, models, &own, fitted),
        });
        if one.part != DataRole::Cycles {
            all.extend(own);
        }
    }
    if !all.is_empty() {
        found.together = Some(ratio(&averages, models, &all, &experiments.on.record));
    }
    Ok(found)
}

/// Records that took no part in the fit, each with what the models with and without the effect predict of it.
type Seen<'a, 'b> = [(&'a ValidationRecord<'b>, [Predicted; 2])];

/// Returns the log ratio of the densities of several records jointly, with and without the effect.
fn ratio(
    averages: &[Average; 2],
    models: [&Fit; 2],
    records: &Seen<'_, '_>,
    fitted: &Record,
) -> f64 {
    let [with, without] = [0, 1].map(|k| {
        averages[k].predicted(|needed| {
            let own = records.iter().map(|(shown, seen)| {
                seen[k].beside_discrepancy((shown, fitted), models[k], needed)
            });
            Predicted::stacked(&own.collect::<Vec<_>>())
        })
    });
    with - without
}

/// Posterior of a model, averaged over discrepancies that a comparison considers, each as likely as any other
/// before the record is seen.
struct Average {
    /// Each discrepancy, with the log evidence of the model under it and the posterior.
    each: Vec<(Option<Discrepancy>, f64, Posterior)>,
}

impl Average {
    /// Builds the averages of a model with an effect and of one without it, over the same discrepancies.
    fn both(metric: &Metric, [with, without]: [&Fit; 2]) -> [Self; 2] {
        let dispersion = with.dispersion().min(without.dispersion());
        let among = with.discrepancies(without);
        [with, without].map(|fit| Self {
            each: among
                .iter()
                .zip(fit.log_evidence_with(&among))
                .map(|(own, evidence)| {
                    let waves = fit.waves_of(own.as_ref());
                    let posterior = Posterior::of(metric, fit, dispersion, &waves);
                    (own.clone(), evidence, posterior)
                })
                .collect(),
        })
    }

    /// Returns the log predictive density (nats), as [`Posterior::predicted`]; `seen` gives what the model
    /// predicts with a discrepancy.
    fn predicted(&self, seen: impl Fn(Option<&Discrepancy>) -> Predicted) -> f64 {
        let evidence: Vec<f64> = self.each.iter().map(|(_, own, _)| *own).collect();
        let joint = self.each.iter().map(|(needed, evidence, posterior)| {
            evidence + posterior.predicted(&seen(needed.as_ref()))
        });
        log_mean(&joint.collect::<Vec<_>>()) - log_mean(&evidence)
    }
}

/// Returns whether noise, and what a fit leaves open of its unknowns, may be all that the fit leaves of a
/// record that took no part in it, at a significance level; for stated noise, whether the residual is no more
/// than the noise may be. `None` where the record cannot be simulated or its noise is not known.
///
/// # Errors
/// Those of the laboratory.
pub(crate) async fn is_explained<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    one: &ValidationRecord<'_>,
    fit: &Fit,
    level: f64,
) -> Result<Option<bool>, L::Error> {
    let known = one.scale.known();
    if known == NoiseSource::Estimated || one.scale.len() == 0 {
        return Ok(None);
    }
    let Some(record) = linearized(experiments, one, fit).await? else {
        return Ok(None);
    };
    let on = experiments.on;
    let without = DMatrix::zeros(fit.entries(), 0);
    let [length, _] = Posterior::of(&on.metric, fit, 1.0, &without).lengths(&record);
    let n = record.residual.len();
    Ok(Some(if known.is_seen() {
        // held-out cycles share the noise of the fitted ones
        let noise = if one.part == DataRole::Cycles {
            &on.record
        } else {
            one.record
        };
        let cycles = noise.cycles.len();
        misfit_tail(length, n, 0.0, n as f64 * (cycles as f64 - 1.0)) >= level
    } else {
        length <= STATED * n as f64
    }))
}

/// What a claim must reach on data that took no part in its fit, or without such data on the fitted record.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Needed {
    /// Nats that all records together must reach; none may score less than the negative of it.
    pub(crate) score: f64,
    /// Nats that the score or the evidence must reach in addition, because held-out data took part in a choice.
    pub(crate) chosen: f64,
    /// Gain of log evidence required where no record but cycles of the fitted condition is held out.
    pub(crate) evidence: f64,
}

impl Needed {
    /// Returns what a claim of `effects` effects out of `tried` candidates needs: the best of many candidates
    /// has `ln(tried)` more evidence by chance, and each of several effects was chosen so.
    pub(crate) fn of(thresholds: &Thresholds, effects: usize, tried: usize) -> Self {
        Self {
            score: thresholds.prediction,
            chosen: 0.0,
            evidence: thresholds.evidence_of_best(tried, effects),
        }
    }
}

/// Returns the reason why the predictive scores do not support the effect `id`; `None` if they do.
pub(crate) fn rejection_reason(
    id: &str,
    scores: &Scores,
    needed: Needed,
    inputs: &Inputs,
) -> Option<String> {
    let words = |part: DataRole, condition: usize| part.words(&inputs.condition(condition));
    if let Some((part, condition)) = scores.failed.first() {
        return Some(format!(
            "the simulation with {id} does not run for {}",
            words(*part, *condition)
        ));
    }
    let mut laws = scores
        .records
        .iter()
        .filter(|one| one.part != DataRole::Cycles);
    let worst = laws.find(|one| one.nats < -needed.score);
    if let Some(worst) = worst {
        return Some(format!(
            "{id} explains the fitted cycles but predicts {} worse: their log likelihood falls by {:.1} nats when it is added",
            words(worst.part, worst.condition),
            -worst.nats
        ));
    }
    let Some(together) = scores.together else {
        let (gained, least) = (scores.evidence, needed.evidence + needed.chosen);
        return (gained.is_nan() || gained < least).then(|| {
            format!(
                "{id} explains the fitted data, but nothing else is held out that tests its law: it gains {gained:.1} nats, \
                 and without another condition, channel or part of the record {least:.1} nats are needed"
            )
        });
    };
    let least = needed.score + needed.chosen;
    // no number is no evidence
    (together.is_nan() || together < least).then(|| {
        format!(
            "{id} explains the fitted cycles but predicts the held-out data no better: the gain in log likelihood there is {together:.1} nats, and {least:.1} nats are needed"
        )
    })
}

/// Returns the changes of a record by the sizes of a fit's generic forces, each times the fitted size: such a
/// force has a form and a joint, and no law that tells its size under another condition.
fn sizes_of_forces(fit: &Fit, jacobian: &DMatrix<f64>) -> DMatrix<f64> {
    let added = fit.model.added.iter().enumerate();
    let places = added
        .filter(|(_, own)| own.generic)
        .flat_map(|(position, own)| {
            let first = fit.model.first_of(position);
            sizes(own).into_iter().map(move |k| first + k)
        });
    let mut columns = DMatrix::zeros(jacobian.nrows(), 0);
    for place in places {
        let change = jacobian.column(place) * fit.x()[place].abs();
        columns = beside(&columns, &DMatrix::from_columns(&[change]));
    }
    columns
}

/// Computes the residual and Jacobian of a record at a fit. Held-out cycles of the fitted condition need no
/// simulation.
async fn linearized<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    shown: &ValidationRecord<'_>,
    fit: &Fit,
) -> Result<Option<Predicted>, L::Error> {
    let scale = &shown.scale;
    if shown.part == DataRole::Cycles {
        return Ok(Some(Predicted::new(
            scale.residual(&fit.curves),
            scale.weigh(fit.search.best().jacobian.clone()),
        )));
    }
    let mut seen = experiments.linearized(fit, shown.record).await?;
    if seen.is_none() {
        // a name hangs on this one: a run that was lost is asked for once more, one that fails will fail again
        seen = experiments.linearized(fit, shown.record).await?;
    }
    let Some(seen) = seen else {
        return Ok(None);
    };
    let residual = scale.residual(&seen.curves);
    let mut jacobian = DMatrix::zeros(residual.len(), fit.x().len());
    for (k, change) in seen.changes.iter().enumerate() {
        if let Some(change) = change {
            jacobian.set_column(k, &-scale.whiten(change));
        }
    }
    let mut seen = Predicted::new(residual, scale.weigh(jacobian));
    if shown.part == DataRole::Condition {
        seen.own = sizes_of_forces(fit, &seen.jacobian);
    }
    Ok(Some(seen))
}

/// Returns the columns of one matrix followed by those of another with as many rows.
fn beside(left: &DMatrix<f64>, right: &DMatrix<f64>) -> DMatrix<f64> {
    let count = left.ncols();
    let mut both = left.clone().resize_horizontally(count + right.ncols(), 0.0);
    both.columns_mut(count, right.ncols()).copy_from(right);
    both
}

/// Whitened residual of a record at a fitted point, and its Jacobian by the fit's unknowns.
#[derive(Clone, Debug)]
pub(crate) struct Predicted {
    pub(crate) residual: DVector<f64>,
    pub(crate) jacobian: DMatrix<f64>,
    /// Changes of the record that it shares with no other, one column per standard deviation.
    pub(crate) own: DMatrix<f64>,
}

impl Predicted {
    /// Creates the prediction of a record that shares all its unknowns with the fitted one.
    pub(crate) fn new(residual: DVector<f64>, jacobian: DMatrix<f64>) -> Self {
        let own = DMatrix::zeros(residual.len(), 0);
        Self {
            residual,
            jacobian,
            own,
        }
    }

    /// Returns what a model predicts of a record with a given discrepancy: held-out cycles share it, any other
    /// record has one of its own with the same variances.
    fn beside_discrepancy(
        &self,
        (shown, fitted): (&ValidationRecord<'_>, &Record),
        model: &Fit,
        needed: Option<&Discrepancy>,
    ) -> Self {
        let waves = model.waves_of(needed);
        let (shared, own) = if shown.part == DataRole::Cycles {
            (shown.scale.weigh(-waves), self.own.clone())
        } else {
            let own = beside(&self.own, &shown.waves(needed, (model, fitted)));
            (DMatrix::zeros(own.nrows(), waves.ncols()), own)
        };
        Self {
            residual: self.residual.clone(),
            jacobian: beside(&self.jacobian, &shared),
            own,
        }
    }

    /// Stacks the residuals and Jacobians of several records into one.
    pub(crate) fn stacked(all: &[Self]) -> Self {
        let rows = all.iter().map(|one| one.residual.len()).sum();
        let columns = all.first().map_or(0, |one| one.jacobian.ncols());
        let waves = all.iter().map(|one| one.own.ncols()).sum();
        let mut stacked = Self {
            residual: DVector::zeros(rows),
            jacobian: DMatrix::zeros(rows, columns),
            own: DMatrix::zeros(rows, waves),
        };
        let (mut at, mut wave) = (0, 0);
        for one in all {
            let (length, waves) = one.own.shape();
            let mut residual = stacked.residual.rows_mut(at, length);
            residual.copy_from(&one.residual);
            let mut jacobian = stacked.jacobian.rows_mut(at, length);
            jacobian.copy_from(&one.jacobian);
            let mut own = stacked.own.view_mut((at, wave), (length, waves));
            own.copy_from(&one.own);
            at += length;
            wave += waves;
        }
        stacked
    }
}

/// Gaussian posterior of a fit's unknowns, and of the coefficients of its discrepancy, with residuals in
/// standard deviations.
struct Posterior {
    variables: Vec<Variable>,
    at: Linearized,
    dispersion: f64,
    /// Step from the fitted point to the mean: zero without a discrepancy, under whose covariance the fitted
    /// point is no minimum.
    step: DVector<f64>,
}

impl Posterior {
    /// Builds the posterior of a model's unknowns from its fit; residuals and Jacobian are divided by the
    /// square root of `dispersion`. `waves` are those of its discrepancy, times their standard deviations.
    pub(crate) fn of(metric: &Metric, fit: &Fit, dispersion: f64, waves: &DMatrix<f64>) -> Self {
        let at = fit.search.best();
        let root = dispersion.sqrt();
        let weigh = |columns: DMatrix<f64>| divide_by_student_deviation(metric, columns / root);
        let residual = weigh(DMatrix::from_columns(std::slice::from_ref(&at.residual)));
        let at = Linearized {
            x: at.x.clone(),
            residual: residual.column(0).into_owned(),
            jacobian: weigh(at.jacobian.clone()),
        };
        Self::new(at, fit.variables(), dispersion, &weigh(-waves))
    }

    /// Builds the posterior of the unknowns of a linear model, and of one more unknown with a unit prior for
    /// each column of `waves`; everything is weighed already.
    fn new(
        mut at: Linearized,
        variables: &[Variable],
        dispersion: f64,
        waves: &DMatrix<f64>,
    ) -> Self {
        let count = waves.ncols();
        at.jacobian = beside(&at.jacobian, waves);
        at.x.resize(at.x.len() + count, 0.0);
        let mut variables = variables.to_vec();
        variables.resize(variables.len() + count, Variable::standard_normal());
        let mut own = Self {
            step: DVector::zeros(variables.len()),
            variables,
            at,
            dispersion,
        };
        if count > 0 {
            own.step = own.step_to_mean();
        }
        own
    }

    /// Returns the step from the fitted point to the mean of the unknowns.
    fn step_to_mean(&self) -> DVector<f64> {
        let mut step = DVector::zeros(self.variables.len());
        let free = free(&self.at, &self.variables);
        let Some(precision) = self.precision(&free).cholesky() else {
            return step;
        };
        let jacobian = self.at.jacobian.select_columns(&free);
        let mut slope = jacobian.tr_mul(&self.at.residual);
        for (own, &k) in slope.iter_mut().zip(&free) {
            let variable = &self.variables[k];
            let deviation = deviation(variable);
            let off = variable
                .prior
                .map_or(0.0, |prior| self.at.x[k] - prior.mean);
            *own += off / (deviation * deviation);
        }
        for (k, own) in free.into_iter().zip(precision.solve(&slope).iter()) {
            let (at, variable) = (self.at.x[k], &self.variables[k]);
            step[k] = (at - own).clamp(variable.lower, variable.upper) - at;
        }
        step
    }

    /// Returns the posterior precision matrix of the unknowns with the indices `of`, all others held.
    fn precision(&self, of: &[usize]) -> DMatrix<f64> {
        let jacobian = self.at.jacobian.select_columns(of);
        let mut precision = jacobian.tr_mul(&jacobian);
        for (i, &k) in of.iter().enumerate() {
            let deviation = deviation(&self.variables[k]);
            precision[(i, i)] += 1.0 / (deviation * deviation);
        }
        precision
    }

    /// Returns the log predictive density of a record (nats), up to a constant of the record and the
    /// dispersion. `NaN` where the precision is not positive definite, that is where the fit leaves an
    /// unknown undetermined.
    fn predicted(&self, record: &Predicted) -> f64 {
        let [length, volume] = self.lengths(record);
        -0.5 * (length + volume)
    }

    /// Returns the squared length of a record's residual under its predictive covariance `C_h + J_h A^-1
    /// J_h^T`, and the logarithm of the determinant of that covariance.
    fn lengths(&self, record: &Predicted) -> [f64; 2] {
        let root = self.dispersion.sqrt();
        let (z, jacobian) = (&record.residual / root, &record.jacobian / root);
        let z = z + &jacobian * &self.step;
        // what lies on a bound is known as well as that; what moves neither record has nothing to say
        let both = Linearized {
            x: self.at.x.clone(),
            residual: DVector::zeros(0),
            jacobian: stacked(&self.at.jacobian, &jacobian),
        };
        let free = free(&both, &self.variables);
        let count = free.len();
        let mut columns = jacobian.select_columns(&free).insert_column(count, 0.0);
        columns.set_column(count, &z);
        let mut products = columns.tr_mul(&columns);
        let mut volume = 0.0;
        if record.own.ncols() > 0 {
            let own = &record.own / root;
            let inner = own.tr_mul(&own) + DMatrix::identity(own.ncols(), own.ncols());
            let Some(factor) = inner.cholesky() else {
                return [f64::NAN; 2];
            };
            volume += log_determinant(&factor);
            let mixed = own.tr_mul(&columns);
            products -= mixed.tr_mul(&factor.solve(&mixed));
        }
        let length = products[(count, count)];
        if free.is_empty() {
            return [length, volume];
        }
        let precision = self.precision(&free);
        let with = &precision + products.view((0, 0), (count, count));
        let b = products.view((0, count), (count, 1)).into_owned();
        let (Some(with), Some(precision)) = (with.cholesky(), precision.cholesky()) else {
            return [f64::NAN; 2];
        };
        let explained = b.dot(&with.solve(&b));
        volume += log_determinant(&with) - log_determinant(&precision);
        [length - explained, volume]
    }
}

#[cfg(test)]
mod tests;
