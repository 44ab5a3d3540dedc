//! A simulation compared with the gauge record of its condition.
//!
//! A run that fails is graded: every complete run beats a failure in motion (the later the
//! better), which beats a failure under static load (the more load carried the better).
use super::machines::Machines;
use super::ran::Ran;
use protocol::{
    case::{GaugeTrace, Objective, Offset},
    job::{ChannelScore, Evaluation, Failure, Reached, SimulateSpec, Verdict},
};
use simulation::observe::Recorder;

/// Fitness of a failure in motion just before the end, and under load just before full load
/// \[MPa^2\]; far above the error of any run that completes.
const FAILED_IN_MOTION: f64 = 1e6;
const FAILED_UNDER_LOAD: f64 = 1e7;

/// Simulates and compares.
///
/// # Errors
/// As [`Ran::new`], and if the condition has no record.
pub(super) fn run(
    machines: &Machines,
    spec: &SimulateSpec,
    with_residual: bool,
) -> Result<Evaluation, Failure> {
    let ran = Ran::new(machines, spec, Recorder::gauges_only())?;
    let Ran {
        verdict, counters, ..
    } = ran;
    if let Verdict::Failed { reached, .. } = verdict {
        return Ok(Evaluation {
            verdict,
            fitness: graded(reached),
            channels: Vec::new(),
            residual_mpa: Vec::new(),
            counters,
        });
    }
    let case = &machines.unit.case;
    let condition = case.conditions.get(spec.individual.condition);
    let record = condition
        .and_then(|condition| condition.record.as_ref())
        .ok_or_else(|| {
            Failure::misconfigured(
                "conditions.record",
                "there is no gauge record to score against",
            )
        })?;
    let compared: Vec<Compared> = record
        .gauges
        .iter()
        .map(|trace| {
            let simulated = &ran.curves.gauge[usize::from(trace.gauge) - 1];
            Compared::new(trace, simulated, case.objective.offset)
        })
        .collect();
    Ok(Evaluation {
        verdict,
        fitness: weighted(&case.objective, &compared)?,
        residual_mpa: if with_residual {
            residual(&case.objective, &compared)
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

/// One gauge compared with its record.
struct Compared {
    score: ChannelScore,
    /// Measured minus simulated after offset removal \[MPa\].
    residual: Vec<f64>,
}

impl Compared {
    fn new(trace: &GaugeTrace, simulated_pa: &[f64], treatment: Offset) -> Self {
        let measured = &trace.mean_mpa;
        let n = measured.len() as f64;
        let difference: Vec<f64> = measured
            .iter()
            .zip(simulated_pa)
            .map(|(measured, simulated)| measured - simulated * 1e-6)
            .collect();
        let offset = difference.iter().sum::<f64>() / n;
        let removed = match treatment {
            Offset::Free => offset,
            Offset::Fixed => 0.0,
        };
        let residual: Vec<f64> = difference.iter().map(|d| d - removed).collect();
        let mean_square = |values: &[f64]| values.iter().map(|x| x * x).sum::<f64>() / n;
        let mse = mean_square(&residual);
        let measured_mean = measured.iter().sum::<f64>() / n;
        let deviation = measured
            .iter()
            .map(|x| (x - measured_mean).abs())
            .sum::<f64>()
            / n;
        let range = peak_to_peak(measured);
        let simulated_range = peak_to_peak(simulated_pa) * 1e-6;
        Self {
            score: ChannelScore {
                gauge: trace.gauge,
                mse_mpa2: mse,
                mse_fixed_offset_mpa2: mean_square(&difference),
                offset_mpa: offset,
                rmse_over_half_range: mse.sqrt() / (0.5 * range),
                relative_error: residual.iter().map(|x| x.abs()).sum::<f64>() / n / deviation,
                peak_to_peak_error: (simulated_range - range) / range,
            },
            residual,
        }
    }
}

fn peak_to_peak(values: &[f64]) -> f64 {
    let highest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let lowest = values.iter().copied().fold(f64::INFINITY, f64::min);
    highest - lowest
}

fn weighted(objective: &Objective, compared: &[Compared]) -> Result<f64, Failure> {
    let mut sum = 0.0;
    for &(gauge, weight) in &objective.gauges {
        let found = compared.iter().find(|c| c.score.gauge == gauge);
        let found = found.ok_or_else(|| {
            let problem = format!("the record has no gauge {gauge}");
            Failure::misconfigured("objective.gauges", problem)
        })?;
        sum += weight * found.score.mse_mpa2;
    }
    Ok(sum)
}

/// Residuals of the objective's gauges, one after the other, scaled such that the squared length of
/// the whole is the objective.
fn residual(objective: &Objective, compared: &[Compared]) -> Vec<f64> {
    let scaled = |(gauge, weight): &(u8, f64)| {
        let found = compared.iter().find(|c| c.score.gauge == *gauge)?;
        let scale = (weight / found.residual.len() as f64).sqrt();
        Some(found.residual.iter().map(move |r| scale * r))
    };
    objective
        .gauges
        .iter()
        .filter_map(scaled)
        .flatten()
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scores_follow_their_definitions() {
        let trace = GaugeTrace {
            gauge: 3,
            mean_mpa: vec![1.0, 3.0, 5.0, 3.0],
            spread_mpa: vec![0.0; 4],
        };
        let simulated = [0.0, 1e6, 6e6, 1e6];
        let free = Compared::new(&trace, &simulated, Offset::Free).score;
        // differences 1, 2, -1, 2: mean 1
        assert!((free.offset_mpa - 1.0).abs() < 1e-15);
        assert!((free.mse_mpa2 - 1.5).abs() < 1e-15);
        assert!((free.mse_fixed_offset_mpa2 - 2.5).abs() < 1e-15);
        assert!((free.rmse_over_half_range - 1.5_f64.sqrt() / 2.0).abs() < 1e-15);
        assert!((free.relative_error - 1.0).abs() < 1e-15);
        assert!((free.peak_to_peak_error - 0.5).abs() < 1e-15);
        let fixed = Compared::new(&trace, &simulated, Offset::Fixed).score;
        assert!((fixed.mse_mpa2 - 2.5).abs() < 1e-15);
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
