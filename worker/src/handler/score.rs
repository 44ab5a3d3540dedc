//! Compares a simulation with the measured record of its condition.
//!
//! A run that fails is graded: every complete run is better than a failure in motion (the later the better),
//! which is better than a failure under static load (the more load carried the better).
use protocol::case::{Case, Channel, ChannelRecord, Objective, Offset, Term};
use protocol::job::{
    ChannelScore, Derivative, Evaluation, Failure, Observation, Reached, Verdict,
    to_single_precision,
};

/// Fitness assigned to a run that fails in motion just before its end, far above the error of any complete
/// run; `FAILED_UNDER_LOAD` is assigned to one that fails just below full static load.
const FAILED_IN_MOTION: f64 = 1e6;
const FAILED_UNDER_LOAD: f64 = 1e7;

/// Compares the curves of a run, one per channel of its condition in the channel's unit, with the measured
/// record; channels without a record are ignored.
///
/// # Errors
/// [`Failure::Misconfigured`] if the condition has no record, or none for the channels of the objective.
pub(super) fn evaluation(
    (case, condition): (&Case, usize),
    seen: &Observation,
    with_residual: bool,
) -> Result<Evaluation, Failure> {
    let (verdict, counters) = (seen.verdict, seen.counters);
    if let Verdict::Failed { reached, .. } = verdict {
        return Ok(Evaluation {
            verdict,
            fitness: graded(reached),
            channels: Vec::new(),
            residual: Vec::new(),
            columns: Vec::new(),
            counters,
        });
    }
    let curves = || case.channels_of(condition).zip(&seen.curves);
    let lacking = curves().find(|((_, channel), curve)| {
        curve.is_empty() && channel.record.is_some() && case.objective.names(&channel.name)
    });
    if let Some(((_, channel), _)) = lacking {
        let problem = format!("the model simulates no curve of `{}`", channel.name);
        return Err(Failure::misconfigured("channels", problem));
    }
    let compared: Vec<Compared<'_>> = curves()
        .filter_map(|((at, channel), simulated)| {
            // a channel that takes no part in the objective may not have been simulated
            let record = channel.record.as_ref().filter(|_| !simulated.is_empty())?;
            let (score, residual) = compared(at, channel, record, simulated);
            Some(Compared {
                name: &channel.name,
                score,
                residual,
            })
        })
        .collect();
    if compared.is_empty() {
        return Err(Failure::misconfigured(
            "channels.record",
            "there is no record to score against",
        ));
    }
    Ok(Evaluation {
        verdict,
        fitness: weighted(&case.objective, &compared)?,
        residual: if with_residual {
            residual(&case.objective, &compared)
        } else {
            Vec::new()
        },
        columns: if with_residual {
            let channels: Vec<&Channel> = case.channels_of(condition).map(|(_, c)| c).collect();
            let columns = seen.columns.iter();
            columns
                .map(|column| residual_by(&case.objective, &channels, &compared, column))
                .collect()
        } else {
            Vec::new()
        },
        channels: compared.into_iter().map(|c| c.score).collect(),
        counters,
    })
}

fn graded(reached: Reached) -> f64 {
    match reached {
        Reached::TimeFraction(share) => FAILED_IN_MOTION * (2.0 - share),
        Reached::LoadFraction(share) => FAILED_UNDER_LOAD * (2.0 - share),
    }
}

/// Comparison of one channel's simulated curve with its measured record.
struct Compared<'a> {
    name: &'a str,
    score: ChannelScore,
    /// Residual of the channel: measured minus simulated values after offset removal, times the channel's
    /// weights; 0 where a limit holds.
    residual: Vec<f64>,
}

