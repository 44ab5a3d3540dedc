//! From a case, as it travels, to a machine as the dynamics take it, and back: the only file that
//! names both vocabularies. Degrees become radians and megapascals pascals here.
pub mod effect;
mod refinement;
mod twins;

pub use refinement::refined;

use protocol::case::{
    Case, Coefficient, Condition, EffectSetting, Integrator, Quantity, RopeEnds, Smoothing,
    StressRecovery, TurnSense, WeightAxes, merged,
};
use protocol::job::{self, Counters, Failure};
use simulation::element::{bushing::Bushing, impact::Impact};
use simulation::integrator::method::Method;
use simulation::integrator::tableau::{ESDIRK4, TR_BDF2};
use simulation::model::description::{Arc, Crank, Description, Head, Rod, Rope, RopeLaw};
use simulation::model::{Machine, description};
use simulation::run::RunSettings;
use simulation::statistics::Statistics;
use simulation::verdict;

const PASCAL_PER_MEGAPASCAL: f64 = 1e6;

/// The machine of a case under one of its conditions, with the case's effects as they are stated.
///
/// # Errors
/// [`Failure::Misconfigured`] naming the field that cannot be built.
pub fn machine(case: &Case, condition: usize) -> Result<Machine, Failure> {
    build(case, condition, &case.effects)
}

/// The machine of an individual: the case's effects have the values that its genes give them, and a
/// job's own replace those of the case that have their names.
///
/// # Errors
/// As [`machine`]; an effect that is refused is named by its place in the merged list.
pub fn machine_with(
    case: &Case,
    condition: usize,
    (genes, effects): (&[f64], &[EffectSetting]),
) -> Result<Machine, Failure> {
    let own = effect::of_individual(case, genes)?;
    build(case, condition, &merged(&own, effects))
}

fn build(case: &Case, condition: usize, effects: &[EffectSetting]) -> Result<Machine, Failure> {
    effect::check_units(&case.effects, &case.effect_units)?;
    let selection = effect::selection(effects)?;
    let condition = case
        .conditions
        .get(condition)
        .ok_or_else(|| no_condition(condition))?;
    let modes = case.run.modes;
    Machine::with_effects(description(case, condition)?, modes, &selection)
        .map_err(|error| misconfigured("machine", error.to_string()))
}

/// A condition that the case does not have.
pub(crate) fn no_condition(condition: usize) -> Failure {
    misconfigured("conditions", format!("has no entry {condition}"))
}

pub(crate) fn misconfigured(field: &str, problem: String) -> Failure {
    Failure::Misconfigured {
        field: field.to_owned(),
        problem,
    }
}

fn description(case: &Case, condition: &Condition) -> Result<Description, Failure> {
    let back = &case.back_head;
    Ok(Description {
        gravity: case.gravity_m_s2,
        beam_inertia: case.beam.inertia_kg_m2,
        beam_gravity_moment: case.beam.gravity_moment_n_m,
        crank: Crank {
            center: [case.crank.center_x_m, case.crank.center_y_m],
            radius: case.crank.radius_m,
            sense: match case.crank.sense {
                TurnSense::Clockwise => -1.0,
                TurnSense::CounterClockwise => 1.0,
            },
            speed: condition.speed_rpm * std::f64::consts::TAU / 60.0,
            counterweight_moment: condition.counterweight_moment_n_m,
            counterweight_phase: case.crank.counterweight_phase_deg.to_radians(),
        },
        rod: Rod {
            length: case.rod.length_m,
            mass: case.rod.mass_kg,
            center_of_mass: case.rod.center_of_mass_m,
            inertia: case.rod.inertia_kg_m2,
        },
        suspension_mass: case.suspension.mass_kg,
        rope: Rope {
            diameter: case.ropes.diameter_m,
            pitch: case.ropes.cylinder_length_m,
            density: case.ropes.density_kg_m3,
            reference_pitch: case.ropes.reference_length_m,
            end_pitches: match case.ropes.ends {
                RopeEnds::HalfPitch => 0.5,
                RopeEnds::WholePitch => 1.0,
            },
            back: case.ropes.back_cylinders,
            front: case.ropes.front_cylinders,
        },
        front_arc: Arc {
            center: [0.0, 0.0],
            radius: case.front_head.radius_m,
            anchor: case.front_head.rope_anchor_deg.to_radians(),
            sense: 1.0,
        },
        back_arc: Arc {
            center: [back.center_x_m, back.center_y_m],
            radius: back.radius_m,
            anchor: back.rope_anchor_deg.to_radians(),
            sense: -1.0,
        },
        head: head(case)?,
        twins: twins::twins(case)?,
        card: card(condition),
    })
}

