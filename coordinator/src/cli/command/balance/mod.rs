//! `horsehead balance`: torque of the crank over a revolution against the reducer's rating, and the counterweight that
//! lowers it.
mod options;
mod output;
mod picture;
mod summary;
mod torque;

use crate::cli::{
    argument::{
        assessment::AssessmentArguments, hours::Operation, output::OutputChoice,
        workers::WorkersChoice,
    },
    output::{assessment::show, problem::EXIT_CODES, progress::StageDisplay},
};
use anyhow::Context as _;
use clap::Args;
use options::{BalanceOptions, BalancePlan};
use protocol::{
    case::Case,
    pumping_unit::{Machine, PumpingUnit, Simulation, TurnSense},
};
use report::{MachineAssessment, Topic, pumping_unit::crank_balance};
use run::{
    assessment::{
        AssessmentTarget, BalanceSettings, SimulatedMachine, SimulatedMachines, simulate_machines,
    },
    message,
    session::{Session, temporary::compare_once},
};
use std::f64::consts::TAU;
use study::CompareRequest;
use summary::{AssessedCrank, states};
use support::{Problem, interpolation::periodic};
use torque::{Bounds, Counterweight, Revolution};

/// Compare the crank's torque with the reducer's rating, and find the counterweight that lowers it.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Examples:
  horsehead balance runs/cyjs10-5-37hb-quick-seed1
  horsehead balance cases/cyjs10-5-37hb --hours 5rpm=16,4rpm=8 --goal peak
  horsehead balance cases/cyjs10-5-37hb --phase -10..10 --step 2520

Net torque over one revolution, its peak, root mean square and power, and the moment and phase of
the counterweight with which the root mean square, or the peak, is least. That optimum is
simulated. Of a calibration, the recommended and the optimised parameters are compared; of a
diagnosis, the machine with and without each effect that it found.
{EXIT_CODES}"))]
pub(super) struct Arguments {
    #[command(flatten)]
    assessment: AssessmentArguments,
    #[command(flatten)]
    options: BalanceOptions,
    #[command(flatten)]
    output: OutputChoice,
    #[command(flatten)]
    workers: WorkersChoice,
}

/// Simulations of an optimum by which the next one is sought, at most: where the motor slips, the counterweight changes
/// the motion.
const MOST_REPETITIONS: usize = 3;
/// Snapshots of the motion per revolution, from which the angle of the crank pin is taken.
const SNAPSHOTS: u32 = 36;
/// Relative change of the optimal moment, and change of the phase in radians, below which it is not sought again.
const SETTLED: f64 = 1e-3;

/// Simulates the conditions, seeks the counterweight, simulates it, writes the report and prints the result.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let session = Session::begin();
    let target = arguments.assessment.read()?;
    message::print_notes(&target.notes);
    let unit = PumpingUnit::of(target.case.clone()).map_err(|error| Problem {
        message: format!("the balance is that of a pumping unit's crank: {error}"),
        remedy: "name the case, or a run, of a pumping unit".to_owned(),
    })?;
    let plan = arguments.options.plan(&target.case, &unit.machine)?;
    let conditions: Vec<usize> = plan.operations.iter().map(|own| own.condition).collect();
    let run = target.begin(arguments.assessment.run.as_deref(), BalanceSettings)?;
    let options = arguments.workers.session()?;
    let simulated = session.work(&run, &options, async |dispatch, stop| {
        let mut display = StageDisplay::new();
        let simulated = simulate_machines(
            dispatch,
            &target,
            (&conditions, SNAPSHOTS),
            &mut display,
            stop,
        )
        .await;
        display.clear();
        simulated
    })?;
    let assessed = assess((&unit, &plan), &simulated)?;
    let present = assessed.last().context("no machine is compared")?;
    let (optimum, revolutions) =
        optimum((&unit, &target, &plan), &simulated, options.local_workers)?;
    let mut notes = output::notes(
        (&target.case, target.run.is_some()),
        &plan,
        present,
        &optimum,
    );
    notes.extend(simulated.notes);
    let picture = picture::picture(
        (&target.case, &unit.machine),
        (&plan, &revolutions),
        (present, &optimum),
    );
    let assessment = MachineAssessment {
        topic: Topic::Balance,
        lead: output::lead(&plan, present, &optimum),
        tables: output::tables((&target.case, &unit.machine), &plan, &assessed, &optimum),
        figures: crank_balance(&picture),
        notes,
    };
    let title = format!("Torque of the crank of {}", target.case.name);
    show(
        &run,
        (title, &assessment),
        ("torque.csv", &output::csv(&plan, (present, &optimum))?),
        &output::object(
            (&target.case, &unit.machine),
            &plan,
            (&assessed, &optimum),
            session.wall_s(&run),
        ),
        arguments.output.output,
    )
}

