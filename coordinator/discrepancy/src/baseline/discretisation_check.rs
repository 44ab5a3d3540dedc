//! Numerical check of a model: the change of its curves by a finer discretisation that recalibration cannot
//! absorb.
//!
//! A finer model is simulated at the fitted point; the difference, projected off the tangent space, becomes a
//! part of the noise (an adequacy floor), so that no effect is named for an error of the coarser
//! discretisation.
use crate::laboratory::{Laboratory, curves};
use crate::linear::whitened::WhitenedRecord;
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use nalgebra::DVector;
use protocol::job::Numerics;
use record::metric::Metric;
use record::spectrum::Spectra;
use record::{Curves, difference};
use serde::{Deserialize, Serialize};

/// Difference between the curves of a model and those of a finer discretisation of it.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Preflight {
    /// Difference of the curves, finer less coarser, by channel.
    pub difference: Curves,
    /// Root mean square of the difference by channel, in the channel's unit.
    pub rms: Vec<f64>,
    /// Root mean square of the part of the difference that recalibration cannot absorb, by channel, in the
    /// channel's unit.
    pub rms_left: Vec<f64>,
    /// Standard error of the record's mean by channel, as root mean square over the compared values.
    pub standard_error: Vec<f64>,
    /// Spectral coefficients, by channel, of the part of the difference that recalibration cannot absorb.
    pub left: Spectra,
    /// Whether the simulation with all refinements completed; otherwise the difference is the sum over the
    /// single refinements that completed.
    pub whole: bool,
}

impl Preflight {
    /// Returns the largest ratio, over the channels, of the difference that recalibration cannot absorb to
    /// the record's standard error.
    pub fn ratio(&self) -> f64 {
        let each = self.rms_left.iter().zip(&self.standard_error);
        each.map(|(left, error)| left / error).fold(0.0, f64::max)
    }

    /// Returns whether the difference is so large that sizes may be wrong by it: more than a third of a standard
    /// error.
    pub fn is_rough(&self) -> bool {
        self.ratio() > 1.0 / 3.0
    }
}

/// Simulates a fitted point with finer numerics and subtracts the part of the difference that the fit
/// `absorbing` can absorb: `fit` itself, or the fit before an effect was added, because the size of an effect
/// must not hide numerical error. If the finer model fails, its parts are refined one at a time and their
/// differences are added, which is correct to first order; returns `None` if that fails too. A model with
/// nothing to refine has the difference zero.
///
/// # Errors
/// Returns an error if no worker is left to simulate, or the user stops the run.
pub async fn check<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    fit: &Fit,
    absorbing: &Fit,
    finer: &[Numerics],
) -> Result<Option<Preflight>, L::Error> {
    let on = experiments.on;
    let changed = changed(experiments, (fit, &fit.curves), finer).await?;
    Ok(changed.map(|(difference, whole)| preflight(on, absorbing, difference, whole)))
}

/// Returns the change of a fit's curves by a finer model on a record, and whether the finer model completed
/// as a whole.
///
/// # Errors
/// Returns an error if no worker is left to simulate, or the user stops the run.
pub(crate) async fn changed<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    (fit, curves): (&Fit, &Curves),
    finer: &[Numerics],
) -> Result<Option<(Curves, bool)>, L::Error> {
    if finer.is_empty() {
        return Ok(Some((difference(curves, curves, 1.0), true)));
    }
    let (finest, parts) = finer.split_at(finer.len().min(1));
    let whole = differences(experiments, (fit, curves), finest).await?;
    if let Some(difference) = whole.into_iter().flatten().next() {
        return Ok(Some((difference, true)));
    }
    let parts = differences(experiments, (fit, curves), parts).await?;
    let sum = parts.into_iter().flatten().reduce(|mut sum, part| {
        for (sum, part) in sum.iter_mut().flatten().zip(part.iter().flatten()) {
            *sum += part;
        }
        sum
    });
    Ok(sum.map(|difference| (difference, false)))
}

/// Returns the curves at a fitted point under each finer discretisation minus those under the usual one;
/// `None` where a simulation failed.
async fn differences<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    (fit, coarse): (&Fit, &Curves),
    finer: &[Numerics],
) -> Result<Vec<Option<Curves>>, L::Error> {
    let record = &experiments.on.record;
    let point = fit.point();
    let experiment = |numerics: &Numerics| point.experiment(record.condition, numerics);
    let batch = finer.iter().map(experiment).collect();
    let seen = curves(experiments.lab, experiments.stage, record, batch).await?;
    let less = |mut fine: Curves| {
        point.apply_gains(record, &mut fine);
        difference(&fine, coarse, 1.0)
    };
    Ok(seen.into_iter().map(|fine| fine.map(less)).collect())
}

/// Evaluates the difference of the curves to a finer discretisation, relative to a record and to a fit that
/// absorbs a part of it.
fn preflight(on: &WhitenedRecord, absorbing: &Fit, difference: Curves, whole: bool) -> Preflight {
    let metric = &on.metric;
    let left = metric.unwhiten(&left(metric, absorbing, &difference));
    Preflight {
        rms: metric.rms(&metric.entries(&difference)),
        rms_left: metric.rms(&left),
        standard_error: metric.standard_error(),
        difference,
        left,
        whole,
    }
}

/// Returns the part of a change of the curves, whitened, that the parameters of a fit cannot absorb.
pub(crate) fn left(metric: &Metric, fit: &Fit, difference: &Curves) -> DVector<f64> {
    fit.tangent().project(&metric.whiten(difference))
}