fn head(case: &Case) -> Result<Head, Failure> {
    let head = &case.modal_head;
    let (start, step) = grid("modal_head.arc_deg", &head.arc_deg)?;
    let (influence_start, influence_step) = grid("influence.psi_deg", &head.influence.psi_deg)?;
    let base_stress = head
        .inertia_stress_mpa
        .map(|row| row.map(|s| s * PASCAL_PER_MEGAPASCAL));
    Ok(Head {
        frequencies: head
            .frequencies_hz
            .iter()
            .map(|f| f * std::f64::consts::TAU)
            .collect(),
        damping_ratio: head.damping_ratio,
        recovery: match head.stress {
            StressRecovery::ModeAcceleration => description::StressRecovery::ModeAcceleration,
            StressRecovery::ModeDisplacement => description::StressRecovery::ModeDisplacement,
        },
        start,
        step,
        radial: head.radial.clone(),
        tangential: head.tangential.clone(),
        gauge_stress: head
            .gauge_stress_mpa
            .iter()
            .map(|row| row.map(|s| s * PASCAL_PER_MEGAPASCAL))
            .collect(),
        participation: head.participation.clone(),
        weight_stress: match head.weight_axes {
            WeightAxes::Physical => [base_stress[0], base_stress[1]],
            WeightAxes::Exchanged => [base_stress[1], base_stress[0]],
        },
        turning_stress: base_stress[2],
        influence_start,
        influence_step,
        normal_influence: curves(&head.influence.normal_mpa_per_n),
        tangential_influence: curves(&head.influence.tangential_mpa_per_n),
    })
}

/// Influence lines gauge by gauge [Pa/N].
fn curves(rows: &[[f64; 4]]) -> Vec<Vec<f64>> {
    let line = |gauge: usize| {
        rows.iter()
            .map(move |row| row[gauge] * PASCAL_PER_MEGAPASCAL)
    };
    (0..4).map(|gauge| line(gauge).collect()).collect()
}

/// Start and spacing \[rad\] of a table that must be equally spaced.
fn grid(field: &str, degrees: &[f64]) -> Result<(f64, f64), Failure> {
    let [first, second, ..] = degrees else {
        return Err(misconfigured(
            field,
            "needs at least two stations".to_owned(),
        ));
    };
    let step = second - first;
    let even = degrees
        .iter()
        .enumerate()
        .all(|(i, x)| (x - first - step * i as f64).abs() < 1e-6 * step.abs());
    if !(even && step > 0.0) {
        return Err(misconfigured(
            field,
            "must ascend in equal steps; resample the table".to_owned(),
        ));
    }
    Ok((first.to_radians(), step.to_radians()))
}

/// The load card after smoothing \[N\].
fn card(condition: &Condition) -> Vec<f64> {
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

/// The genes of a case with the values of an individual.
///
/// # Errors
/// [`Failure::Misconfigured`] when there are fewer or more values than genes.
fn individual<'a>(
    case: &'a Case,
    genes: &'a [f64],
) -> Result<impl Iterator<Item = (&'a Quantity, f64)> + Clone, Failure> {
    if genes.len() != case.genes.len() {
        return Err(misconfigured(
            "genes",
            format!("{} values for {} genes", genes.len(), case.genes.len()),
        ));
    }
    let quantities = case.genes.iter().map(|gene| &gene.quantity);
    Ok(quantities.zip(genes.iter().copied()))
}