/// Compares a channel's simulated curve with its measured record; returns the score and the residual
/// (measured minus simulated after offset removal), times the weights; 0 where a limit holds.
fn compared(
    at: usize,
    channel: &Channel,
    record: &ChannelRecord,
    simulated: &[f64],
) -> (ChannelScore, Vec<f64>) {
    let measured = &record.mean;
    let n = measured.len() as f64;
    let pairs = measured.iter().zip(simulated);
    let difference: Vec<f64> = pairs
        .map(|(measured, simulated)| measured - simulated)
        .collect();
    let offset = weighted_mean(channel, &difference);
    let removed = match channel.offset {
        Offset::Free => offset,
        Offset::Fixed => 0.0,
    };
    let is_kept = |d: f64| channel.limit.is_some_and(|limit| limit.holds(d));
    let counted = difference.iter().map(|d| d - removed);
    let counted = counted.map(|d| if is_kept(d) { 0.0 } else { d });
    let plain: Vec<f64> = counted.collect();
    let weigh = |mut values: Vec<f64>| {
        channel.weigh(&mut values);
        values
    };
    let residual = weigh(plain.clone());
    let mean_square = |values: &[f64]| values.iter().map(|x| x * x).sum::<f64>() / n;
    let mse = mean_square(&residual);
    let mean = measured.iter().sum::<f64>() / n;
    let deviation = measured.iter().map(|x| (x - mean).abs()).sum::<f64>() / n;
    let (range, deviation) = match peak_to_peak(measured) {
        // residuals are compared with zeros, and errors with one unit
        0.0 if mean == 0.0 => (2.0, 1.0),
        // a single number, or one that stays: what it is compared with is itself
        0.0 => (2.0 * mean.abs(), mean.abs()),
        range => (range, deviation),
    };
    let score = ChannelScore {
        channel: at,
        mse,
        mse_fixed_offset: match channel.limit {
            Some(_) => mse,
            None => mean_square(&weigh(difference)),
        },
        offset,
        rmse_over_half_range: mean_square(&plain).sqrt() / (0.5 * range),
        relative_error: plain.iter().map(|x| x.abs()).sum::<f64>() / n / deviation,
        peak_to_peak_error: (peak_to_peak(simulated) - peak_to_peak(measured)) / range,
    };
    (score, residual)
}

/// Computes the mean of differences, weighted by the squares of the channel's weights.
fn weighted_mean(channel: &Channel, differences: &[f64]) -> f64 {
    if channel.weights.is_empty() {
        return differences.iter().sum::<f64>() / differences.len() as f64;
    }
    let pairs = differences.iter().zip(&channel.weights);
    let (sum, all) = pairs.fold((0.0, 0.0), |(sum, all), (d, w)| {
        (sum + w * w * d, all + w * w)
    });
    sum / all
}

fn peak_to_peak(values: &[f64]) -> f64 {
    let highest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let lowest = values.iter().copied().fold(f64::INFINITY, f64::min);
    highest - lowest
}

