//! `horsehead life`: fatigue life of the back head from simulated stress histories.
mod body;
mod options;
mod output;
mod place;
mod spots;

use crate::cli::{
    argument::{
        case::{case_folder, load_case_at},
        output::OutputChoice,
        workers::{cores, worker_count},
    },
    output::{problem::EXIT_CODES, progress::StageDisplay, terminal},
};
use anyhow::Context as _;
use body::Body;
use case::pumping_unit::{HeadSource, load_head};
use clap::Args;
use discrepancy::{diagnose::Inputs, identify::Neighbours};
use dispatch::runtime::Dispatch;
use options::{LifeOptions, LifePlan};
use protocol::{
    case::Case,
    job::Verdict,
    pumping_unit::{PumpingUnit, Simulation},
};
use report::{
    pumping_unit::{HeadLifePicture, write_head_life},
    table, words,
};
use run::{
    calibration::{CalibrationRun, estimate_inputs, pair, recorded},
    folder::{GENES, RunFolder},
    message,
    session::temporary::with_temporary_run,
};
use search::strategy::family::rivals;
use spots::{AssessedVariant, Spread, Variant};
use std::{
    path::{Path, PathBuf},
    time::Instant,
};
use study::{CompareRequest, Compared, Stop, StudyError};
use support::Problem;

/// Say where the back head cracks first, and after how many years.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Examples:
  horsehead life runs/cyjs10-5-37hb-quick-seed1
  horsehead life cases/cyjs10-5-37hb --hours 5rpm=16,4rpm=8 --curve en-90
  horsehead life runs/my-unit --curve steel.csv --mean-stress goodman --strength 470

The stress of one revolution at every point of the head's surface, counted by rainflow (the
revolution repeats) and summed by Miner's rule. Of a run, the recommended and the optimised
parameters are compared.
{EXIT_CODES}"))]
pub(super) struct Arguments {
    /// Case folder, or the folder of a finished calibration.
    #[arg(value_name = "CASE|RUN", value_parser = case_folder)]
    target: PathBuf,
    /// Gene file whose parameters are assessed, such as a run's `calibrated.toml`; the recommended ones by default.
    #[arg(long, value_name = "FILE", env = "HORSEHEAD_GENES")]
    genes: Option<PathBuf>,
    /// Folder for `head_life.svg`, the head coloured by life, and `damage_by_crank.svg`.
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_OUT")]
    out: Option<PathBuf>,
    #[command(flatten)]
    options: LifeOptions,
    /// Worker processes to start [default: one per core].
    #[arg(long, value_name = "N", env = "HORSEHEAD_WORKERS", value_parser = worker_count())]
    workers: Option<usize>,
    #[command(flatten)]
    output: OutputChoice,
}

/// Case whose life is assessed, with the individuals to compare.
struct Target {
    folder: PathBuf,
    case: Case,
    /// Individuals that are compared, each with its name; the last one is ranked.
    individuals: Vec<(String, Vec<f64>)>,
    /// Fits of other families that a calibration saw.
    others: Vec<Vec<f64>>,
    /// Inputs of the estimate of the unknowns at the optimum; `None` for a case, or where the records have changed.
    estimate: Option<Inputs>,
}

