//! Correlation of the noise where there is one cycle and the channels do not state it: estimated once from
//! the residual of the likeliest model.
use crate::baseline::session::Session;
use crate::diagnose::rounds::test_effects;
use crate::inputs::Inputs;
use crate::laboratory::Laboratory;
use crate::model::fit::Fit;
use crate::record::measured::Record;
use crate::record::noise::NoiseSource;

/// Returns the record with the missing noise correlations filled in and a note about them; `None` where no
/// correlation is missing or the noise is not stated.
///
/// # Errors
/// Returns an error if no worker is left to simulate, or the user stops the run.
pub(crate) async fn with_correlations<L: Laboratory>(
    session: &mut Session<'_, L>,
) -> Result<Option<(Record, String)>, L::Error> {
    let base = session.base;
    let mut record = base.record.record.clone();
    let lacks = record.channels.iter().any(|own| own.correlation.is_none());
    if base.known() != NoiseSource::Stated || !lacks {
        return Ok(None);
    }
    let named: Vec<_> = session.inputs.considered().filter(|e| !e.generic).collect();
    let round = test_effects(session, &base.fit, &named, &[]).await?;
    let refitted = round.refits.iter().map(|own| &own.fit);
    let likeliest = refitted
        .chain([&base.fit])
        .max_by(|a, b| a.log_evidence().total_cmp(&b.log_evidence()))
        .unwrap_or(&base.fit);
    let found = correlations(&record, likeliest);
    let mut said = Vec::new();
    for (own, found) in record.channels.iter_mut().zip(found) {
        if own.correlation.is_none() {
            own.correlation = Some(found);
            if found > 0.0 {
                said.push(format!("{} {found:.2}", own.channel.title));
            }
        }
    }
    let words = if said.is_empty() {
        "no correlation of the noise is stated, and the residual of the likeliest model has none"
            .to_owned()
    } else {
        format!(
            "the correlation of the noise between neighbouring values is not stated: it is estimated from the residual of \
             the likeliest model ({})",
            said.join(", ")
        )
    };
    Ok(Some((record, words)))
}

/// Returns the inputs of a repeated diagnosis that starts from a fit. A missing noise correlation is that of
/// the channel of the same name in `record`, or the record's largest for a channel that it lacks.
pub(crate) fn repeated_inputs(inputs: &Inputs, record: &Record, fit: &Fit) -> Inputs {
    let mut again = inputs.clone();
    let all = record.channels.iter().filter_map(|own| own.correlation);
    let largest = all.reduce(f64::max);
    again.start = Some(fit.x()[..inputs.space.dimension()].to_vec());
    for own in again.records.iter_mut().flat_map(|r| &mut r.channels) {
        let mut same = record.channels.iter();
        let same = same.find(|other| other.channel.name == own.channel.name);
        let same = same.map(|other| other.correlation.unwrap_or(0.0));
        own.correlation = own.correlation.or(same).or(largest);
    }
    again
}

/// Returns the lag-1 correlation of the residual of a fit, by channel; 0 where it is not significant.
fn correlations(record: &Record, fit: &Fit) -> Vec<f64> {
    /// Upper limit of the estimated noise correlation: a residual that is correlated more strongly is model
    /// error and not noise of a channel.
    const MOST: f64 = 0.99;
    let mean = record.mean();
    let channels = mean.iter().zip(&fit.curves).zip(&record.channels);
    channels
        .map(|((measured, simulated), own)| {
            let left: Vec<f64> = measured.iter().zip(simulated).map(|(y, s)| y - s).collect();
            let count = left.len() as f64;
            let constant = if own.channel.is_absolute() {
                0.0
            } else {
                left.iter().sum::<f64>() / count
            };
            let weight = |i: usize| own.channel.weights.get(i).copied().unwrap_or(1.0);
            let left: Vec<f64> = left
                .iter()
                .enumerate()
                .map(|(i, r)| (r - constant) * weight(i))
                .collect();
            let power: f64 = left.iter().map(|r| r * r).sum();
            let lagged: f64 = left.windows(2).map(|pair| pair[0] * pair[1]).sum();
            let rho = lagged / power;
            // two standard errors of the correlation of white values (Bartlett)
            if rho * count.sqrt() > 2.0 {
                rho.min(MOST)
            } else {
                0.0
            }
        })
        .collect()
}