/// The rope law of a gene vector in declared units.
///
/// # Errors
/// [`Failure::Misconfigured`] when a gene is missing, surplus or not a positive number.
pub fn rope_law(case: &Case, genes: &[f64]) -> Result<RopeLaw, Failure> {
    let genes = individual(case, genes)?;
    let value = |name: Coefficient| -> Result<f64, Failure> {
        let found = genes.clone().find_map(|(quantity, value)| match quantity {
            Quantity::Coefficient { name: own, unit } if *own == name => Some((*unit, value)),
            Quantity::Coefficient { .. } | Quantity::Effect { .. } => None,
        });
        match found {
            Some((unit, value)) if value > 0.0 && value.is_finite() => Ok(unit.to_si(value)),
            Some((_, value)) => Err(misconfigured(
                name.as_str(),
                format!("is {value}; it must be a positive number"),
            )),
            None => Err(misconfigured(name.as_str(), "is missing".to_owned())),
        }
    };
    Ok(RopeLaw {
        bushing: Bushing {
            stiffness: [value(Coefficient::Kb1)?, value(Coefficient::Kb23)?],
            damping: [value(Coefficient::Cb1)?, value(Coefficient::Cb23)?],
            rotational_stiffness: [value(Coefficient::Kb4)?, value(Coefficient::Kb56)?],
            rotational_damping: [value(Coefficient::Cb4)?, value(Coefficient::Cb56)?],
            preload: case.ropes.preload_n,
        },
        contact: Impact {
            stiffness: value(Coefficient::Kc)?,
            exponent: case.contact.exponent,
            damping: value(Coefficient::Cc)?,
            full_damping_penetration: case.contact.full_damping_penetration_m,
        },
    })
}

/// How a case wants its runs.
pub fn run_settings(case: &Case) -> RunSettings {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the case check lets only steps through that divide 360"
    )]
    let samples = (360.0 / case.run.output_step_deg).round() as usize;
    RunSettings {
        lead_in: case.run.lead_in_deg.to_radians(),
        ramp: case.run.ramp_s,
        samples,
        tolerance: case.run.tolerance,
        method: method(case.run.integrator, case.run.spectral_radius),
        longest_step: case.run.longest_step_s,
        ..RunSettings::default()
    }
}

/// The same with another integration, if there is one.
pub fn overridden(case: &Case, integration: Option<&job::Integration>) -> RunSettings {
    let settings = run_settings(case);
    let Some(other) = integration else {
        return settings;
    };
    RunSettings {
        method: method(other.integrator, case.run.spectral_radius),
        longest_step: other.longest_step_s,
        // a step that was asked for is taken as it is
        slow_swing: f64::INFINITY,
        tolerance: other.tolerance,
        budget: other.budget.unwrap_or(settings.budget),
        ..settings
    }
}

fn method(integrator: Integrator, spectral_radius: f64) -> Method {
    match integrator {
        Integrator::TrBdf2 => (&TR_BDF2).into(),
        Integrator::Esdirk4 => (&ESDIRK4).into(),
        Integrator::Rodas4 => Method::Rosenbrock,
        Integrator::GeneralizedAlpha => Method::GeneralizedAlpha { spectral_radius },
        Integrator::Bdf => Method::Bdf { highest: 2 },
        Integrator::Bdf5 => Method::Bdf { highest: 5 },
    }
}

/// A verdict as it travels.
pub const fn verdict(verdict: &verdict::Verdict) -> job::Verdict {
    match verdict {
        verdict::Verdict::Complete => job::Verdict::Complete,
        verdict::Verdict::Failed { kind, reached } => job::Verdict::Failed {
            kind: match kind {
                verdict::Failure::OverstretchedRope => job::PhysicsFailure::OverstretchedRope,
                verdict::Failure::RopeThroughHead => job::PhysicsFailure::RopeThroughHead,
                verdict::Failure::BeamOvertravel => job::PhysicsFailure::BeamOvertravel,
                verdict::Failure::LoadNotLifted => job::PhysicsFailure::LoadNotLifted,
                verdict::Failure::TumbledCylinder => job::PhysicsFailure::TumbledCylinder,
                verdict::Failure::StepUnderflow => job::PhysicsFailure::StepUnderflow,
                verdict::Failure::Budget => job::PhysicsFailure::Budget,
            },
            reached: match reached {
                verdict::Reached::LoadFraction(x) => job::Reached::LoadFraction(*x),
                verdict::Reached::TimeFraction(x) => job::Reached::TimeFraction(*x),
            },
        },
    }
}

/// Counters as they travel.
pub const fn counters(statistics: &Statistics) -> Counters {
    Counters {
        steps: statistics.steps,
        rejected_steps: statistics.error_rejections + statistics.newton_rejections,
        newton_iterations: statistics.newton_iterations,
        jacobians: statistics.jacobians,
        factorizations: statistics.factorizations,
    }
}