/// Returns the angle of the crank pin at each sample of a simulation \[rad\], from its recorded motion: where the motor slips
/// or the index pulse is late, the pin is ahead of the crank angle of the record.
fn pin_rad(machine: &Machine, simulation: &Simulation) -> Vec<f64> {
    let crank = &machine.crank;
    let ahead = simulation.motion.iter().map(|snapshot| {
        let [x, y] = snapshot.crank_pin_m.map(f64::from);
        let angle = libm::atan2(y - crank.center_y_m, x - crank.center_x_m);
        angle - sense(machine) * snapshot.turn_deg.to_radians()
    });
    let ahead: Vec<f64> = ahead.collect();
    let first = ahead.first().copied().unwrap_or(f64::NAN);
    // it changes by some degrees, and by no whole turn
    let ahead = ahead.iter().map(|angle| {
        let change = angle - first;
        first + change - TAU * (change / TAU).round()
    });
    let ahead: Vec<f64> = ahead.collect();
    let at = simulation.motion.iter().map(|own| own.turn_deg);
    let at: Vec<f64> = at.collect();
    let angle = |turn: &f64| {
        let ahead = periodic(&at, &ahead, *turn, 360.0).unwrap_or(f64::NAN);
        ahead + sense(machine) * turn.to_radians()
    };
    simulation.turn_deg.iter().map(angle).collect()
}

/// Returns 1 for a crank that turns counter-clockwise, -1 for one that turns clockwise.
const fn sense(machine: &Machine) -> f64 {
    match machine.crank.sense {
        TurnSense::Clockwise => -1.0,
        TurnSense::CounterClockwise => 1.0,
    }
}

/// Returns the revolutions of a machine under the conditions of a plan, with the counterweight of each.
fn revolutions(
    machine: &Machine,
    plan: &BalancePlan,
    weights: &[Counterweight],
    simulations: &[Simulation],
) -> Vec<Revolution> {
    let hours: f64 = plan.operations.iter().map(|own| own.hours_per_day).sum();
    let each = plan.operations.iter().zip(weights).zip(simulations);
    each.map(|((operation, weight), simulation)| {
        let pin = pin_rad(machine, simulation);
        let curve = (&pin[..], &simulation.crank_torque_n_m[..]);
        let share = operation.hours_per_day / hours;
        Revolution::new(curve, sense(machine), *weight, share)
    })
    .collect()
}

/// Decodes the simulations of a machine.
fn decoded(machine: &SimulatedMachine) -> anyhow::Result<Vec<Simulation>> {
    let each = machine.curves.iter().map(Simulation::of);
    Ok(each.collect::<Result<_, _>>()?)
}

