//! Refits of single parameters on sectors of the abscissa and under other conditions.
use crate::laboratory::Laboratory;
use crate::localisation::parameter_drift::linear_record::LinearizedRecord;
use crate::localisation::parameter_drift::shifts::{ParameterDrift, parameter_variations};
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use record::{Curves, Record, difference};
use search::least_squares::Variable;

/// Estimates by how much each unknown of a fit would have to vary between parts of the data; unknowns of the
/// case come first. Each condition takes one simulation per unknown where the laboratory provides no
/// derivatives.
pub(crate) async fn drifts<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    fit: &Fit,
    others: impl Iterator<Item = &Record>,
) -> Result<Vec<ParameterDrift>, L::Error> {
    let on = experiments.on;
    let Some(own) = sheet(experiments, fit, &on.record).await? else {
        return Ok(Vec::new());
    };
    let mut elsewhere = Vec::new();
    for record in others {
        elsewhere.extend(sheet(experiments, fit, record).await?);
    }
    let prior = |v: &Variable| v.prior.map_or(1e3, |p| p.deviation);
    let deviations: Vec<f64> = fit.variables().iter().map(prior).collect();
    Ok(parameter_variations(&own, &deviations, &elsewhere))
}

/// Linearises a record at the fitted point; `None` where the record has too few cycles or the point cannot be
/// simulated.
async fn sheet<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    fit: &Fit,
    record: &Record,
) -> Result<Option<LinearizedRecord>, L::Error> {
    if !LinearizedRecord::suits(record) {
        return Ok(None);
    }
    let Some(seen) = experiments.linearized(fit, record).await? else {
        return Ok(None);
    };
    let fitted = &seen.curves;
    // a point that fails tells nothing of its unknown
    let still = || difference(fitted, fitted, 1.0);
    let changes = seen.changes.into_iter();
    let changes: Vec<Curves> = changes.map(|change| change.unwrap_or_else(still)).collect();
    Ok(Some(LinearizedRecord::new(record, fitted, &changes)))
}
