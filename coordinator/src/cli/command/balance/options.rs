//! Options of `horsehead balance`, checked against the case: rating, goal, and the counterweights that are possible.
use super::torque::{Bounds, Counterweight, Goal};
use crate::cli::argument::hours::{HoursChoice, Operation};
use clap::{Args, ValueEnum};
use protocol::{case::Case, pumping_unit::Machine};
use std::ops::RangeInclusive;
use support::Problem;

/// Options of the balance.
#[derive(Clone, Debug, Args)]
pub(super) struct BalanceOptions {
    #[command(flatten)]
    hours: HoursChoice,
    /// What the counterweight is to lower.
    #[arg(long, value_enum, default_value = "rms", env = "HORSEHEAD_GOAL")]
    goal: GoalChoice,
    /// Rated torque of the reducer at the crank shaft [N.m]; `crank.reducer_rating_n_m` of the case by default.
    #[arg(long, value_name = "N.M", env = "HORSEHEAD_RATING")]
    rating: Option<f64>,
    /// Counterweight moments that are possible [N.m]; those of `crank.counterweights` of the case by default, else up to
    /// twice the present.
    #[arg(long, value_name = "LOW..HIGH", env = "HORSEHEAD_MOMENT", value_parser = range)]
    moment: Option<RangeInclusive<f64>>,
    /// Difference of moment between two positions of the weights [N.m]; weights can be anywhere by default.
    #[arg(long, value_name = "N.M", env = "HORSEHEAD_STEP")]
    step: Option<f64>,
    /// Phases of the counterweight that are possible, ahead of the crank pin [deg]; the present one by default.
    #[arg(
        long,
        value_name = "LOW..HIGH",
        env = "HORSEHEAD_PHASE",
        allow_hyphen_values = true,
        value_parser = range
    )]
    phase: Option<RangeInclusive<f64>>,
}

/// What the counterweight is to lower.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum GoalChoice {
    /// Root mean square of the torque: the losses of the motor.
    Rms,
    /// Largest magnitude of the torque: the load of the gears.
    Peak,
}

/// Parses a range of numbers, as `90e3..120e3`.
fn range(typed: &str) -> Result<RangeInclusive<f64>, String> {
    let ends = typed.split_once("..").and_then(|(low, high)| {
        let number = |text: &str| text.trim().parse::<f64>().ok().filter(|x| x.is_finite());
        Some((number(low)?, number(high)?))
    });
    match ends {
        Some((low, high)) if low <= high => Ok(low..=high),
        Some(_) => Err("the first number is the larger one".to_owned()),
        None => Err("write two numbers, as in 90e3..120e3".to_owned()),
    }
}

/// Checked options of a balance.
#[derive(Clone, Debug)]
pub(super) struct BalancePlan {
    pub(super) operations: Vec<Operation>,
    pub(super) goal: Goal,
    pub(super) bounds: Bounds,
    /// Rated torque of the reducer [N m]; `None` where it is not known.
    pub(super) rating_n_m: Option<f64>,
    /// Present counterweight under each condition of the operation.
    pub(super) present: Vec<Counterweight>,
}

impl BalanceOptions {
    /// Checks the options against a case and its machine.
    ///
    /// # Errors
    /// If a number is none, or the present counterweight lies outside of the bounds.
    pub(super) fn plan(&self, case: &Case, machine: &Machine) -> Result<BalancePlan, Problem> {
        let operations = self
            .hours
            .operations(case, |k| machine.conditions[k].speed_rpm)?;
        for (option, value) in [("--rating", self.rating), ("--step", self.step)] {
            if value.is_some_and(|value| !(value.is_finite() && value > 0.0)) {
                return Err(Problem {
                    message: format!("{option} is {}", value.unwrap_or_default()),
                    remedy: "give a positive torque in N.m".to_owned(),
                });
            }
        }
        let crank = &machine.crank;
        let present: Vec<Counterweight> = operations
            .iter()
            .map(|own| Counterweight {
                moment_n_m: machine.conditions[own.condition].counterweight_moment_n_m,
                phase_deg: crank.counterweight_phase_deg,
            })
            .collect();
        let most = present
            .iter()
            .fold(0.0_f64, |most, own| most.max(own.moment_n_m));
        let (moment_n_m, source) = match (&self.moment, &crank.counterweights) {
            (Some(stated), _) => (stated.clone(), "--moment"),
            (None, Some(weights)) => {
                let weight = f64::from(weights.count) * weights.mass_kg * machine.gravity_m_s2;
                let at = |radius: f64| weights.crank_moment_n_m + weight * radius;
                let both = at(weights.nearest_m)..=at(weights.farthest_m);
                (both, "crank.counterweights of case.toml")
            }
            (None, None) => (0.0..=2.0 * most, "the default"),
        };
        if *moment_n_m.end() <= 0.0 {
            return Err(Problem {
                message: "the case has no counterweight, `counterweight_moment_n_m` is 0"
                    .to_owned(),
                remedy: "say which moments are possible, as in --moment 0..120e3".to_owned(),
            });
        }
        if *moment_n_m.start() < 0.0 {
            return Err(Problem {
                message: format!("--moment begins at {} N.m", moment_n_m.start()),
                remedy: "give moments from 0 on; a counterweight on the pin's side has a phase of 180 deg"
                    .to_owned(),
            });
        }
        let phase = crank.counterweight_phase_deg;
        let phase_deg = self.phase.clone().unwrap_or(phase..=phase);
        for (operation, own) in operations.iter().zip(&present) {
            if !moment_n_m.contains(&own.moment_n_m) {
                return Err(outside(
                    &format!(
                        "counterweight_moment_n_m = {} of {}",
                        own.moment_n_m, operation.name
                    ),
                    source,
                    &moment_n_m,
                    "N.m",
                ));
            }
        }
        if !phase_deg.contains(&phase) {
            let stated = format!("crank.counterweight_phase_deg = {phase}");
            return Err(outside(&stated, "--phase", &phase_deg, "deg"));
        }
        Ok(BalancePlan {
            goal: match self.goal {
                GoalChoice::Rms => Goal::RootMeanSquare,
                GoalChoice::Peak => Goal::Peak,
            },
            bounds: Bounds {
                moment_n_m,
                phase_deg,
                step_n_m: self.step,
            },
            rating_n_m: self.rating.or(crank.reducer_rating_n_m),
            operations,
            present,
        })
    }
}

/// Returns the error for a present counterweight that lies outside of what is called possible.
fn outside(stated: &str, source: &str, bounds: &RangeInclusive<f64>, unit: &str) -> Problem {
    Problem {
        message: format!(
            "the present counterweight, {stated}, is not among those that {source} calls possible: {} to {} {unit}",
            bounds.start(),
            bounds.end()
        ),
        remedy: "the machine runs with it, so that one of both is wrong: correct the case, or widen the bounds"
            .to_owned(),
    }
}