/// Simulates the conditions, assesses the surface and prints the result.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let started = Instant::now();
    let target = target(arguments)?;
    let unit = pumping_unit(&target.case)?;
    let plan = arguments.options.plan(&target.case, &unit.machine)?;
    let (read, source) = load_head(&target.folder)?;
    if source.stale {
        message::print(
            "note: the tables of the case are missing or were computed from other inputs; `horsehead head CASE --write` \
             replaces them",
        );
    }
    let spec = super::head::surface_spec(&read, &source)?;
    let mut all = target.individuals.clone();
    let named = all.len();
    let others = target.others.iter().enumerate();
    all.extend(others.map(|(k, genes)| (format!("other fit {}", k + 1), genes.clone())));
    let wanted = |condition: usize| CompareRequest {
        condition,
        first: 0,
        individuals: all.clone(),
        frames: 0,
        columns: Vec::new(),
    };
    let wanted: Vec<CompareRequest> = plan.conditions().map(wanted).collect();
    let workers = arguments.workers.unwrap_or_else(|| cores().min(4)).max(1);
    let (reduced, groups, beside) =
        with_temporary_run(&target.case, "life", workers, async |dispatch, stop| {
            let reduced = super::head::reduce_head(dispatch, &spec, stop).await?;
            let groups = study::compare(dispatch, &target.case, &wanted, stop).await?;
            let beside = beside(dispatch, &target, &wanted, stop).await?;
            Ok((reduced, groups, beside))
        })?;
    let body = Body::new(&source.mesh, &reduced, &unit.machine)?;
    let variants: Vec<Variant<'_>> = (0..all.len())
        .map(|k| variant(&target.case, &groups, k))
        .collect::<anyhow::Result<_>>()?;
    let (variants, others) = variants.split_at(named);
    let count = beside
        .neighbours
        .as_ref()
        .map_or(0, |own| own.individuals.len());
    let neighbours: Vec<Variant<'_>> = (0..count)
        .map(|k| variant(&target.case, &beside.groups, k))
        .collect::<anyhow::Result<_>>()?;
    let spread = Spread {
        others,
        neighbours: beside.neighbours.as_ref().map(|own| (own, &neighbours[..])),
    };
    let assessed: Vec<AssessedVariant> = spots::assess(&body, &plan, variants, &spread);
    if let (Some(folder), Some(last)) = (&arguments.out, assessed.last()) {
        for path in draw(folder, (&body, &source), &plan, last)? {
            message::print(&format!("wrote {}", path.display()));
        }
    }
    let object = output::object(
        &target.case,
        &plan,
        &assessed,
        started.elapsed().as_secs_f64(),
    );
    for note in spots::notes(&plan, &assessed)
        .into_iter()
        .chain(beside.note)
    {
        message::print(&format!("note: {note}"));
    }
    let tables = || {
        let style = terminal::style();
        let tables = output::tables(&plan, &assessed);
        let texts = tables.iter().map(|own| table::text(own, style));
        texts.collect::<Vec<_>>().join("\n")
    };
    terminal::print(arguments.output.output, tables, &object)
}

