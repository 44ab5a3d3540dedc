//! The numerical check: how far the discretisation moves the curves, once recalibration has taken
//! what it can.
//!
//! A finer model at the fitted point; the difference, projected off the tangent space, becomes a part of
//! the noise (an adequacy floor), so that no effect is named for what a coarser model does.
use crate::laboratory::{Laboratory, curves};
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::record::measured::{Curves, difference};
use crate::record::metric::Metric;
use crate::record::spectrum::Spectra;
use crate::record::whitened::WhitenedRecord;
use nalgebra::DVector;
use protocol::job::Numerics;

/// What a finer model says.
#[derive(Clone, Debug)]
pub struct Preflight {
    /// Difference of the curves, finer less coarser, by channel.
    pub difference: Curves,
    /// Its root mean square by channel, in the channel's unit.
    pub rms: Vec<f64>,
    /// The same after recalibration has taken its share.
    pub rms_left: Vec<f64>,
    /// Standard error of the record's mean by channel, root mean square over what is compared.
    pub standard_error: Vec<f64>,
    /// Entries of what is left, by channel.
    pub left: Spectra,
    /// Whether the whole finer model completed; else its parts, one at a time, as far as they did.
    pub whole: bool,
}

impl Preflight {
    /// The largest ratio of what is left to the standard error.
    pub fn ratio(&self) -> f64 {
        let each = self.rms_left.iter().zip(&self.standard_error);
        each.map(|(left, error)| left / error).fold(0.0, f64::max)
    }
}

/// Simulates a fitted point more finely; what a fit (that one, or the one before an effect was added,
/// for a size must not hide what it does not explain) can absorb is taken off. If the finer model
/// fails, its parts are refined one at a time, and their differences added: so it is to first order.
/// Nothing if that fails too. A model that has nothing to refine differs from itself by nothing.
///
/// # Errors
/// Those of the laboratory.
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

/// What a finer model changes of a fit's curves on a record, and whether it completed as a whole.
///
/// # Errors
/// Those of the laboratory.
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

/// Curves of a fitted point in finer numerics less those in the usual ones; nothing where one failed.
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
        point.read(record, &mut fine);
        difference(&fine, coarse, 1.0)
    };
    Ok(seen.into_iter().map(|fine| fine.map(less)).collect())
}

/// What a difference of the curves means beside a record, and beside a fit that absorbs a part of it.
fn preflight(on: &WhitenedRecord, absorbing: &Fit, difference: Curves, whole: bool) -> Preflight {
    let metric = &on.metric;
    let left = metric.colour(&left(metric, absorbing, &difference));
    Preflight {
        rms: metric.rms(&metric.entries(&difference)),
        rms_left: metric.rms(&left),
        standard_error: metric.standard_error(),
        difference,
        left,
        whole,
    }
}

/// What is left of a change of the curves, in a metric, once what a fit can absorb is taken off.
pub(crate) fn left(metric: &Metric, fit: &Fit, difference: &Curves) -> DVector<f64> {
    fit.tangent().project(&metric.whiten(difference))
}
