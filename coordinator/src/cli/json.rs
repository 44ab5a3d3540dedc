//! What `--output json` prints: exactly one object per command. The fields are a contract with
//! other programs; more may be added, none renamed. Numbers that are not finite become `null`.
use crate::study::{Curves, HeadComparison, simulation_digest};
use protocol::{
    case::Case,
    job::{Evaluation, LeftOutMode, ModeFamily, Reached, ReducedHead, Simulation, Verdict},
};
use serde::Serialize;
use std::collections::BTreeMap;

/// Of `horsehead simulate`.
#[derive(Debug, Serialize)]
pub(super) struct SimulateOutput<'a> {
    /// Name of the machine.
    pub(super) case: &'a str,
    /// Name of the condition.
    pub(super) condition: &'a str,
    /// `"complete"`, or what happened and how far it got.
    pub(super) verdict: VerdictOutput,
    /// Time on the worker (s).
    pub(super) wall_s: f64,
    /// Work that was done.
    pub(super) counters: CountersOutput,
    /// Gene values by name.
    pub(super) genes: BTreeMap<String, GeneOutput>,
    /// Objective `MPa^2`; null without a record or a complete run.
    pub(super) objective: Option<f64>,
    /// Agreement by gauge number; empty without a record.
    pub(super) channels: BTreeMap<String, ChannelOutput>,
    /// Crank angle from bottom dead centre (deg).
    pub(super) crank_deg: &'a [f64],
    /// Stress by gauge number `MPa`.
    pub(super) gauge_mpa: BTreeMap<String, &'a [f64]>,
    /// Tension of the back rope at the crossbeam (N).
    pub(super) rope_tension_n: &'a [f64],
    /// Tension of the front rope at the suspension (N).
    pub(super) front_rope_tension_n: &'a [f64],
    /// By how much of twin ropes the one at +z pulls more (N); absent where there is one rope.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) twin_tension_difference_n: Option<TwinTensionOutput<'a>>,
    /// Beam angle (deg).
    pub(super) beam_deg: &'a [f64],
    /// Suspension height above its lowest design position (m).
    pub(super) suspension_m: &'a [f64],
    /// Net torque at the crank shaft (N m).
    pub(super) crank_torque_nm: &'a [f64],
    /// Energy of the revolution; null unless it was completed.
    pub(super) energy: Option<EnergyOutput>,
    /// Hash of all result bits.
    pub(super) digest: String,
}

/// A difference of tensions over the revolution (N).
#[derive(Debug, Serialize)]
pub(super) struct TwinTensionOutput<'a> {
    back: &'a [f64],
    front: &'a [f64],
}

/// How a simulation ended.
#[derive(Debug, Serialize)]
#[serde(untagged)]
pub(super) enum VerdictOutput {
    /// `"complete"`.
    Complete(&'static str),
    /// It failed while the static load was applied.
    Settling {
        /// What happened.
        kind: &'static str,
        /// Share of the load that was applied.
        load_fraction: f64,
    },
    /// It failed in motion.
    Moving {
        /// What happened.
        kind: &'static str,
        /// Share of the simulated time that was reached.
        time_fraction: f64,
    },
}

impl From<Verdict> for VerdictOutput {
    fn from(verdict: Verdict) -> Self {
        match verdict {
            Verdict::Complete => Self::Complete("complete"),
            Verdict::Failed {
                kind,
                reached: Reached::LoadFraction(load_fraction),
            } => Self::Settling {
                kind: kind.as_str(),
                load_fraction,
            },
            Verdict::Failed {
                kind,
                reached: Reached::TimeFraction(time_fraction),
            } => Self::Moving {
                kind: kind.as_str(),
                time_fraction,
            },
        }
    }
}

/// Work counters.
#[derive(Debug, Serialize)]
pub(super) struct CountersOutput {
    steps: u64,
    rejected_steps: u64,
    newton_iterations: u64,
    jacobians: u64,
    factorizations: u64,
}

/// Energy over the recorded revolution (J).
#[derive(Debug, Serialize)]
pub(super) struct EnergyOutput {
    input_j: f64,
    output_j: f64,
    dissipated_j: f64,
    stored_j: f64,
    relative_error: f64,
}

/// A gene with its interval, in its declared unit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct GeneOutput {
    value: f64,
    unit: String,
    recommended: f64,
    lower: f64,
    upper: f64,
}

