//! `horsehead life`: fatigue life of the back head from simulated stress histories.
mod body;
mod options;
mod output;
mod place;
mod spots;

use crate::cli::{
    argument::{assessment::AssessmentArguments, output::OutputChoice, workers::WorkersChoice},
    output::{assessment::show, problem::EXIT_CODES, progress::StageDisplay},
};
use body::{Body, TableModes};
use case::pumping_unit::{HeadSource, load_meshed_head};
use clap::Args;
use options::{LifeOptions, LifePlan};
use protocol::{
    case::Case,
    pumping_unit::{Machine, PumpingUnit, ReduceHeadSpec, Simulation, SurfaceRequest},
    wire::WireError,
};
use report::{
    MachineAssessment, Topic,
    pumping_unit::{HeadLifePicture, head_life},
};
use run::{
    assessment::{LifeSettings, SimulatedMachine, SimulatedMachines, simulate_machines},
    message,
    session::Session,
};
use spots::{AssessedVariant, Spread, Variant};
use study::{Evaluator, Stop};
use support::Problem;

/// Say where the back head cracks first, and after how many years.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Examples:
  horsehead life runs/cyjs10-5-37hb-quick-seed1
  horsehead life cases/cyjs10-5-37hb --hours 5rpm=16,4rpm=8 --curve en-90
  horsehead life runs/my-unit --curve steel.csv --mean-stress goodman --strength 470

The stress of one revolution at every point of the head's surface, counted by rainflow (the
revolution repeats) and summed by Miner's rule. Of a calibration, the recommended and the
optimised parameters are compared; of a diagnosis, the machine with and without each effect that
it found. What was simulated is kept: another curve or another mix of hours is answered at once.
{EXIT_CODES}"))]
pub(super) struct Arguments {
    #[command(flatten)]
    assessment: AssessmentArguments,
    #[command(flatten)]
    options: LifeOptions,
    #[command(flatten)]
    output: OutputChoice,
    #[command(flatten)]
    workers: WorkersChoice,
}

/// Simulates the conditions, assesses the surface, writes the report and prints the result.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let session = Session::begin();
    let target = arguments.assessment.read()?;
    message::print_notes(&target.notes);
    let unit = pumping_unit(&target.case)?;
    let plan = arguments.options.plan(&target.case, &unit.machine)?;
    let head = load_meshed_head(&target.folder)?;
    if head.as_ref().is_some_and(|(_, source)| source.stale) {
        message::print(
            "note: the tables of the case are missing or were computed from other inputs; `horsehead head CASE --write` \
             replaces them",
        );
    }
    let head = head.map(|(read, source)| {
        same_head(&read.machine, &unit.machine)?;
        let spec = super::head::surface_spec(&unit, &source)?;
        anyhow::Ok((source, spec))
    });
    let head = head.transpose()?;
    let conditions: Vec<usize> = plan.conditions().collect();
    let run = target.begin(arguments.assessment.run.as_deref(), LifeSettings)?;
    let (body, simulated) = session.work(
        &run,
        &arguments.workers.session()?,
        async |dispatch, stop| {
            let mut display = StageDisplay::new();
            let body = match &head {
                Some((source, spec)) => {
                    Some(surface_of(dispatch, (source, spec), &unit.machine, stop).await?)
                }
                None => None,
            };
            let simulated =
                simulate_machines(dispatch, &target, (&conditions, 0), &mut display, stop).await;
            display.clear();
            Ok((body, simulated?))
        },
    )?;
    let assessed = assess(body.as_ref(), &plan, &simulated)?;
    let mut notes = spots::notes(&plan, &assessed);
    if body.is_none() {
        notes.push(
            "the case names no mesh of its head, `mesh_file` in [flexible_head]: lives are those of the gauges alone"
                .to_owned(),
        );
    }
    notes.extend(simulated.notes);
    let assessment = MachineAssessment {
        topic: Topic::Life,
        lead: output::lead(&plan, &assessed),
        tables: output::tables(&plan, &assessed),
        figures: match (&body, &head, assessed.last()) {
            (Some(body), Some((source, _)), Some(last)) => figures((body, source), &plan, last),
            _ => Vec::new(),
        },
        notes,
    };
    let title = format!("Life of the back head of {}", target.case.name);
    show(
        &run,
        (title, &assessment),
        ("life.csv", &output::csv(&assessed)?),
        &output::object(&target.case, &plan, &assessed, session.wall_s(&run)),
        arguments.output.output,
    )
}

