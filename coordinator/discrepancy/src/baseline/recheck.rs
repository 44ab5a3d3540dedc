//! Comparison of a model about to be accepted with a finer one: an effect must still be significant when the
//! change by the finer model counts as noise.
use crate::baseline::discretisation_check::{Preflight, check, left};
use crate::baseline::session::Session;
use crate::laboratory::{Laboratory, Stage};
use crate::linear::tangent::Tangent;
use crate::model::fit::Fit;
use nalgebra::{DMatrix, DVector};
use record::metric::Metric;
use search::least_squares::{Linearized, Variable};

/// Comparison of a model about to be accepted with a finer discretisation of it.
#[derive(Clone, Debug)]
pub(crate) struct Checked {
    /// Change of the curves of the new model by the finer discretisation.
    pub(crate) preflight: Preflight,
    /// Gain of log evidence over the previous model, divided by the dispersion (nats), with the change by the
    /// finer model counted as noise.
    pub(crate) gain: f64,
}

/// Checks a model about to be accepted against a finer one, relative to the previous model. Returns `None` if
/// no finer model completes.
pub(crate) async fn check_against_finer<L: Laboratory>(
    session: &mut Session<'_, L>,
    before: &Fit,
    after: &Fit,
) -> Result<Option<Checked>, L::Error> {
    let (base, finer) = (session.base, &session.inputs.finer);
    if !session.lab.has_budget(Stage::Preflight) {
        return Ok(None);
    }
    let mut experiments = session.experiments(Stage::Preflight);
    let Some(mut preflight) = check(&mut experiments, after, before, finer).await? else {
        return Ok(None);
    };
    if let Some(first) = &base.preflight {
        // the metric holds the first check's error since; the ratio is to the record's own
        preflight.standard_error.clone_from(&first.standard_error);
    }
    let metric = &base.record.metric;
    let error = metric.whiten(&preflight.difference);
    let nothing = DVector::zeros(error.len());
    let known = base.preflight.as_ref().map_or_else(
        || nothing.clone(),
        |first| left(metric, &base.fit, &first.difference),
    );
    let weights = floor(metric, &left(metric, before, &preflight.difference), &known);
    let [null, own] = [before, after].map(|fit| cost(fit, &weights, &error));
    let ones = DVector::from_element(error.len(), 1.0);
    let [usual_null, usual_own] = [before, after].map(|fit| cost(fit, &ones, &nothing));
    // the finer model's change is one more unknown
    let dispersion = (own / (after.freedom() - 1.0).max(1.0)).max(1.0);
    let among = after.discrepancies(before);
    let nats = after.log_evidence_among(&among) - before.log_evidence_among(&among);
    let gain = nats - 0.5 * (usual_null - usual_own) + 0.5 * (null - own);
    Ok(Some(Checked {
        preflight,
        gain: gain / dispersion,
    }))
}

/// Returns the weight of each entry of the residual when a numerical error counts as additional noise, as far
/// as its power exceeds that of the error already included in the metric.
fn floor(metric: &Metric, error: &DVector<f64>, known: &DVector<f64>) -> DVector<f64> {
    let weight = |own: f64, known: f64| 1.0 / (1.0 + (own - known).max(0.0)).sqrt();
    metric.powers(error).zip_map(&metric.powers(known), weight)
}

/// Returns the weighted squared residual of a fit, minimised to first order over its variables, its
/// discrepancy and the amplitude of a numerical error of given shape and unit standard deviation.
fn cost(fit: &Fit, weights: &DVector<f64>, error: &DVector<f64>) -> f64 {
    let at = fit.search.best();
    let waves = fit.waves();
    let columns = at.jacobian.column_iter().chain(waves.column_iter());
    let mut columns: Vec<DVector<f64>> = columns.map(|c| c.component_mul(weights)).collect();
    columns.push(error.component_mul(weights));
    let residual = at.residual.component_mul(weights);
    let amplitudes = waves.ncols() + 1;
    let mut variables = fit.variables().to_vec();
    variables.resize(variables.len() + amplitudes, Variable::standard_normal());
    let mut x = at.x.clone();
    x.resize(x.len() + amplitudes, 0.0);
    let linear = Linearized {
        x,
        residual: residual.clone(),
        jacobian: DMatrix::from_columns(&columns),
    };
    Tangent::new(&linear, &variables)
        .project(&residual)
        .dot(&residual)
}
