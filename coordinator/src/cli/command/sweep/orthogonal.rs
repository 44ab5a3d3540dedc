//! `horsehead sweep orthogonal`: estimates the best levels of a search's settings from an orthogonal array, a
//! small subset of all combinations.
use crate::cli::{
    argument::{
        case::{CaseChoice, LoadedCase},
        output::OutputChoice,
        settings::SettingsChoice,
        workers::WorkersChoice,
    },
    output::{problem::EXIT_CODES, progress::Display, sweep::show_test},
};
use anyhow::Context as _;
use case::require_record;
use clap::{
    Args,
    builder::{PossibleValuesParser, TypedValueParser as _},
};
use run::{
    factor,
    manifest::{Manifest, RunIdentity as _},
    name::RunName,
    opened::Run,
    orthogonal::{Orthogonal, test},
    searches::Searches,
    session::Session,
};
use search::{
    space::Space,
    strategy::{CATALOGUE, preset},
};
use std::path::PathBuf;
use study::orthogonal::{Array, Factor};
use study::{Entry, Evaluator as _, Watch as _};
use support::Problem;

/// Test settings of a search by an orthogonal array; the same command resumes.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Examples:
  horsehead sweep orthogonal cases/cyjs10-5-37hb
  horsehead sweep orthogonal cases/cyjs10-5-37hb --array L16 --evaluations 2000
  horsehead sweep orthogonal cases/cyjs10-5-37hb --factor population=40,80,120 \\
      --factor generations=30,60,90 --factor crossover_probability=0.7,0.8,0.9

Without --factor: population, crossover_probability, mutation_probability and the climbing trials
of both kinds. L9 holds up to 4 factors of 3 levels, L16 5 of 4, L25 6 of 5. The response is
log10 of the best objective at the budget. Seeds are blocks; the best levels are confirmed with
as many other seeds.

{EXIT_CODES}"))]
pub(super) struct Arguments {
    #[command(flatten)]
    choice: CaseChoice,
    /// The orthogonal array.
    #[arg(long, default_value = "L9", env = "HORSEHEAD_ARRAY", value_parser = arrays())]
    array: Array,
    /// A setting with its levels; KEY+KEY=A,B,C sets several to the same. May be given several times, or with
    /// semicolons.
    #[arg(
        long,
        value_name = "KEY=A,B,C",
        value_delimiter = ';',
        env = "HORSEHEAD_FACTOR",
        value_parser = factor::parse
    )]
    factor: Vec<Factor>,
    /// Preset to which the factors belong.
    #[arg(
        long,
        default_value = "paper",
        env = "HORSEHEAD_PRESET",
        value_parser = PossibleValuesParser::new(CATALOGUE.iter().map(|preset| preset.name))
    )]
    preset: String,
    #[command(flatten)]
    settings: SettingsChoice,
    /// Evaluations of each search [default: 1000; none if a factor determines the length of a search].
    #[arg(long, value_name = "N", env = "HORSEHEAD_EVALUATIONS", value_parser = clap::value_parser!(u64).range(4..=1_000_000))]
    evaluations: Option<u64>,
    /// Number of seeds, each of which is a block.
    #[arg(long, value_name = "N", default_value_t = 5, env = "HORSEHEAD_SEEDS", value_parser = clap::value_parser!(u64).range(1..=1000))]
    seeds: u64,
    /// First seed.
    #[arg(long, default_value_t = 1, env = "HORSEHEAD_SEED")]
    seed: u64,
    /// Run folder [default: runs/CASE-sweep-ARRAY-set-HASH-seedN, the hash that of factors and budget].
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_RUN")]
    run: Option<PathBuf>,
    #[command(flatten)]
    output: OutputChoice,
    #[command(flatten)]
    workers: WorkersChoice,
}

fn arrays() -> impl clap::builder::TypedValueParser<Value = Array> {
    PossibleValuesParser::new(Array::ALL.map(Array::name)).map(|name| {
        let named = Array::ALL.into_iter().find(|array| array.name() == name);
        named.unwrap_or(Array::L9)
    })
}