/// Agreement of one gauge.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct ChannelOutput {
    mse_mpa2: f64,
    relative_error: f64,
    rmse_over_half_range: f64,
    mse_fixed_offset_mpa2: f64,
    offset_mpa: f64,
    peak_to_peak_error: f64,
}

/// Of `horsehead head`.
#[derive(Debug, Serialize)]
pub(super) struct HeadOutput<'a> {
    case: &'a str,
    /// Condition of the quasi-static turn.
    condition: &'a str,
    /// Content of the mesh file.
    mesh_blake3: &'a str,
    /// Time on the worker (s).
    wall_s: f64,
    /// Unknown displacements of the half that was solved.
    unknowns: usize,
    lanczos_steps: usize,
    mass_kg: f64,
    modes: Vec<HeadModeOutput>,
    /// Modes out of the plane (Hz); absent where there is one rope.
    #[serde(skip_serializing_if = "Option::is_none")]
    twin_modes_hz: Option<&'a [f64]>,
    /// Modes that couple less to the loads of a turn; empty where they were not asked for.
    left_out: &'a [LeftOutMode],
    /// Modes of the case's table that do not move the rope surface (Hz).
    inert_table_modes_hz: &'a [f64],
    /// By gauge number.
    gauges: BTreeMap<String, HeadGaugeOutput>,
}

/// A mode; the table's are null where it has none like it.
#[derive(Debug, Serialize)]
pub(super) struct HeadModeOutput {
    family: ModeFamily,
    frequency_hz: f64,
    table_frequency_hz: Option<f64>,
    mac: Option<f64>,
    /// Largest share of any load pattern's static energy; null where they were not asked for.
    coupling: Option<f64>,
}

/// Statics of a gauge over the quasi-static turn.
#[derive(Debug, Serialize)]
pub(super) struct HeadGaugeOutput {
    exact_half_range_mpa: f64,
    table_half_range_mpa: f64,
    mode_displacement_half_range_mpa: f64,
    mode_displacement_offset_mpa: f64,
    influence_difference: f64,
}

/// Gathers what `horsehead head` prints.
pub(super) fn head<'a>(
    (case, condition): (&'a Case, &'a str),
    mesh_blake3: &'a str,
    head: &'a ReducedHead,
    comparison: &'a HeadComparison,
) -> HeadOutput<'a> {
    let ranges = &comparison.half_ranges;
    let modes = head.modes.iter().zip(&comparison.modes);
    HeadOutput {
        case: &case.name,
        condition,
        mesh_blake3,
        wall_s: head.wall_s,
        unknowns: head.unknowns,
        lanczos_steps: head.lanczos_steps,
        mass_kg: head.mass_kg,
        modes: modes
            .map(|(mode, found)| HeadModeOutput {
                family: mode.family,
                frequency_hz: mode.frequency_hz,
                table_frequency_hz: found.table.map(|(hz, _)| hz),
                mac: found.table.map(|(_, mac)| mac),
                coupling: head.coupled().then_some(mode.coupling),
            })
            .collect(),
        twin_modes_hz: head.twin.as_ref().map(|twin| &twin.frequencies_hz[..]),
        left_out: &head.left_out,
        inert_table_modes_hz: &comparison.inert_hz,
        gauges: (0..4)
            .map(|gauge| {
                let output = HeadGaugeOutput {
                    exact_half_range_mpa: ranges.exact[gauge],
                    table_half_range_mpa: ranges.table[gauge],
                    mode_displacement_half_range_mpa: ranges.displacement[gauge],
                    mode_displacement_offset_mpa: ranges.displacement_offset[gauge],
                    influence_difference: comparison.influence_difference[gauge],
                };
                ((gauge + 1).to_string(), output)
            })
            .collect(),
    }
}

