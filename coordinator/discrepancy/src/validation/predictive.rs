//! Predictive score: the log ratio of the densities, with and without an effect, of a record that took no
//! part in the fit.
//!
//! At a fit with residual Jacobian `J` and prior precision `L` the unknowns are Gaussian with precision `A =
//! J^T J + L`. A whitened record with residual `z` and Jacobian `J_h` at that point then has the covariance
//! `I + J_h A^-1 J_h^T`, and with `b = J_h^T z`, `K = A + J_h^T J_h`
//!
//! `ln p = -1/2 (z^T z - b^T K^-1 b + ln |K| - ln |A|)`
//!
//! up to a constant of the record. Directions that the fit does not determine are integrated out, so they do
//! not influence the score. With `dS = ln p(with) - ln p(without)`, `E exp dS = 1` where the effect is
//! absent, so that `P(dS >= T) <= exp(-T)` however many effects were tried on the fitted record (Markov's
//! inequality).
//!
//! Residuals and Jacobians of both models are divided by one scale, the smaller of their dispersions: a model
//! that is wrong by more than the noise predicts no better than that.
//!
//! Where nothing is held out, blocks of the fitted record are left out one after the other, which takes no
//! simulation: with `b = J_B^T r_B` and `M = A - J_B^T J_B`
//!
//! `ln p = -1/2 (r_B^T r_B + b^T M^-1 b + ln |A| - ln |M|)`
//!
//! The same data selected the effect, so Markov's bound is multiplied by the number of effects that were
//! tried.
use crate::inputs::Inputs;
use crate::laboratory::Laboratory;
use crate::linear::evidence::{deviation, log_determinant};
use crate::linear::score::misfit_tail;
use crate::linear::stack::stacked;
use crate::linear::tangent::free;
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::record::measured::difference;
use crate::record::metric::Metric;
use crate::record::noise::NoiseSource;
use crate::record::whitened::WhitenedRecord;
use crate::thresholds::{STATED, Thresholds};
use crate::validation::compare::{DataRole, ValidationRecord};
use crate::validation::scoring_metric::divide_by_student_deviation;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use search::least_squares::{Linearized, Variable};

/// Predictive score of an answer on one record that took no part in the fit.
#[derive(Clone, Debug, PartialEq)]
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
    /// Predictive score on all records jointly (nats); `None` where there is no record.
    pub(crate) together: Option<f64>,
    /// Role and condition index of each record on which the model fails although the other model does not.
    pub(crate) failed: Vec<(DataRole, usize)>,
}

impl Scores {
    /// Returns the joint score (nats) that an answer of `effects` effects out of `tried` candidates must
    /// reach.
    pub(crate) fn needed(&self, thresholds: &Thresholds, effects: usize, tried: usize) -> f64 {
        let left_out = self.records.iter().any(|one| one.part == DataRole::LeftOut);
        let searched = libm::log(tried.max(1) as f64) * effects as f64;
        thresholds.prediction + if left_out { searched } else { 0.0 }
    }
}