fn weighted(objective: &Objective, compared: &[Compared<'_>]) -> Result<f64, Failure> {
    let term = |term: &Term| {
        let found = compared.iter().find(|c| c.name == term.channel)?;
        Some(term.weight * found.score.mse)
    };
    let terms: Vec<f64> = objective.terms.iter().filter_map(term).collect();
    if terms.is_empty() {
        let names: Vec<&str> = objective.terms.iter().map(|term| &*term.channel).collect();
        let problem = format!("no record of {} under this condition", names.join(", "));
        return Err(Failure::misconfigured("objective.terms", problem));
    }
    Ok(terms.iter().sum())
}

/// Concatenates the residuals of the objective's channels, scaled such that the squared norm of the whole is
/// the objective.
fn residual(objective: &Objective, compared: &[Compared<'_>]) -> Vec<f64> {
    let scaled = |term: &Term| {
        let found = compared.iter().find(|c| c.name == term.channel)?;
        let scale = (term.weight / found.residual.len() as f64).sqrt();
        Some(found.residual.iter().map(move |r| scale * r))
    };
    let terms = objective.terms.iter();
    terms.filter_map(scaled).flatten().collect()
}

/// Computes the derivative of the objective's residual from the derivative of the channels' curves;
/// `channels` are the channels of those curves, in the same order, and `compared` those with a record. Where a
/// limit holds, the derivative is 0.
fn residual_by(
    objective: &Objective,
    channels: &[&Channel],
    compared: &[Compared<'_>],
    by: &Derivative,
) -> Derivative {
    let Derivative::Curves { per, curves } = by else {
        return by.clone();
    };
    let mut all = Vec::new();
    for term in &objective.terms {
        let mut found = channels.iter().zip(curves);
        let found =
            found.find(|(channel, _)| channel.name == term.channel && channel.record.is_some());
        let Some((channel, curve)) = found else {
            // not measured under this condition
            continue;
        };
        if curve.is_empty() {
            return Derivative::Missing {
                reason: format!(
                    "the model computes no derivative of channel `{}`",
                    term.channel
                ),
            };
        }
        let n = curve.len() as f64;
        let mut curve: Vec<f64> = curve.iter().map(|x| f64::from(*x)).collect();
        let removed = match channel.offset {
            Offset::Free => weighted_mean(channel, &curve),
            Offset::Fixed => 0.0,
        };
        let scale = (term.weight / n).sqrt();
        // measured less simulated
        for x in &mut curve {
            *x = removed - *x;
        }
        channel.weigh(&mut curve);
        if let (Some(_), Some(at)) = (
            channel.limit,
            compared.iter().find(|own| own.name == term.channel),
        ) {
            let kept = curve.iter_mut().zip(&at.residual);
            kept.filter(|(_, residual)| **residual == 0.0)
                .for_each(|(x, _)| *x = 0.0);
        }
        all.extend(to_single_precision(curve.into_iter().map(|x| scale * x)));
    }
    Derivative::Curves {
        per: per.clone(),
        curves: vec![all],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::{
        case::{Abscissa, ChannelLimit},
        job::Per,
    };

    fn channel(name: &str, weights: &[f64], offset: Offset) -> Channel {
        Channel {
            name: name.to_owned(),
            title: name.to_owned(),
            unit: "N".to_owned(),
            condition: 0,
            abscissa: Abscissa {
                name: "time".to_owned(),
                unit: "s".to_owned(),
                points: vec![0.0, 1.0, 2.0, 3.0],
                period: None,
            },
            noise: None,
            step: None,
            weights: weights.to_vec(),
            offset,
            limit: None,
            record: None,
        }
    }

    #[test]
    fn scores_follow_their_definitions() {
        let record = ChannelRecord {
            cycles: 1,
            mean: vec![1.0, 3.0, 5.0, 3.0],
            spread: vec![0.0; 4],
        };
        let simulated = [0.0, 1.0, 6.0, 1.0];
        let free = channel("a", &[], Offset::Free);
        let (free, residual) = compared(2, &free, &record, &simulated);
        // differences 1, 2, -1, 2: mean 1
        assert_eq!((free.channel, residual), (2, vec![0.0, 1.0, -2.0, 1.0]));
        assert!((free.offset - 1.0).abs() < 1e-15);
        assert!((free.mse - 1.5).abs() < 1e-15);
        assert!((free.mse_fixed_offset - 2.5).abs() < 1e-15);
        assert!((free.rmse_over_half_range - 1.5_f64.sqrt() / 2.0).abs() < 1e-15);
        assert!((free.relative_error - 1.0).abs() < 1e-15);
        assert!((free.peak_to_peak_error - 0.5).abs() < 1e-15);
        // a value of weight 2 counts four times, for the offset as well
        let weighted = channel("a", &[1.0, 1.0, 2.0, 1.0], Offset::Free);
        let (score, residual) = compared(2, &weighted, &record, &simulated);
        assert!((score.offset - 1.0 / 7.0).abs() < 1e-15);
        let square: f64 = residual.iter().map(|x| x * x).sum();
        assert!((score.mse - square / 4.0).abs() < 1e-15);
        assert!((residual[2] + 2.0 * 8.0 / 7.0).abs() < 1e-15);
        let fixed = channel("a", &[], Offset::Fixed);
        let (fixed, _) = compared(2, &fixed, &record, &simulated);
        assert!((fixed.mse - 2.5).abs() < 1e-15);
    }

    /// Checks that only values beyond a limit count, with their derivatives.
    #[test]
    fn values_within_a_limit_are_no_errors() {
        let record = ChannelRecord {
            cycles: 1,
            mean: vec![1.0, 3.0, 5.0, 3.0],
            spread: vec![0.0; 4],
        };
        let simulated = [0.0, 1.0, 6.0, 5.0];
        let objective = Objective {
            condition: 0,
            others: Vec::new(),
            terms: vec![Term {
                channel: "a".to_owned(),
                weight: 4.0,
            }],
        };
        for (limit, residual) in [
            (ChannelLimit::AtMost, vec![0.0, 0.0, -1.0, -2.0]),
            (ChannelLimit::AtLeast, vec![1.0, 2.0, 0.0, 0.0]),
        ] {
            let mut own = channel("a", &[], Offset::Fixed);
            own.limit = Some(limit);
            own.record = Some(record.clone());
            let (score, found) = compared(0, &own, &record, &simulated);
            assert_eq!(found, residual);
            assert!((score.mse - 5.0 / 4.0).abs() < 1e-15);
            let at = [Compared {
                name: "a",
                score,
                residual: found,
            }];
            let derivative = Derivative::Curves {
                per: Per::Decade,
                curves: vec![vec![1.0; 4]],
            };
            let by = residual_by(&objective, &[&own], &at, &derivative);
            let expected = residual.iter().map(|r| if *r == 0.0 { 0.0 } else { -1.0 });
            let expected = Derivative::Curves {
                per: Per::Decade,
                curves: vec![expected.collect()],
            };
            assert_eq!(by, expected);
        }
    }

    /// Checks that derivatives of the objective's residual equal its change when the curves change, with and
    /// without offset removal.
    #[test]
    fn derivatives_are_those_of_the_residual() {
        let record = |mean: [f64; 4]| ChannelRecord {
            cycles: 1,
            mean: mean.to_vec(),
            spread: vec![0.0; 4],
        };
        let records = [record([1.0, 3.0, 5.0, 3.0]), record([2.0, 0.0, 1.0, 4.0])];
        let curves = [
            [0.5, 1.0, -2.0, 0.25],
            [9.0, 9.0, 9.0, 9.0],
            [4.0, 0.0, 1.0, -1.0],
        ];
        let term = |channel: &str, weight: f64| Term {
            channel: channel.to_owned(),
            weight,
        };
        let derivative = Derivative::Curves {
            per: Per::Decade,
            curves: curves.map(to_single_precision).to_vec(),
        };
        // each channel by its own treatment
        for offsets in [[Offset::Free, Offset::Fixed], [Offset::Fixed, Offset::Free]] {
            let mut own = [
                channel("b", &[1.0, 2.0, 0.5, 1.0], offsets[0]),
                channel("unscored", &[], Offset::Free),
                channel("a", &[], offsets[1]),
            ];
            own[0].record = Some(records[1].clone());
            own[2].record = Some(records[0].clone());
            let channels: Vec<&Channel> = own.iter().collect();
            let objective = Objective {
                condition: 0,
                others: Vec::new(),
                terms: vec![
                    term("a", 0.7),
                    term("b", 2.0),
                    term("of another condition", 1.0),
                ],
            };
            let at = |by: f64| {
                let all = [(0, 2), (1, 0)].map(|(at, own)| {
                    let simulated = curves[own].map(|x| 1.0 + by * x);
                    let channel = channels[own];
                    let (score, residual) = compared(at, channel, &records[at], &simulated);
                    Compared {
                        name: &channel.name,
                        score,
                        residual,
                    }
                });
                residual(&objective, &all)
            };
            let Derivative::Curves { curves, .. } =
                residual_by(&objective, &channels, &[], &derivative)
            else {
                unreachable!("it has one")
            };
            let expected = at(1.0)
                .into_iter()
                .zip(at(0.0))
                .map(|(one, zero)| one - zero);
            assert_eq!(curves[0].len(), 8);
            for (found, expected) in curves[0].iter().zip(expected) {
                assert!((f64::from(*found) - expected).abs() < 1e-6);
            }
            let gap = Derivative::Curves {
                per: Per::Decade,
                curves: vec![Vec::new(); 3],
            };
            let none = residual_by(&objective, &channels, &[], &gap);
            assert!(matches!(none, Derivative::Missing { .. }));
        }
    }

    #[test]
    fn failures_are_graded_by_how_far_they_got() {
        let grades = [
            graded(Reached::TimeFraction(0.9)),
            graded(Reached::TimeFraction(0.1)),
            graded(Reached::LoadFraction(0.9)),
            graded(Reached::LoadFraction(0.0)),
        ];
        assert!(grades.is_sorted() && grades[0] > 1e5, "{grades:?}");
    }
}
