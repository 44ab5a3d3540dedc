//! What the measured input may be wrong by: the crank angle and the scale of the load.
use crate::laboratory::Laboratory;
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::model::parameter::{at_typical, sizes};
use crate::record::measured::{Curves, difference};
use nalgebra::Complex;
use protocol::announce::EffectDescriptor;

/// Curves by which cycles differ because an input of theirs did.
pub(crate) struct InputError {
    /// Per unit of the input, by channel.
    pub(crate) curves: Curves,
    /// Standard deviation of the input's mean over the cycles.
    pub(crate) deviation: f64,
}

/// Errors of the crank angle (deg) and of the load's scale, as far as the data sheet states them.
pub(crate) async fn input_errors<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    fit: &Fit,
    library: &[EffectDescriptor],
) -> Result<Vec<InputError>, L::Error> {
    let on = experiments.on;
    let stated = &on.record.stated;
    let cycles = (on.record.cycles.len().max(1) as f64).sqrt();
    let mut errors = Vec::new();
    if stated.angle_tolerance_deg > 0.0 {
        let orders = on.metric.orders();
        let slope = |curve: &Vec<f64>| {
            let spectrum: Vec<Complex<f64>> = orders
                .transform(curve)
                .iter()
                .enumerate()
                .map(|(k, f)| f * Complex::new(0.0, (k + 1) as f64 * 1.0_f64.to_radians()))
                .collect();
            orders.curve(&spectrum)
        };
        errors.push(InputError {
            curves: fit.curves.iter().map(slope).collect(),
            // a tolerance bounds a uniform distribution
            deviation: stated.angle_tolerance_deg / 3.0_f64.sqrt() / cycles,
        });
    }
    let gain = library.iter().find(|effect| effect.id == "load_cell_gain");
    if let Some(gain) = gain.filter(|_| stated.load_scatter > 0.0)
        && let Some(&size) = sizes(gain).first()
    {
        let p = &gain.parameters[size];
        let point = fit.with(gain, &at_typical(gain, &[size]));
        let seen = experiments.curves(&[point]).await?;
        errors.extend(seen.into_iter().flatten().map(|curves| InputError {
            curves: difference(&curves, &fit.curves, p.typical - p.absent),
            deviation: stated.load_scatter / cycles,
        }));
    }
    Ok(errors)
}