/// Reduces the head and requests the stress on its surface under the loads of the simulations.
async fn surface_of(
    evaluator: &mut impl Evaluator,
    (source, spec): (&HeadSource, &ReduceHeadSpec),
    machine: &Machine,
    stop: &mut Stop,
) -> anyhow::Result<Body> {
    let mut reduced = super::head::reduce_head(evaluator, spec, stop).await?;
    let modes = TableModes::find(&reduced, machine)?;
    let statics = spec.surface.as_ref().map_or(0, SurfaceRequest::statics);
    let surface = reduced.surface.take().unwrap_or_default();
    let loads = modes.loads(statics);
    let stress = super::head::surface_stress(evaluator, spec, (&surface, &loads), stop).await?;
    Ok(Body::new(&source.mesh, surface, (&modes, statics), stress))
}

/// Assesses all machines; the last of those that are compared with its spread.
fn assess(
    body: Option<&Body>,
    plan: &LifePlan,
    simulated: &SimulatedMachines,
) -> Result<Vec<AssessedVariant>, WireError> {
    let compared = variants(&simulated.compared)?;
    let others = variants(&simulated.others)?;
    let about = simulated.about.as_ref();
    let machines = about.map(|(_, machines)| variants(machines)).transpose()?;
    let spread = Spread {
        others: &others,
        about: about
            .zip(machines.as_ref())
            .map(|((own, _), variants)| (own, &variants[..])),
    };
    Ok(spots::assess(body, plan, &compared, &spread))
}

/// Decodes the simulations of machines.
fn variants(machines: &[SimulatedMachine]) -> Result<Vec<Variant<'_>>, WireError> {
    let variant = |own: &'_ SimulatedMachine| -> Result<Vec<Simulation>, WireError> {
        own.curves.iter().map(Simulation::of).collect()
    };
    let each = machines.iter().map(|own| {
        Ok(Variant {
            name: &own.name,
            simulations: variant(own)?,
        })
    });
    each.collect()
}

/// Draws the head of a variant, coloured by life, and the damage of its first hot spot over the crank angle.
fn figures(
    (body, source): (&Body, &HeadSource),
    plan: &LifePlan,
    variant: &AssessedVariant,
) -> Vec<report::Figure> {
    let pins = body.pins.iter().map(|pin| (pin.name, pin.axis_m()));
    let pins: Vec<(&'static str, [f64; 2])> = pins.collect();
    let spots = variant.hot_spots.iter().map(|own| own.place_m);
    let conditions = plan.operations.iter().map(|own| own.name.clone());
    let sectors = conditions.zip(variant.sectors.iter().cloned());
    head_life(&HeadLifePicture {
        surface: body.surface(),
        years: &variant.years,
        pins: &pins,
        gauges: &source.gauges,
        spots_m: &spots.collect::<Vec<_>>(),
        sectors: &sectors.collect::<Vec<_>>(),
    })
}

/// Checks that the machine of the case folder, whose mesh is used, is that of the run but for its load cards.
fn same_head(of_case: &Machine, of_run: &Machine) -> Result<(), Problem> {
    let without_conditions = |machine: &Machine| Machine {
        conditions: Vec::new(),
        ..machine.clone()
    };
    if without_conditions(of_case) == without_conditions(of_run) {
        return Ok(());
    }
    Err(Problem {
        message: "the machine of the case has changed since the run was begun, and the mesh of the head with it, perhaps"
            .to_owned(),
        remedy: "restore the case, or name the case with the parameters of the run: horsehead life CASE --genes \
                 RUN/calibrated.toml"
            .to_owned(),
    })
}

/// Decodes the machine of a case, and refuses those whose head's life cannot be computed.
fn pumping_unit(case: &Case) -> anyhow::Result<PumpingUnit> {
    let unit = PumpingUnit::of(case.clone()).map_err(|error| Problem {
        message: format!("the life is that of a pumping unit's back head: {error}"),
        remedy: "name the case, or a run, of a pumping unit".to_owned(),
    })?;
    if unit.machine.twin_ropes.is_some() {
        return Err(Problem {
            message: "the life of a head under twin ropes cannot be computed".to_owned(),
            remedy: "two ropes of unequal tension twist the head, and its surface stress is computed for one rope over \
                     the whole width; use a copy of the case without [twin_ropes]"
                .to_owned(),
        }
        .into());
    }
    Ok(unit)
}
