//! The numerical check: how far the discretisation moves the curves, once recalibration has taken
//! what it can.
//!
//! Shorter cylinders, shorter steps and more head modes at the fitted point; the difference, projected
//! off the tangent space, becomes a part of the noise (an adequacy floor), so that no effect is named
//! for what a coarser rope does.
use crate::bench::{Bench, Fit};
use crate::laboratory::{Laboratory, Stage, channels};
use crate::record::Curves;
use crate::tangent::Tangent;
use nalgebra::{Complex, DVector};
use protocol::job::Refinement;

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
}

impl Preflight {
    /// The largest ratio of what is left to the standard error.
    pub fn ratio(&self) -> f64 {
        let each = self.rms_left.iter().zip(&self.standard_error);
        each.map(|(left, error)| left / error).fold(0.0, f64::max)
    }
}

/// Simulates a fitted point more finely. Nothing if the finer model fails.
///
/// # Errors
/// Of the laboratory.
pub async fn check<L: Laboratory>(
    lab: &mut L,
    bench: &Bench,
    fit: &Fit,
    finer: Refinement,
) -> Result<Option<Preflight>, L::Error> {
    let spec = fit.model.experiment(fit.x(), bench.record.condition, finer);
    let observed = lab
        .observe(Stage::Preflight, vec![spec])
        .await?
        .into_iter()
        .next()
        .flatten();
    let Some(fine) = observed.and_then(|o| channels(&o, &bench.record.channels)) else {
        return Ok(None);
    };
    let difference: Curves = fine
        .iter()
        .zip(&fit.curves)
        .map(|(fine, coarse)| fine.iter().zip(coarse).map(|(a, b)| a - b).collect())
        .collect();
    let tangent = Tangent::new(fit.search.best(), fit.variables());
    let whitened = tangent.project(&bench.metric.whiten(&difference));
    let spectra = |x: &DVector<f64>| bench.metric.colour(x);
    let left = spectra(&whitened);
    let unit = bench.metric.deviations();
    let rms = |spectrum: &Vec<Complex<f64>>| {
        (2.0 * spectrum.iter().map(Complex::norm_sqr).sum::<f64>()).sqrt()
    };
    let orders = bench.metric.orders();
    Ok(Some(Preflight {
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
    }))
}
