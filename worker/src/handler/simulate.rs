//! Simulates an individual and returns every curve that can be drawn.
use crate::convert;
use crate::handler::Prepared;
use protocol::job::{Energy, Failure, Integration, Motion, SimulateSpec, Simulation};
use simulation::observe::{Curves, Recorder, Shape};
use simulation::run::{RunResult, simulate};
use std::time::Instant;

/// Runs a simulate job.
///
/// # Errors
/// [`Failure::Misconfigured`] when genes or condition do not fit the case.
pub(super) fn run(prepared: &Prepared, spec: &SimulateSpec) -> Result<Simulation, Failure> {
    let law = convert::rope_law(&prepared.case, &spec.genes)?;
    check(spec.integration.as_ref())?;
    let settings = convert::overridden(&prepared.case, spec.integration.as_ref());
    let step = prepared.case.run.output_step_deg;
    let shape_every = if spec.motion_step_deg > 0.0 {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "clamped to the samples of one turn"
        )]
        let every = (spec.motion_step_deg / step)
            .round()
            .clamp(1.0, 360.0 / step) as usize;
        every
    } else {
        0
    };
    let machine = prepared.machine_with(spec.condition, (&spec.genes, &spec.effects))?;
    let mut recorder = Recorder::everything(shape_every);
    let started = Instant::now();
    let result = simulate(&machine, &law, &settings, &mut recorder);
    let wall_s = started.elapsed().as_secs_f64();
    let height = machine.lowest_suspension;
    Ok(assemble(&recorder.curves, &result, step, height, wall_s))
}

/// Whether another integration can be done at all.
fn check(integration: Option<&Integration>) -> Result<(), Failure> {
    let Some(other) = integration else {
        return Ok(());
    };
    for (field, value) in [
        ("integration.longest_step_s", other.longest_step_s),
        ("integration.tolerance", other.tolerance),
    ] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(Failure::Misconfigured {
                field: field.to_owned(),
                problem: format!("is {value}; it must be a positive number"),
            });
        }
    }
    Ok(())
}

fn assemble(
    curves: &Curves,
    result: &RunResult,
    step_deg: f64,
    height: f64,
    wall_s: f64,
) -> Simulation {
    let degrees = |values: &[f64]| values.iter().map(|x| x.to_degrees()).collect();
    let [position, velocity, acceleration] = &curves.suspension;
    Simulation {
        verdict: convert::verdict(&result.verdict),
        counters: convert::counters(&result.statistics),
        wall_s,
        turn_deg: (0..curves.beam.len())
            .map(|i| step_deg * i as f64)
            .collect(),
        gauge_mpa: [0, 1, 2, 3].map(|g| curves.gauge[g].iter().map(|s| s * 1e-6).collect()),
        back_rope_tension_n: curves.back_tension.clone(),
        front_rope_tension_n: curves.front_tension.clone(),
        tension_difference_n: curves.tension_difference.clone(),
        beam_deg: degrees(&curves.beam),
        suspension_m: position.iter().map(|y| y - height).collect(),
        suspension_velocity_m_s: velocity.clone(),
        suspension_acceleration_m_s2: acceleration.clone(),
        crank_torque_n_m: curves.torque.clone(),
        modal: curves.modal.clone(),
        energy: energy(result),
        motion: curves
            .shapes
            .iter()
            .map(|shape| motion(shape, step_deg))
            .collect(),
    }
}

fn energy(result: &RunResult) -> Energy {
    let work = &result.work;
    let missing = work.input - work.output - work.dissipated - result.stored;
    let scale = work.input.abs().max(work.output.abs());
    Energy {
        input_j: work.input,
        output_j: work.output,
        dissipated_j: work.dissipated,
        stored_j: result.stored,
        relative_error: if scale > 0.0 {
            missing.abs() / scale
        } else {
            0.0
        },
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "pictures need no more than single precision"
)]
fn motion(shape: &Shape, step_deg: f64) -> Motion {
    let point = |p: &[f64; 2]| [p[0] as f32, p[1] as f32];
    let points = |all: &[[f64; 2]]| all.iter().map(point).collect();
    let floats = |all: &[f64]| all.iter().map(|&x| x as f32).collect();
    Motion {
        turn_deg: step_deg * shape.sample as f64,
        crank_pin_m: point(&shape.pin),
        beam_deg: shape.beam.to_degrees() as f32,
        crossbeam_m: point(&shape.crossbeam),
        suspension_m: point(&shape.suspension),
        back_rope_m: points(&shape.centers[0]),
        back_tension_n: floats(&shape.tension[0]),
        back_contact_n: floats(&shape.contact[0]),
        front_rope_m: points(&shape.centers[1]),
        front_tension_n: floats(&shape.tension[1]),
        front_contact_n: floats(&shape.contact[1]),
    }
}
