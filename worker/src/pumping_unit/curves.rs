//! All curves of a simulation that can be plotted.
use super::completed_run::CompletedRun;
use super::machines::Machines;
use protocol::{
    job::{Curves, Failure, SimulateSpec, to_single_precision},
    pumping_unit::{Energy, HeadLoads, MachineSnapshot, Simulation},
};
use simulation::observe::{Recorder, Shape};
use simulation::run::RunResult;

/// Simulates an individual and returns all curves.
///
/// # Errors
/// As [`CompletedRun::new`].
pub(super) fn run(
    machines: &Machines,
    spec: &SimulateSpec,
    pictures: u32,
) -> Result<Curves, Failure> {
    let step_deg = machines.unit.machine.run.output_step_deg;
    let recorder = Recorder::everything(samples_apart(pictures, step_deg)).with_head_loads();
    let plain = SimulateSpec {
        columns: Vec::new(),
        ..spec.clone()
    };
    let ran = CompletedRun::new(machines, &plain, recorder)?;
    let (gauge_mpa, suspension_m) = (ran.gauges_mpa(), ran.suspension_m());
    let channels = ran.channels(&machines.unit.case, spec.individual.condition)?;
    let curves = ran.curves;
    let degrees = |values: &[f64]| values.iter().map(|x| x.to_degrees()).collect();
    let [_, velocity, acceleration] = curves.suspension;
    let turn_deg = (0..curves.beam.len()).map(|i| step_deg * i as f64);
    let shapes = curves.shapes.iter();
    let simulation = Simulation {
        verdict: ran.verdict,
        counters: ran.counters,
        wall_s: ran.wall_s,
        turn_deg: turn_deg.collect(),
        gauge_mpa,
        back_rope_tension_n: curves.back_tension,
        front_rope_tension_n: curves.front_tension,
        tension_difference_n: curves.tension_difference,
        beam_deg: degrees(&curves.beam),
        suspension_m,
        suspension_velocity_m_s: velocity,
        suspension_acceleration_m_s2: acceleration,
        crank_torque_n_m: curves.torque,
        modal: curves.modal,
        head_loads: head_loads(&curves.head_loads),
        energy: energy(&ran.result),
        motion: shapes.map(|shape| motion(shape, step_deg)).collect(),
    };
    let drawn = simulation.into_curves(channels);
    let drawn = drawn.map_err(|error| Failure::misconfigured("curves", error.to_string()))?;
    if spec.columns.is_empty() {
        return Ok(drawn);
    }
    // the same bits once more: `wall_s` is that of a plain run
    let derived = CompletedRun::new(machines, spec, Recorder::gauges_only())?;
    Ok(Curves {
        columns: derived.columns,
        columns_wall_s: derived.wall_s,
        ..drawn
    })
}

/// Returns the number of samples between two recorded shapes of the machine; 0 if no shapes are requested.
fn samples_apart(pictures: u32, step_deg: f64) -> usize {
    if pictures > 0 {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "clamped to the samples of one turn"
        )]
        let apart = (360.0 / f64::from(pictures) / step_deg)
            .round()
            .clamp(1.0, 360.0 / step_deg) as usize;
        apart
    } else {
        0
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

/// Converts the loads of the back head to the protocol's type.
fn head_loads(loads: &simulation::observe::HeadLoadCurves) -> HeadLoads {
    let single = |curve: &Vec<f64>| to_single_precision(curve.iter().copied());
    HeadLoads {
        normal_n: loads.normal.iter().map(single).collect(),
        anchor_n: loads.anchor.each_ref().map(single),
        acceleration: loads.acceleration.each_ref().map(single),
        modal: loads.beyond.iter().map(single).collect(),
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "pictures need no more than single precision"
)]
fn motion(shape: &Shape, step_deg: f64) -> MachineSnapshot {
    let point = |p: &[f64; 2]| [p[0] as f32, p[1] as f32];
    let points = |all: &[[f64; 2]]| all.iter().map(point).collect();
    let floats = |all: &[f64]| all.iter().map(|&x| x as f32).collect();
    MachineSnapshot {
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