/// Of `horsehead calibrate`, and kept as `result.json` in the run folder.
#[derive(Debug, Serialize)]
pub(super) struct CalibrateOutput<'a> {
    /// The run folder.
    pub(super) run: String,
    /// Name of the machine.
    pub(super) case: &'a str,
    /// The preset.
    pub(super) preset: &'a str,
    /// The seed.
    pub(super) seed: u64,
    /// How many individuals were evaluated.
    pub(super) evaluations: usize,
    /// How many of them did not complete.
    pub(super) failed_simulations: usize,
    /// Wall time over all sessions (s).
    pub(super) wall_s: f64,
    /// The identified parameters by name.
    pub(super) genes: BTreeMap<String, GeneOutput>,
    /// Objective of both parameter sets `MPa^2`.
    pub(super) objective: Both<Option<f64>>,
    /// Agreement by gauge number, of both parameter sets, at the calibrated condition.
    pub(super) channels: BTreeMap<String, Both<Option<ChannelOutput>>>,
    /// Other conditions with a record, by name.
    pub(super) other_conditions: BTreeMap<String, ConditionOutput>,
    /// Hash of the evaluation log in index order.
    pub(super) log_digest: String,
    /// Files that were written.
    pub(super) files: Vec<String>,
}

/// Of `horsehead verify`.
#[derive(Debug, Serialize)]
pub(super) struct VerifyOutput<'a> {
    /// The run folder.
    pub(super) run: String,
    /// Name of the machine.
    pub(super) case: &'a str,
    /// Name of the condition.
    pub(super) condition: &'a str,
    /// Wall time (s).
    pub(super) wall_s: f64,
    /// Scores of both parameter sets.
    #[serde(flatten)]
    pub(super) scores: ConditionOutput,
}

/// Scores of both parameter sets under one condition.
#[derive(Debug, Serialize)]
pub(super) struct ConditionOutput {
    /// Objective of both parameter sets `MPa^2`.
    pub(super) objective: Both<Option<f64>>,
    /// Agreement by gauge number, of both parameter sets.
    pub(super) channels: BTreeMap<String, Both<Option<ChannelOutput>>>,
}

/// One thing for each parameter set.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Both<T> {
    /// Of the recommended parameters.
    pub(super) recommended: T,
    /// Of the optimised parameters.
    pub(super) optimised: T,
}

/// Of `horsehead bench dispatch`.
#[derive(Debug, Serialize)]
pub(super) struct BenchOutput {
    /// `processes` over TCP on loopback, `connections` of one other process over the same, or
    /// `sessions` of this process over the memory link.
    pub(super) crew: &'static str,
    /// How many of them.
    pub(super) workers: usize,
    /// Time until all of them had joined (s).
    pub(super) joined_s: f64,
    /// Jobs that were done.
    pub(super) jobs: u64,
    /// Round trip of one job at a time (ms).
    pub(super) rtt_ms: RoundTrip,
    /// Throughput with every worker busy.
    pub(super) jobs_per_s: f64,
    /// CPU time of the coordinator per job (us).
    pub(super) coordinator_cpu_us_per_job: f64,
    /// The same for the last tenth of the jobs over the first.
    pub(super) cost_ratio: f64,
    /// Memory of this process (MiB).
    pub(super) coordinator_rss_mib: f64,
    /// What silent connections cost; null where none were asked for.
    pub(super) silent: Option<SilentOutput>,
}

/// Rate and cost beside connections that say nothing, over those without them.
#[derive(Debug, Serialize)]
pub(super) struct SilentOutput {
    /// Connections that were asked for.
    pub(super) connections: usize,
    /// The fewest that the coordinator held when a block began or ended.
    pub(super) held: usize,
    /// How often one that had been closed was opened again.
    pub(super) reopened: u64,
    /// Blocks without, and as many with them.
    pub(super) turns: usize,
    /// Throughput of the median block without them.
    pub(super) jobs_per_s_without: f64,
    /// Throughput of the median block beside them.
    pub(super) jobs_per_s_beside: f64,
    /// Median over the turns of throughput beside them over that without.
    pub(super) rate_ratio: f64,
    /// The smallest and the largest.
    pub(super) rate_ratio_range: [f64; 2],
    /// Median over the turns of the coordinator's CPU time per job beside them over that without.
    pub(super) cpu_ratio: f64,
}

/// Round-trip times (ms).
#[derive(Debug, Serialize)]
pub(super) struct RoundTrip {
    pub(super) median: f64,
    pub(super) p99: f64,
}

