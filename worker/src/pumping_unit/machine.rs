//! Construction of the machine to simulate from a case and one of its conditions.
use super::{effect, head::head, twins};
use protocol::{
    case::{EffectSetting, merged},
    job::{Failure, Individual},
    pumping_unit::{self, PumpingUnit, RopeEnds, Smoothing, TurnSense, WorkingCondition},
};
use simulation::model::Machine;
use simulation::model::description::{Arc, Crank, Description, Rod, Rope};

/// Builds the machine of a case under one of its conditions, with the case's effects at their stated values.
///
/// # Errors
/// [`Failure::Misconfigured`] naming the field that cannot be built.
pub fn machine(unit: &PumpingUnit, condition: usize) -> Result<Machine, Failure> {
    build(unit, condition, &unit.case.effects)
}

/// Builds the machine of an individual: the case's effects take the values of the searched unknowns (genes),
/// and effects of the job replace effects of the case with the same id.
///
/// # Errors
/// As [`machine`]; an effect that is refused is named by its position in the merged list.
pub fn machine_with(unit: &PumpingUnit, individual: &Individual) -> Result<Machine, Failure> {
    let own = effect::of_individual(&unit.case, &individual.genes)?;
    build(
        unit,
        individual.condition,
        &merged(&own, &individual.effects),
    )
}

fn build(
    unit: &PumpingUnit,
    condition: usize,
    effects: &[EffectSetting],
) -> Result<Machine, Failure> {
    effect::check_units(&unit.case.effects, &unit.case.effect_units)?;
    let selection = effect::selection(effects)?;
    let condition = unit
        .machine
        .conditions
        .get(condition)
        .ok_or_else(|| no_condition(condition))?;
    let modes = unit.machine.run.modes;
    Machine::with_effects(
        description(&unit.machine, condition)?,
        modes,
        selection.effects(),
    )
    .map_err(|error| Failure::misconfigured("machine", error.to_string()))
}

/// Returns the failure for a condition that the case does not have.
pub(crate) fn no_condition(condition: usize) -> Failure {
    Failure::misconfigured("conditions", format!("has no entry {condition}"))
}

pub(super) fn description(
    machine: &pumping_unit::Machine,
    condition: &WorkingCondition,
) -> Result<Description, Failure> {
    let back = &machine.back_head;
    Ok(Description {
        gravity: machine.gravity_m_s2,
        beam_inertia: machine.beam.inertia_kg_m2,
        beam_gravity_moment: machine.beam.gravity_moment_n_m,
        beam_gravity_height: machine.beam.gravity_height_moment_n_m,
        crank: Crank {
            center: [machine.crank.center_x_m, machine.crank.center_y_m],
            radius: machine.crank.radius_m,
            sense: match machine.crank.sense {
                TurnSense::Clockwise => -1.0,
                TurnSense::CounterClockwise => 1.0,
            },
            speed: condition.speed_rpm * std::f64::consts::TAU / 60.0,
            counterweight_moment: condition.counterweight_moment_n_m,
            counterweight_phase: machine.crank.counterweight_phase_deg.to_radians(),
        },
        rod: Rod {
            length: machine.rod.length_m,
            mass: machine.rod.mass_kg,
            center_of_mass: machine.rod.center_of_mass_m,
            inertia: machine.rod.inertia_kg_m2,
        },
        suspension_mass: machine.suspension.mass_kg,
        rope: Rope {
            diameter: machine.ropes.diameter_m,
            pitch: machine.ropes.cylinder_length_m,
            density: machine.ropes.density_kg_m3,
            reference_pitch: machine.ropes.reference_length_m,
            end_pitches: match machine.ropes.ends {
                RopeEnds::HalfPitch => 0.5,
                RopeEnds::WholePitch => 1.0,
            },
            back: machine.ropes.back_cylinders,
            front: machine.ropes.front_cylinders,
        },
        front_arc: Arc {
            center: [0.0, 0.0],
            radius: machine.front_head.radius_m,
            anchor: machine.front_head.rope_anchor_deg.to_radians(),
            sense: 1.0,
        },
        back_arc: Arc {
            center: [back.center_x_m, back.center_y_m],
            radius: back.radius_m,
            anchor: back.rope_anchor_deg.to_radians(),
            sense: -1.0,
        },
        head: head(machine)?,
        twins: twins::twins(machine)?,
        card: card(condition),
    })
}

/// Returns a condition's load card after smoothing \[N\].
fn card(condition: &WorkingCondition) -> Vec<f64> {
    let load = &condition.card.load_n;
    let n = load.len();
    match condition.card.smoothing {
        Smoothing::None => load.clone(),
        Smoothing::Harmonics(kept) => simulation::math::harmonics::low_pass(load, kept),
        Smoothing::MovingAverageDeg(width) => {
            let reach = (0.5 * width / 360.0 * n as f64).round();
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a width between 0 and 360 degrees was checked with the case"
            )]
            let reach = (reach as usize).min(n / 2);
            (0..n)
                .map(|i| {
                    let window = (0..=2 * reach).map(|k| load[(i + n + k - reach) % n]);
                    window.sum::<f64>() / (2 * reach + 1) as f64
                })
                .collect()
        }
    }
}
