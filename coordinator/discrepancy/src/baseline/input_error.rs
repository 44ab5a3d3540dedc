//! Errors of the measured inputs, such as the load, expressed as changes of the simulated curves.
use crate::laboratory::Laboratory;
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::model::parameter::{at_typical, sizes};
use protocol::announce::EffectDescriptor;
use record::InputScatter;
use record::{Curves, difference};

/// Deviation of the curves caused by the scatter of an input between cycles.
pub(crate) struct InputError {
    /// Change of the curves per unit of the input, by channel.
    pub(crate) curves: Curves,
    /// Standard deviation of the input's mean over the cycles.
    pub(crate) deviation: f64,
}

/// Returns the change of the curves by each stated input error, at a fitted point; `own` are the curves of
/// that point under the record's condition.
pub(crate) async fn input_errors<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    (fit, own): (&Fit, &Curves),
    library: &[EffectDescriptor],
) -> Result<Vec<InputError>, L::Error> {
    let on = experiments.on;
    let cycles = (on.record.cycles.len().max(1) as f64).sqrt();
    let mut errors = Vec::new();
    for scatter in &on.record.stated.input_scatter {
        match scatter {
            InputScatter::Abscissa { tolerance } => errors.push(InputError {
                curves: on.metric.slopes(own),
                // a tolerance bounds a uniform distribution
                deviation: tolerance / 3.0_f64.sqrt() / cycles,
            }),
            InputScatter::Effect { id, deviation } => {
                let Some(effect) = library.iter().find(|effect| effect.id == *id) else {
                    continue;
                };
                let Some(&size) = sizes(effect).first() else {
                    continue;
                };
                let p = &effect.parameters[size];
                let point = fit.with(effect, &at_typical(effect, &[size]));
                let seen = experiments.curves(&[point]).await?;
                errors.extend(seen.into_iter().flatten().map(|curves| InputError {
                    curves: difference(&curves, own, p.typical - p.absent),
                    deviation: deviation / cycles,
                }));
            }
        }
    }
    Ok(errors)
}