/// Computes the predictive scores of a model against another on all data that took no part in the fit.
/// Records whose noise is neither estimated from cycles nor stated are skipped; where no record is held out,
/// blocks of the fitted record are left out in turn.
///
/// # Errors
/// Those of the laboratory.
pub(crate) async fn scores<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    shown: &[ValidationRecord<'_>],
    [with, without]: [&Fit; 2],
) -> Result<Scores, L::Error> {
    let on = experiments.on;
    let dispersion = with.dispersion().min(without.dispersion());
    let posteriors = [with, without].map(|fit| Posterior::of(&on.metric, fit, dispersion));
    let mut found = Scores::default();
    let mut all = [Vec::new(), Vec::new()];
    let known = |one: &&ValidationRecord<'_>| !matches!(one.scale.known(), NoiseSource::Estimated);
    let held_out = shown.iter().filter(|one| one.part != DataRole::Fitted);
    let some = |one: &&ValidationRecord<'_>| known(one) && one.scale.len() > 0;
    for one in held_out.filter(some) {
        let with_it = predicted(experiments, one, with).await?;
        let without_it = predicted(experiments, one, without).await?;
        let (with_it, without_it) = match (with_it, without_it) {
            (Some(with_it), Some(without_it)) => (with_it, without_it),
            (None, Some(_)) => {
                found.failed.push((one.part, one.record.condition));
                continue;
            }
            (_, None) => continue,
        };
        found.records.push(Prediction {
            condition: one.record.condition,
            part: one.part,
            nats: posteriors[0].predicted(&with_it) - posteriors[1].predicted(&without_it),
        });
        all[0].push(with_it);
        all[1].push(without_it);
    }
    if found.records.is_empty() {
        let each = [(&posteriors[0], with), (&posteriors[1], without)];
        // the same blocks for both: as long as what the model that leaves less asks for
        let left = |own: &&Posterior<'_>| own.at.residual.norm_squared();
        let closer = posteriors.iter().min_by(|a, b| left(a).total_cmp(&left(b)));
        let blocks = closer.map_or_else(Vec::new, |own| on.metric.blocks(&own.at.residual));
        let [with_it, without_it] = each.map(|(own, fit)| own.left_out((on, fit), &blocks));
        if let (Some(with_it), Some(without_it)) = (with_it, without_it) {
            let nats = with_it - without_it;
            found.records.push(Prediction {
                condition: on.record.condition,
                part: DataRole::LeftOut,
                nats,
            });
            found.together = Some(nats);
        }
    } else {
        let [with_it, without_it] = all.map(|own| Predicted::stacked(&own));
        found.together =
            Some(posteriors[0].predicted(&with_it) - posteriors[1].predicted(&without_it));
    }
    Ok(found)
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
    let Some(record) = predicted(experiments, one, fit).await? else {
        return Ok(None);
    };
    let on = experiments.on;
    let [length, _] = Posterior::of(&on.metric, fit, 1.0).lengths(&record);
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

/// Returns the reason why the predictive scores do not support the effect `id`; `None` if they do: no record
/// scores below `-alone`, and the joint score reaches `needed`.
pub(crate) fn rejection_reason(
    id: &str,
    scores: &Scores,
    [alone, needed]: [f64; 2],
    inputs: &Inputs,
) -> Option<String> {
    let words = |part: DataRole, condition: usize| part.words(&inputs.condition(condition));
    if let Some((part, condition)) = scores.failed.first() {
        return Some(format!(
            "the simulation with {id} does not run for {}",
            words(*part, *condition)
        ));
    }
    let worst = scores.records.iter().find(|one| one.nats < -alone);
    if let Some(worst) = worst {
        return Some(format!(
            "{id} explains the fitted cycles but predicts {} worse: their log likelihood falls by {:.1} nats when it is added",
            words(worst.part, worst.condition),
            -worst.nats
        ));
    }
    let Some(together) = scores.together else {
        return Some(format!(
            "{id} explains the fitted data, but there is nothing that it could predict: the case holds no data out and the record is too short to leave out a part of it; hold out a condition, channel or cycles"
        ));
    };
    // no number is no evidence
    (together.is_nan() || together < needed).then(|| {
        format!(
            "{id} explains the fitted cycles but predicts the held-out data no better: the gain in log likelihood there is {together:.1} nats, and {needed:.1} nats are needed"
        )
    })
}

/// Computes the residual and Jacobian of a record at a fit. Held-out cycles of the fitted condition need no
/// simulation.
async fn predicted<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    shown: &ValidationRecord<'_>,
    fit: &Fit,
) -> Result<Option<Predicted>, L::Error> {
    let scale = &shown.scale;
    if shown.part == DataRole::Cycles {
        return Ok(Some(Predicted {
            residual: scale.residual(&fit.curves),
            jacobian: scale.weigh(fit.search.best().jacobian.clone()),
        }));
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
    let jacobian = scale.weigh(jacobian);
    Ok(Some(Predicted { residual, jacobian }))
}

/// Whitened residual of a record at a fitted point, and its Jacobian by the fit's unknowns.
#[derive(Clone, Debug)]
pub(crate) struct Predicted {
    pub(crate) residual: DVector<f64>,
    pub(crate) jacobian: DMatrix<f64>,
}

impl Predicted {
    /// Stacks the residuals and Jacobians of several records into one.
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

/// Gaussian posterior of a fit's unknowns, with residuals in standard deviations.
struct Posterior<'a> {
    variables: &'a [Variable],
    at: Linearized,
    dispersion: f64,
}

impl<'a> Posterior<'a> {
    /// Builds the posterior of a model's unknowns from its fit; residuals and Jacobian are divided by the
    /// square root of `dispersion`.
    fn of(metric: &Metric, fit: &'a Fit, dispersion: f64) -> Self {
        let at = fit.search.best();
        let root = dispersion.sqrt();
        let residual = divide_by_student_deviation(
            metric,
            DMatrix::from_columns(&[at.residual.clone() / root]),
        );
        Self {
            variables: fit.variables(),
            at: Linearized {
                x: at.x.clone(),
                residual: residual.column(0).into_owned(),
                jacobian: divide_by_student_deviation(metric, at.jacobian.clone() / root),
            },
            dispersion,
        }
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

    /// Returns the squared length of a record's residual under its predictive covariance `I + J_h A^-1
    /// J_h^T`, and the logarithm of the determinant of that covariance.
    fn lengths(&self, record: &Predicted) -> [f64; 2] {
        let root = self.dispersion.sqrt();
        let (z, jacobian) = (&record.residual / root, &record.jacobian / root);
        // what lies on a bound is known as well as that; what moves neither record has nothing to say
        let both = Linearized {
            x: self.at.x.clone(),
            residual: DVector::zeros(0),
            jacobian: stacked(&self.at.jacobian, &jacobian),
        };
        let free = free(&both, self.variables);
        if free.is_empty() {
            return [z.norm_squared(), 0.0];
        }
        let precision = self.precision(&free);
        let jacobian = jacobian.select_columns(&free);
        let with = &precision + jacobian.tr_mul(&jacobian);
        let b = jacobian.tr_mul(&z);
        let (Some(with), Some(precision)) = (with.cholesky(), precision.cholesky()) else {
            return [f64::NAN; 2];
        };
        let explained = b.dot(&with.solve(&b));
        let volume = log_determinant(&with) - log_determinant(&precision);
        [z.norm_squared() - explained, volume]
    }

    /// Returns the sum of the log densities of blocks of the fitted record, each left out of the fit: its
    /// cycles where there are several, else the given parts. `None` where there are fewer than two blocks.
    fn left_out(&self, (on, fit): (&WhitenedRecord, &Fit), blocks: &[Vec<usize>]) -> Option<f64> {
        let blocks: Vec<Predicted> = if on.record.cycles.len() > 1 {
            self.cycles(on, fit)
        } else {
            let rows = |rows: &Vec<usize>| Predicted {
                residual: self.at.residual.select_rows(rows),
                jacobian: self.at.jacobian.select_rows(rows),
            };
            blocks.iter().map(rows).collect()
        };
        (blocks.len() > 1).then(|| self.blocks_left_out(&blocks))
    }

    /// Returns the sum of the log densities of blocks of the fitted record, each given the rest of the
    /// record.
    fn blocks_left_out(&self, blocks: &[Predicted]) -> f64 {
        let free = free(&self.at, self.variables);
        let precision = self.precision(&free);
        let whole = precision
            .clone()
            .cholesky()
            .map(|own| log_determinant(&own));
        let block = |block: &Predicted| {
            let square = block.residual.norm_squared();
            if free.is_empty() {
                return -0.5 * square;
            }
            let jacobian = block.jacobian.select_columns(&free);
            let rest: Option<Cholesky<f64, Dyn>> =
                (&precision - jacobian.tr_mul(&jacobian)).cholesky();
            let (Some(whole), Some(rest)) = (whole, rest) else {
                return f64::NAN;
            };
            let b = jacobian.tr_mul(&block.residual);
            let volume = whole - log_determinant(&rest);
            -0.5 * (square + b.dot(&rest.solve(&b)) + volume)
        };
        blocks.iter().map(block).sum()
    }

    /// Returns each cycle of the fitted record as a block; residual and Jacobian are divided by `sqrt(n)`, so
    /// that all `n` cycles together weigh as much as their mean.
    fn cycles(&self, on: &WhitenedRecord, fit: &Fit) -> Vec<Predicted> {
        let share = (on.record.cycles.len() as f64).sqrt();
        let cycles = on.record.cycles.iter();
        let residual = |cycle| {
            let left = on.metric.whiten(&difference(cycle, &fit.curves, 1.0));
            let left = DMatrix::from_columns(&[left / (share * self.dispersion.sqrt())]);
            divide_by_student_deviation(&on.metric, left)
                .column(0)
                .into_owned()
        };
        cycles
            .map(|cycle| Predicted {
                residual: residual(cycle),
                jacobian: &self.at.jacobian / share,
            })
            .collect()
    }
}

#[cfg(test)]
mod tests;
