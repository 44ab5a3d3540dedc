//! The object of `horsehead simulate`.
use super::score::{GeneOutput, ScoreOutput, channels, genes, objective};
use crate::study::{Curves, simulation_digest};
use protocol::{
    case::Case,
    job::{Counters, Reached, Verdict, Word},
    pumping_unit::{Energy, Simulation},
};
use serde::Serialize;
use std::collections::BTreeMap;

/// Of `horsehead simulate`.
#[derive(Debug, Serialize)]
pub(crate) struct SimulateOutput<'a> {
    /// Name of the machine.
    pub(crate) case: &'a str,
    /// Name of the condition.
    pub(crate) condition: &'a str,
    /// `"complete"`, or what happened and how far it got.
    pub(crate) verdict: VerdictOutput,
    /// Time on the worker (s).
    pub(crate) wall_s: f64,
    /// Work that was done.
    pub(crate) counters: Counters,
    /// Gene values by name.
    pub(crate) genes: BTreeMap<String, GeneOutput>,
    /// Objective, in the square of the unit that its channels share; null without a record or a complete run.
    pub(crate) objective: Option<f64>,
    /// Agreement by gauge number; empty without a record.
    pub(crate) channels: BTreeMap<String, ScoreOutput>,
    /// Crank angle from bottom dead centre (deg).
    pub(crate) crank_deg: &'a [f64],
    /// Stress by gauge number `MPa`.
    pub(crate) gauge_mpa: BTreeMap<String, &'a [f64]>,
    /// Tension of the back rope at the crossbeam (N).
    pub(crate) rope_tension_n: &'a [f64],
    /// Tension of the front rope at the suspension (N).
    pub(crate) front_rope_tension_n: &'a [f64],
    /// By how much of twin ropes the one at +z pulls more (N); absent where there is one rope.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) twin_tension_difference_n: Option<TwinTensionOutput<'a>>,
    /// Beam angle (deg).
    pub(crate) beam_deg: &'a [f64],
    /// Suspension height above its lowest design position (m).
    pub(crate) suspension_m: &'a [f64],
    /// Net torque at the crank shaft (N m).
    pub(crate) crank_torque_nm: &'a [f64],
    /// Energy of the revolution; null unless it was completed.
    pub(crate) energy: Option<Energy>,
    /// Hash of all result bits.
    pub(crate) digest: String,
}

/// A difference of tensions over the revolution (N).
#[derive(Debug, Serialize)]
pub(crate) struct TwinTensionOutput<'a> {
    back: &'a [f64],
    front: &'a [f64],
}

/// How a simulation ended.
#[derive(Debug, Serialize)]
#[serde(untagged)]
pub(crate) enum VerdictOutput {
    /// `"complete"`.
    Complete(&'static str),
    /// It failed while the static load was applied.
    Settling {
        /// What happened.
        kind: Word,
        /// Share of the load that was applied.
        load_fraction: f64,
    },
    /// It failed in motion.
    Moving {
        /// What happened.
        kind: Word,
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
                kind,
                load_fraction,
            },
            Verdict::Failed {
                kind,
                reached: Reached::TimeFraction(time_fraction),
            } => Self::Moving {
                kind,
                time_fraction,
            },
        }
    }
}

/// Everything about one simulation.
pub(crate) fn simulation<'a>(
    (case, condition): (&'a Case, usize),
    curves: &'a Curves,
    simulation: &'a Simulation,
) -> SimulateOutput<'a> {
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
        counters: simulation.counters,
        genes: genes(case, &curves.genes),
        objective: objective(curves.evaluation.as_ref()),
        channels: channels(case, curves.evaluation.as_ref()),
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
        energy: (simulation.verdict == Verdict::Complete).then_some(simulation.energy),
        digest: simulation_digest(simulation),
    }
}