/// Genes by name.
pub(super) fn genes(case: &Case, values: &[f64]) -> BTreeMap<String, GeneOutput> {
    let pairs = case.genes.iter().zip(values);
    pairs
        .map(|(gene, &value)| {
            let output = GeneOutput {
                value,
                unit: gene.unit().to_owned(),
                recommended: gene.recommended,
                lower: gene.lower,
                upper: gene.upper,
            };
            (gene.label(), output)
        })
        .collect()
}

/// Agreement by gauge number.
pub(super) fn channels(evaluation: Option<&Evaluation>) -> BTreeMap<String, ChannelOutput> {
    let scores = evaluation.map_or(&[][..], |evaluation| &evaluation.channels);
    scores
        .iter()
        .map(|score| {
            let output = ChannelOutput {
                mse_mpa2: score.mse_mpa2,
                relative_error: score.relative_error,
                rmse_over_half_range: score.rmse_over_half_range,
                mse_fixed_offset_mpa2: score.mse_fixed_offset_mpa2,
                offset_mpa: score.offset_mpa,
                peak_to_peak_error: score.peak_to_peak_error,
            };
            (score.gauge.to_string(), output)
        })
        .collect()
}

/// The objective of a complete run.
pub(super) fn objective(evaluation: Option<&Evaluation>) -> Option<f64> {
    let complete = evaluation.filter(|evaluation| evaluation.verdict == Verdict::Complete)?;
    Some(complete.fitness)
}

/// Scores of both parameter sets, recommended first.
pub(super) fn condition(recommended: &Curves, optimised: &Curves) -> ConditionOutput {
    let (mut before, mut after) = (
        channels(recommended.evaluation.as_ref()),
        channels(optimised.evaluation.as_ref()),
    );
    let gauges: Vec<String> = before.keys().chain(after.keys()).cloned().collect();
    let both = gauges.into_iter().map(|gauge| {
        let scores = Both {
            recommended: before.remove(&gauge),
            optimised: after.remove(&gauge),
        };
        (gauge, scores)
    });
    let mut channels = BTreeMap::new();
    for (gauge, scores) in both {
        channels.entry(gauge).or_insert(scores);
    }
    ConditionOutput {
        objective: Both {
            recommended: objective(recommended.evaluation.as_ref()),
            optimised: objective(optimised.evaluation.as_ref()),
        },
        channels,
    }
}

/// Everything about one simulation.
pub(super) fn simulation<'a>(
    (case, condition): (&'a Case, usize),
    curves: &'a Curves,
) -> SimulateOutput<'a> {
    let simulation: &Simulation = &curves.simulation;
    let (counters, energy) = (simulation.counters, simulation.energy);
    let gauges = (1..).zip(&simulation.gauge_mpa);
    let [back, front] = &simulation.tension_difference_n;
    SimulateOutput {
        case: &case.name,
        condition: case
            .conditions
            .get(condition)
            .map_or("", |condition| &condition.name),
        verdict: simulation.verdict.into(),
        wall_s: simulation.wall_s,
        counters: CountersOutput {
            steps: counters.steps,
            rejected_steps: counters.rejected_steps,
            newton_iterations: counters.newton_iterations,
            jacobians: counters.jacobians,
            factorizations: counters.factorizations,
        },
        genes: genes(case, &curves.genes),
        objective: objective(curves.evaluation.as_ref()),
        channels: channels(curves.evaluation.as_ref()),
        crank_deg: &simulation.turn_deg,
        gauge_mpa: gauges
            .map(|(gauge, curve)| (gauge.to_string(), &curve[..]))
            .collect(),
        rope_tension_n: &simulation.back_rope_tension_n,
        front_rope_tension_n: &simulation.front_rope_tension_n,
        twin_tension_difference_n: (!back.is_empty()).then_some(TwinTensionOutput { back, front }),
        beam_deg: &simulation.beam_deg,
        suspension_m: &simulation.suspension_m,
        crank_torque_nm: &simulation.crank_torque_n_m,
        energy: (simulation.verdict == Verdict::Complete).then_some(EnergyOutput {
            input_j: energy.input_j,
            output_j: energy.output_j,
            dissipated_j: energy.dissipated_j,
            stored_j: energy.stored_j,
            relative_error: energy.relative_error,
        }),
        digest: simulation_digest(simulation),
    }
}

#[cfg(test)]
#[path = "json_tests.rs"]
mod tests;