/// Draws the head of a variant, coloured by life, and the damage of its first hot spot over the crank angle.
fn draw(
    folder: &Path,
    (body, source): (&Body<'_>, &HeadSource),
    plan: &LifePlan,
    variant: &AssessedVariant,
) -> anyhow::Result<Vec<PathBuf>> {
    let pins = body.pins.iter().map(|pin| (pin.name, pin.axis_m()));
    let pins: Vec<(&'static str, [f64; 2])> = pins.collect();
    let spots = variant.hot_spots.iter().map(|own| own.place_m);
    let conditions = plan.operations.iter().map(|own| own.name.clone());
    let sectors = conditions.zip(variant.sectors.iter().cloned());
    Ok(write_head_life(
        folder,
        &HeadLifePicture {
            surface: body.surface(),
            years: &variant.years,
            pins: &pins,
            gauges: &source.gauges,
            spots_m: &spots.collect::<Vec<_>>(),
            sectors: &sectors.collect::<Vec<_>>(),
        },
    )?)
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

/// Simulations beside the optimum, for the interval of lives.
struct Beside {
    groups: Vec<Compared>,
    neighbours: Option<Neighbours>,
    /// Reason why there are none.
    note: Option<String>,
}

/// Estimates the unknowns of a run at its optimum, and simulates the individuals beside it.
async fn beside(
    dispatch: &mut Dispatch,
    target: &Target,
    wanted: &[CompareRequest],
    stop: &mut Stop,
) -> Result<Beside, StudyError> {
    let none = |note: Option<String>| Beside {
        groups: Vec::new(),
        neighbours: None,
        note,
    };
    let Some(inputs) = &target.estimate else {
        return Ok(none(None));
    };
    let mut display = StageDisplay::new();
    let estimate = study::estimate_at_start_on(dispatch, inputs, &mut display, stop).await?;
    display.clear();
    let Some(estimate) = estimate else {
        return Ok(none(None));
    };
    let Some(neighbours) = estimate.neighbours else {
        let note = format!(
            "lives have no interval: the fit leaves {:.1} times the noise, so that its numbers are not those of the \
             machine; `horsehead diagnose` finds what the model lacks",
            estimate.noise_ratio
        );
        return Ok(none(Some(note)));
    };
    let individuals: Vec<(String, Vec<f64>)> = (1..)
        .zip(&neighbours.individuals)
        .map(|(number, genes)| (format!("neighbour {number}"), genes.clone()))
        .collect();
    let request = |own: &CompareRequest| CompareRequest {
        first: own.individuals.len(),
        individuals: individuals.clone(),
        ..own.clone()
    };
    let requests: Vec<CompareRequest> = wanted.iter().map(request).collect();
    let groups = study::compare(dispatch, &target.case, &requests, stop).await?;
    Ok(Beside {
        groups,
        neighbours: Some(neighbours),
        note: None,
    })
}

/// Reads the case, or the finished calibration with its case and fits.
fn target(arguments: &Arguments) -> anyhow::Result<Target> {
    let folder = RunFolder::new(&arguments.target);
    if !folder.is_begun() {
        let (loaded, start) = load_case_at(&arguments.target, None, arguments.genes.as_deref())?;
        let name = arguments.genes.as_ref().map_or_else(
            || "recommended".to_owned(),
            |file| file.display().to_string(),
        );
        let genes = start.map_or_else(|| loaded.case.start(), |start| start.genes);
        return Ok(Target {
            folder: arguments.target.clone(),
            case: loaded.case,
            individuals: vec![(name, genes)],
            others: Vec::new(),
            estimate: None,
        });
    }
    if arguments.genes.is_some() {
        return Err(Problem {
            message: "--genes is given with a run, whose parameters are its own".to_owned(),
            remedy: "leave --genes out, or name the case folder instead of the run".to_owned(),
        }
        .into());
    }
    let run = CalibrationRun::open(&arguments.target)?;
    let parameters = run.folder.file(GENES);
    if !parameters.exists() {
        return Err(Problem {
            message: format!("{} is not finished", arguments.target.display()),
            remedy: format!("finish it first:\n  {}", run.resume_command()),
        }
        .into());
    }
    let found = recorded(&run)?.result.calibrated;
    let space = run.manifest.space(&run.case)?;
    let best = (&found.best.genes[..], found.best.fitness);
    let others = rivals(&space, best, &found.descent_ends, |_| true);
    let estimate = estimate_inputs(&run, &found.best.genes)?;
    Ok(Target {
        estimate,
        folder: run.manifest.case_folder.clone(),
        individuals: pair(&run.case, &found.best.genes),
        others: others
            .into_iter()
            .map(|own| own.end.genes.clone())
            .collect(),
        case: run.case,
    })
}

/// Collects the simulations of an individual under all conditions.
fn variant<'a>(case: &Case, groups: &'a [Compared], k: usize) -> anyhow::Result<Variant<'a>> {
    let mut simulations = Vec::new();
    let mut name = "";
    for group in groups {
        let own = group.individuals.get(k).context("a result is missing")?;
        name = &own.name;
        if own.drawn.verdict != Verdict::Complete {
            let condition = &case.conditions[group.condition].name;
            return Err(Problem {
                message: format!(
                    "the simulation of the {name} parameters at {condition} {}",
                    words::verdict(&own.drawn.verdict)
                ),
                remedy:
                    "a life needs a whole revolution; `horsehead simulate` shows how far it came"
                        .to_owned(),
            }
            .into());
        }
        simulations.push(Simulation::of(&own.drawn)?);
    }
    Ok(Variant { name, simulations })
}
