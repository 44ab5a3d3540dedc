//! What every test stands on: noise, way into the valley, recalibration, numerical check, and the fit
//! in the final metric.
use crate::bench::{Bench, Fit};
use crate::diagnose::Inputs;
use crate::evidence::misfit;
use crate::laboratory::{Laboratory, Stage};
use crate::metric::Metric;
use crate::model::{Model, sizes};
use crate::noise::Noise;
use crate::record::{Curves, Record};
use crate::score::misfit_tail;
use crate::spectrum::Orders;
use crate::stage::preflight::Preflight;
use crate::stage::{basin, preflight, recalibrate, valley};
use nalgebra::{Complex, DVector};
use protocol::announce::EffectDescriptor;

/// A data sheet's noise may be off by this factor in its variance, either way; what is left beyond it
/// is no noise, or not the noise that was assumed.
const ASSUMED: f64 = 2.0;

/// The recalibrated model in its final metric.
pub(crate) struct Base {
    pub(crate) bench: Bench,
    pub(crate) fit: Fit,
    pub(crate) preflight: Option<Preflight>,
    pub(crate) assumed: bool,
    pub(crate) freedom: f64,
    pub(crate) notes: Vec<String>,
}

impl Base {
    /// Whether noise alone may leave so much after a fit of so many parameters, at a level; where the
    /// noise is only assumed, whether the assumption bears with what is left.
    pub(crate) fn is_noise(&self, chi_squared: f64, parameters: usize, level: f64) -> bool {
        let n = self.bench.metric.len();
        if self.assumed {
            let left = n.saturating_sub(parameters).max(1) as f64;
            return (1.0 / ASSUMED..=ASSUMED).contains(&(chi_squared / left));
        }
        let freedom = n as f64 * (self.bench.record.cycles.len() as f64 - 1.0);
        misfit_tail(chi_squared, n, parameters, freedom) >= level
    }
}

/// Noise, way into the valley, recalibration, numerical check, final metric, final fit.
pub(crate) async fn establish<L: Laboratory>(
    lab: &mut L,
    inputs: &Inputs,
    model: &Model,
    record: Record,
) -> Result<Option<Base>, L::Error> {
    let orders = Orders::new(record.samples(), inputs.settings.orders);
    let channels = record.channels.len();
    let rough = Noise::estimate(&record, &orders, &[]);
    let metric = Metric::new(orders.clone(), channels, &rough.covariances);
    let bench = Bench::new(record.clone(), metric, inputs.usual);
    let starts = match &inputs.start {
        Some(start) => vec![start.clone()],
        None => basin::enter(lab, (&bench, Stage::Basin), (model, &[]), inputs.seed).await?,
    };
    let Some(mut first) = recalibrate::from_starts(lab, &bench, model, starts).await? else {
        return Ok(None);
    };
    if misfit(first.chi_squared(), bench.metric.len()) > inputs.settings.valley
        && let Some(other) = valley::enter(lab, (&bench, Stage::Basin), &first).await?
    {
        first = other;
    }
    let inputs_of_cycles = input_curves(lab, &bench, &first, &inputs.library).await?;
    let spectra: Vec<Vec<Vec<Complex<f64>>>> = inputs_of_cycles
        .iter()
        .map(|(curves, _)| curves.iter().map(|curve| orders.transform(curve)).collect())
        .collect();
    let mut noise = Noise::estimate(&record, &orders, &spectra);
    let weigh = |noise: &Noise| {
        let mut metric = Metric::new(orders.clone(), channels, &noise.covariances);
        let directions: Vec<DVector<f64>> = inputs_of_cycles
            .iter()
            .map(|(curves, deviation)| metric.whiten(curves) * *deviation)
            .collect();
        metric.marginalize(&directions);
        Bench::new(record.clone(), metric, inputs.usual)
    };
    let bench = weigh(&noise);
    let Some(second) = recalibrate::converge(lab, &bench, model, first.x()).await? else {
        return Ok(None);
    };
    let preflight = preflight::check(lab, &bench, (&second, &second), inputs.finer).await?;
    let mut notes = Vec::new();
    let (bench, fit) = if let Some(seen) = &preflight {
        if !seen.whole {
            notes.push(
                "the finer model did not complete as a whole: cylinders and steps were refined one at \
                 a time"
                    .to_owned(),
            );
        }
        noise.add_error(&seen.left);
        let bench = weigh(&noise);
        match recalibrate::converge(lab, &bench, model, second.x()).await? {
            Some(fit) => (bench, fit),
            None => return Ok(None),
        }
    } else {
        notes.push("the finer model did not complete: the numerical error is unknown".to_owned());
        (bench, second)
    };
    Ok(Some(Base {
        bench,
        fit,
        preflight,
        assumed: noise.assumed,
        freedom: noise.freedom,
        notes,
    }))
}

/// Curves by which cycles differ because their input did, per unit of it, with the standard deviation
/// of the mean over the cycles: the crank angle (deg) and the load's scale.
async fn input_curves<L: Laboratory>(
    lab: &mut L,
    bench: &Bench,
    fit: &Fit,
    library: &[EffectDescriptor],
) -> Result<Vec<(Curves, f64)>, L::Error> {
    let stated = &bench.record.stated;
    let cycles = (bench.record.cycles.len().max(1) as f64).sqrt();
    let mut inputs = Vec::new();
    if stated.angle_tolerance_deg > 0.0 {
        let orders = bench.metric.orders();
        let slope = |curve: &Vec<f64>| {
            let spectrum: Vec<Complex<f64>> = orders
                .transform(curve)
                .iter()
                .enumerate()
                .map(|(k, f)| f * Complex::new(0.0, (k + 1) as f64 * 1.0_f64.to_radians()))
                .collect();
            orders.curve(&spectrum)
        };
        // a tolerance bounds a uniform distribution
        let deviation = stated.angle_tolerance_deg / 3.0_f64.sqrt() / cycles;
        inputs.push((fit.curves.iter().map(slope).collect(), deviation));
    }
    let gain = library.iter().find(|effect| effect.id == "load_cell_gain");
    if let Some(gain) = gain.filter(|_| stated.load_scatter > 0.0)
        && let Some(&k) = sizes(gain).first()
    {
        let p = &gain.parameters[k];
        let mut x = fit.x().to_vec();
        let mut own = crate::model::absent(gain);
        own[k] = (p.typical - p.absent) / p.scale;
        x.extend(own);
        let model = fit.model.with(gain);
        let seen = bench
            .curves(lab, Stage::Recalibrate, &[(&model, &x)])
            .await?;
        if let Some(curves) = seen.into_iter().next().flatten() {
            let per_unit = |(a, b): (&Vec<f64>, &Vec<f64>)| -> Vec<f64> {
                a.iter()
                    .zip(b)
                    .map(|(a, b)| (a - b) / (p.typical - p.absent))
                    .collect()
            };
            let curves = curves.iter().zip(&fit.curves).map(per_unit).collect();
            inputs.push((curves, stated.load_scatter / cycles));
        }
    }
    Ok(inputs)
}