/// Assesses every machine with the present counterweight; the last of those that are compared with its intervals.
fn assess(
    (unit, plan): (&PumpingUnit, &BalancePlan),
    simulated: &SimulatedMachines,
) -> anyhow::Result<Vec<AssessedCrank>> {
    let of_machine =
        |machine: &SimulatedMachine, bounds: &Bounds| -> anyhow::Result<AssessedCrank> {
            let simulations = decoded(machine)?;
            let all = revolutions(&unit.machine, plan, &plan.present, &simulations);
            let states = states(&unit.machine, plan, (&plan.present, &all), &simulations);
            let best = plan.goal.best(&all, bounds);
            Ok(AssessedCrank::new(&machine.name, states, best))
        };
    // a step would hide how the best moment changes
    let anywhere = Bounds {
        step_n_m: None,
        ..plan.bounds.clone()
    };
    let about = match &simulated.about {
        Some((neighbourhood, machines)) => {
            let machines = machines.iter().map(|own| of_machine(own, &anywhere));
            Some((neighbourhood, machines.collect::<anyhow::Result<Vec<_>>>()?))
        }
        None => None,
    };
    let last = simulated.compared.len().saturating_sub(1);
    let each = simulated.compared.iter().enumerate();
    each.map(|(k, machine)| {
        let crank = of_machine(machine, &plan.bounds)?;
        Ok(match &about {
            Some((neighbourhood, about)) if k == last => {
                let between_steps = of_machine(machine, &anywhere)?.best.moment_n_m;
                crank.with_intervals(neighbourhood, (about, between_steps), &plan.bounds)
            }
            _ => crank,
        })
    })
    .collect()
}

/// Seeks the counterweight of the last machine, simulates the machine with it and, where that moves the optimum, repeats
/// both. Returns its state under each condition, and the revolutions by which it was found.
fn optimum(
    (unit, target, plan): (&PumpingUnit, &AssessmentTarget, &BalancePlan),
    simulated: &SimulatedMachines,
    workers: usize,
) -> anyhow::Result<(AssessedCrank, Vec<Revolution>)> {
    let machine = simulated
        .compared
        .last()
        .context("no machine is compared")?;
    let mut all = revolutions(&unit.machine, plan, &plan.present, &decoded(machine)?);
    let mut best = plan.goal.best(&all, &plan.bounds);
    for repetition in 1.. {
        let weights = vec![best; plan.operations.len()];
        let simulations = simulate_with(unit, target, plan, best, workers)?;
        all = revolutions(&unit.machine, plan, &weights, &simulations);
        let next = plan.goal.best(&all, &plan.bounds);
        let moved = (next.moment_n_m - best.moment_n_m).abs() / best.moment_n_m.max(1.0);
        let turned = (next.phase_deg - best.phase_deg).to_radians().abs();
        if moved.max(turned) < SETTLED || repetition == MOST_REPETITIONS {
            let states = states(&unit.machine, plan, (&weights, &all), &simulations);
            return Ok((AssessedCrank::new("optimum", states, best), all));
        }
        best = next;
    }
    anyhow::bail!("no optimum was simulated")
}

/// Simulates the last machine of an assessment with another counterweight under the conditions of a plan.
fn simulate_with(
    unit: &PumpingUnit,
    target: &AssessmentTarget,
    plan: &BalancePlan,
    weight: Counterweight,
    workers: usize,
) -> anyhow::Result<Vec<Simulation>> {
    let mut changed = unit.clone();
    changed.machine.crank.counterweight_phase_deg = weight.phase_deg;
    for operation in &plan.operations {
        let condition = &mut changed.machine.conditions[operation.condition];
        condition.counterweight_moment_n_m = weight.moment_n_m;
    }
    let case = without_record(changed.into_case()?);
    let individual = target.assessed().context("no machine is compared")?;
    let request = |own: &Operation| CompareRequest {
        condition: own.condition,
        first: 0,
        individuals: vec![individual.clone()],
        frames: SNAPSHOTS,
        columns: Vec::new(),
    };
    let wanted: Vec<CompareRequest> = plan.operations.iter().map(request).collect();
    let groups = compare_once("balance", &case, &wanted, workers.max(1))?;
    let each = run::assessment::curves(&case, &groups, 0)?;
    Ok(each.iter().map(Simulation::of).collect::<Result<_, _>>()?)
}

/// Removes the measured records from a case: what was measured was another counterweight's.
fn without_record(mut case: Case) -> Case {
    for channel in &mut case.channels {
        channel.record = None;
    }
    case
}
