//! The numerical check: how far the discretisation moves the curves, once recalibration has taken
//! what it can.
//!
//! Shorter cylinders, shorter steps and more head modes at the fitted point; the difference, projected
//! off the tangent space, becomes a part of the noise (an adequacy floor), so that no effect is named
//! for what a coarser rope does. At an answer it is looked at again: a name must still be believed when
//! what a finer model changes there counts as noise too.
use crate::bench::{Bench, Fit};
use crate::evidence::misfit;
use crate::laboratory::{Laboratory, Stage, channels};
use crate::metric::Metric;
use crate::noise::smoothed;
use crate::record::Curves;
use crate::stage::establish::Base;
use crate::tangent::Tangent;
use nalgebra::{Complex, DMatrix, DVector};
use protocol::job::{Observation, Refinement};
use search::least_squares::{Linearized, Prior, Variable};

/// What a finer model says.
#[derive(Clone, Debug)]
pub struct Preflight {
    /// Difference of the curves, finer less coarser, by channel.
    pub difference: Curves,
    /// Its root mean square by channel, in the channel's unit.
    pub rms: Vec<f64>,
    /// The same after recalibration has taken its share.
    pub rms_left: Vec<f64>,
    /// Standard error of the record's mean by channel, root mean square over the compared orders.
    pub standard_error: Vec<f64>,
    /// Coefficients of what is left, by channel.
    pub left: Vec<Vec<Complex<f64>>>,
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

/// A believed model held against a finer one.
#[derive(Clone, Debug)]
pub(crate) struct Checked {
    /// What the finer model changes.
    pub(crate) preflight: Preflight,
    /// The nats that the model still gains over the one before it, over the squared misfit, when that
    /// change counts as noise.
    pub(crate) gain: f64,
}

/// Checks a model that is about to be believed, which gains so many nats over the one before it.
/// Nothing if no finer model completes.
///
/// # Errors
/// Of the laboratory.
pub(crate) async fn believed<L: Laboratory>(
    lab: &mut L,
    base: &Base,
    (before, after): (&Fit, &Fit),
    nats: f64,
    finer: Refinement,
) -> Result<Option<Checked>, L::Error> {
    let Some(mut preflight) = check(lab, &base.bench, (after, before), finer).await? else {
        return Ok(None);
    };
    if let Some(first) = &base.preflight {
        // the metric holds the first check's error since; the ratio is to the record's own
        preflight.standard_error.clone_from(&first.standard_error);
    }
    let metric = &base.bench.metric;
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
    let phi = misfit(own, error.len());
    let gain = nats - 0.5 * (usual_null - usual_own) + 0.5 * (null - own);
    Ok(Some(Checked {
        preflight,
        gain: gain / (phi * phi),
    }))
}

/// What is left of a change of the curves, in a metric, once what a fit can absorb is taken off.
fn left(metric: &Metric, fit: &Fit, difference: &Curves) -> DVector<f64> {
    let tangent = Tangent::new(fit.search.best(), fit.variables());
    tangent.project(&metric.whiten(difference))
}

/// By how much each entry counts when the power of an error, smoothed over orders, is noise as far as
/// it exceeds that of an error which the metric knows.
fn floor(metric: &Metric, error: &DVector<f64>, known: &DVector<f64>) -> DVector<f64> {
    let power = |x: &DVector<f64>, channel: usize| -> Vec<f64> {
        let part = |order: usize| {
            let at = 2 * (order * metric.channels() + channel);
            0.5 * (x[at] * x[at] + x[at + 1] * x[at + 1])
        };
        smoothed(
            &(0..metric.orders().highest())
                .map(part)
                .collect::<Vec<f64>>(),
        )
    };
    let both = |channel| (power(error, channel), power(known, channel));
    let powers: Vec<(Vec<f64>, Vec<f64>)> = (0..metric.channels()).map(both).collect();
    DVector::from_fn(error.len(), |entry, _| {
        let (order, channel) = metric.place(entry);
        let (own, known) = (powers[channel].0[order - 1], powers[channel].1[order - 1]);
        1.0 / (1.0 + (own - known).max(0.0)).sqrt()
    })
}

/// What a fit leaves, to first order, in entries that count by weights and with an error of known
/// shape beside its parameters, whose amount is about one.
fn cost(fit: &Fit, weights: &DVector<f64>, error: &DVector<f64>) -> f64 {
    let at = fit.search.best();
    let columns = at.jacobian.column_iter();
    let mut columns: Vec<DVector<f64>> = columns.map(|c| c.component_mul(weights)).collect();
    columns.push(error.component_mul(weights));
    let residual = at.residual.component_mul(weights);
    let mut variables = fit.variables().to_vec();
    variables.push(Variable {
        start: 0.0,
        lower: f64::NEG_INFINITY,
        upper: f64::INFINITY,
        step: 1.0,
        prior: Some(Prior {
            mean: 0.0,
            deviation: 1.0,
        }),
    });
    let mut x = at.x.clone();
    x.push(0.0);
    let linear = Linearized {
        x,
        residual: residual.clone(),
        jacobian: DMatrix::from_columns(&columns),
    };
    Tangent::new(&linear, &variables)
        .project(&residual)
        .dot(&residual)
}

/// Simulates a fitted point more finely; what a fit (that one, or the one before an effect was added,
/// for a size must not hide what it does not explain) can absorb is taken off. If the finer model
/// fails, its cylinders and the rest of it are refined one at a time, and their differences added: so
/// it is to first order. Nothing if that fails too.
///
/// # Errors
/// Of the laboratory.
pub async fn check<L: Laboratory>(
    lab: &mut L,
    bench: &Bench,
    (fit, absorbing): (&Fit, &Fit),
    finer: Refinement,
) -> Result<Option<Preflight>, L::Error> {
    let usual = bench.refinement;
    let whole = differences(lab, bench, fit, &[finer]).await?;
    if let Some(difference) = whole.into_iter().flatten().next() {
        return Ok(Some(preflight(bench, absorbing, difference, true)));
    }
    let cylinders = Refinement {
        cylinder_length_m: finer.cylinder_length_m,
        ..usual
    };
    let rest = Refinement {
        cylinder_length_m: usual.cylinder_length_m,
        ..finer
    };
    let parts = differences(lab, bench, fit, &[cylinders, rest]).await?;
    let sum = parts.into_iter().flatten().reduce(|mut sum, part| {
        for (sum, part) in sum.iter_mut().zip(part) {
            for (sum, part) in sum.iter_mut().zip(part) {
                *sum += part;
            }
        }
        sum
    });
    Ok(sum.map(|difference| preflight(bench, absorbing, difference, false)))
}

/// Curves of a fitted point in several discretisations less those of the fit; nothing where one failed.
async fn differences<L: Laboratory>(
    lab: &mut L,
    bench: &Bench,
    fit: &Fit,
    refinements: &[Refinement],
) -> Result<Vec<Option<Curves>>, L::Error> {
    let condition = bench.record.condition;
    let batch = refinements
        .iter()
        .map(|refinement| fit.model.experiment(fit.x(), condition, *refinement))
        .collect();
    let observed = lab.observe(Stage::Preflight, batch).await?;
    let less = |(fine, coarse): (&Vec<f64>, &Vec<f64>)| -> Vec<f64> {
        fine.iter().zip(coarse).map(|(a, b)| a - b).collect()
    };
    let difference = |seen: Option<Observation>| -> Option<Curves> {
        let fine = channels(&seen?, &bench.record.channels)?;
        Some(fine.iter().zip(&fit.curves).map(less).collect())
    };
    Ok(observed.into_iter().map(difference).collect())
}

/// What a difference of the curves means beside a record, and beside a fit that absorbs a part of it.
fn preflight(bench: &Bench, absorbing: &Fit, difference: Curves, whole: bool) -> Preflight {
    let left = bench
        .metric
        .colour(&left(&bench.metric, absorbing, &difference));
    let unit = bench.metric.deviations();
    let rms = |spectrum: &Vec<Complex<f64>>| {
        (2.0 * spectrum.iter().map(Complex::norm_sqr).sum::<f64>()).sqrt()
    };
    let orders = bench.metric.orders();
    Preflight {
        rms: difference
            .iter()
            .map(|curve| rms(&orders.transform(curve)))
            .collect(),
        rms_left: left.iter().map(rms).collect(),
        standard_error: unit
            .iter()
            .map(|deviations| (2.0 * deviations.iter().map(|d| d * d).sum::<f64>()).sqrt())
            .collect(),
        difference,
        left,
        whole,
    }
}