/// Returns the default factors of an orthogonal array: those of the paper, but with the number of
/// hill-climbing trials in place of the number of generations, because generations would determine the
/// budget.
fn default_factors(array: Array) -> Vec<Factor> {
    // L9 takes the first three of each, with what the paper found best among them
    const LEVELS: [(&str, [&str; 5]); 4] = [
        ("population", ["40", "80", "120", "20", "160"]),
        ("crossover_probability", ["0.9", "0.8", "0.7", "0.6", "1"]),
        (
            "mutation_probability",
            ["0.05", "0.02", "0.1", "0.01", "0.2"],
        ),
        (
            "crossover_trials+mutation_trials",
            ["10", "5", "20", "0", "40"],
        ),
    ];
    let of = |(name, levels): (&str, [&'static str; 5])| {
        let mut levels: Vec<&str> = levels.into_iter().take(array.levels()).collect();
        let value = |level: &&str| level.parse().unwrap_or(0.0);
        levels.sort_by(|a, b| f64::total_cmp(&value(a), &value(b)));
        Factor::new(name, levels)
    };
    LEVELS.into_iter().map(of).collect()
}

/// Returns the chosen or default factors after checking that they fit the array.
fn factors(arguments: &Arguments) -> Result<Vec<Factor>, Problem> {
    let array = arguments.array;
    let chosen = match arguments.factor.as_slice() {
        [] => default_factors(array),
        some => some.to_vec(),
    };
    let holds = format!(
        "{} holds up to {} factors of {} levels; --array chooses another",
        array.name(),
        array.columns(),
        array.levels()
    );
    if chosen.len() > array.columns() {
        return Err(Problem {
            message: format!("{} factors are too many", chosen.len()),
            remedy: holds,
        });
    }
    let other = chosen.iter().find(|own| own.levels.len() != array.levels());
    match other {
        Some(factor) => Err(Problem {
            message: format!("factor {} has {} levels", factor.name, factor.levels.len()),
            remedy: holds,
        }),
        None => Ok(chosen),
    }
}

fn begin(arguments: &Arguments) -> anyhow::Result<Run<Orthogonal>> {
    let factors = factors(arguments)?;
    let LoadedCase {
        case,
        measured,
        synthetic,
        notes,
        ..
    } = arguments.choice.load()?;
    require_record(&arguments.choice.case, &case, case.objective.condition)?;
    let space = Space::new(&case.unknowns)?;
    let preset = preset(&arguments.preset).context("the catalogue has lost a preset")?;
    let seeds = (0..arguments.seeds).map(|block| arguments.seed.wrapping_add(block));
    let budget = (arguments.evaluations, seeds.collect());
    let (searches, set) = Searches::new(&space, preset, &arguments.settings.set, factors, budget)?;
    // every row can be built before anything runs
    searches.list(&space, &arguments.array.rows(searches.factors.len()))?;
    let settings = Orthogonal {
        array: arguments.array,
        searches,
    };
    let path = if let Some(path) = &arguments.run {
        path.clone()
    } else {
        let what = format!("sweep-{}", settings.array.name().to_lowercase());
        let decides = [settings.arguments() + " " + preset.name + " " + &set.join(" ")];
        let name = RunName {
            case_folder: &arguments.choice.case,
            case: &case,
            what: &what,
            set: &decides,
            measured: arguments.choice.measured.as_deref(),
            seed: arguments.seed,
        };
        name.path()?
    };
    let manifest = Manifest {
        preset: preset.name.to_owned(),
        set,
        measured,
        synthetic,
        notes,
        ..Manifest::new(&arguments.choice.case, arguments.seed, settings)?
    };
    Run::begin(&path, manifest, case)
}

/// Runs the orthogonal test from the first search to the confirmation.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let session = Session::begin();
    let run = begin(arguments)?;
    session.work(
        &run,
        &arguments.workers.session()?,
        async |dispatch, stop| {
            let mut display = Display::counting("searches done", run.case.objective_unit());
            display.resumed(dispatch.recorded());
            let tested = test(dispatch, &run, &mut display, stop).await;
            display.clear();
            Ok(dispatch.enter(&Entry::Tested(Box::new(tested?)))?)
        },
    )?;
    show_test(&run, arguments.output.output)
}
