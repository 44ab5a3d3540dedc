//! `horsehead sweep scaling`: measures the speed-up of searches with the number of slots, and how slot time
//! is used.
use crate::cli::{
    argument::{
        case::{CaseChoice, LoadedCase},
        output::OutputChoice,
        workers::{RemoteChoice, cores},
    },
    output::{problem::EXIT_CODES, progress::Display, terminal},
};
use ::report::{scaling as report, text};
use anyhow::Context as _;
use case::require_record;
use clap::{Args, builder::PossibleValuesParser};
use run::{
    folder::RESULT,
    manifest::{Manifest, RunIdentity as _},
    message,
    name::RunName,
    opened::Run,
    scaling::{ScalingRun, ScalingSettings},
    scaling_remote,
    session::{dispatcher, interrupt, launch::RemoteWorkers},
};
use search::{space::Space, strategy::CATALOGUE};
use std::{fs, path::PathBuf};
use study::scaling::ScalingResult;
use support::Problem;

/// Measure how searches scale with slots; the same command resumes.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Examples:
  horsehead sweep scaling cases/cyjs10-5-37hb
  horsehead sweep scaling cases/cyjs10-5-37hb --presets paper,paper-batch,window --populations 40,80
  horsehead sweep scaling cases/cyjs10-5-37hb --ssh node1,node2,node3,node4 --nodes 1,2,4
  horsehead sweep scaling cases/cyjs10-5-37hb --listen quic/0.0.0.0:7447 --tls keys --nodes 8
  horsehead sweep scaling cases/cyjs10-5-37hb --crews 1,2,4,8 --output json

Workers of this machine and remote ones simulate the case.

{EXIT_CODES}"))]
pub(super) struct Arguments {
    #[command(flatten)]
    choice: CaseChoice,
    /// Presets of `horsehead calibrate` to search with.
    #[arg(
        long,
        value_name = "NAME,..",
        value_delimiter = ',',
        default_value = "paper,window,quick,least-squares,hybrid",
        env = "HORSEHEAD_PRESETS",
        value_parser = PossibleValuesParser::new(CATALOGUE.iter().map(|preset| preset.name))
    )]
    presets: Vec<String>,
    /// Population sizes, for presets that have one [default: that of each preset].
    #[arg(long, value_name = "N,..", value_delimiter = ',', env = "HORSEHEAD_POPULATIONS", value_parser = clap::value_parser!(u64).range(4..=100_000))]
    populations: Vec<u64>,
    /// Evaluations of each search.
    #[arg(long, value_name = "N", default_value_t = 160, env = "HORSEHEAD_EVALUATIONS", value_parser = clap::value_parser!(u64).range(4..=1_000_000))]
    evaluations: u64,
    /// Worker processes of this machine that simulate; 0 for none [default: 1 and one per core].
    #[arg(long, value_name = "N,..", value_delimiter = ',', env = "HORSEHEAD_CREWS", value_parser = clap::value_parser!(u64).range(0..=1024))]
    crews: Vec<u64>,
    /// Numbers of remote workers to measure with [default: one for each host of --ssh or --hosts].
    #[arg(long, value_name = "N,..", value_delimiter = ',', env = "HORSEHEAD_NODES", value_parser = clap::value_parser!(u64).range(1..=1000))]
    nodes: Vec<u64>,
    /// Fixes every random choice.
    #[arg(long, default_value_t = 1, env = "HORSEHEAD_SEED")]
    seed: u64,
    /// Run folder [default: runs/CASE-sweep-scaling-set-HASH-seedN, the hash that of all options].
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_RUN")]
    run: Option<PathBuf>,
    #[command(flatten)]
    output: OutputChoice,
    #[command(flatten)]
    remote: RemoteChoice,
}

fn counts(all: &[u64]) -> Vec<u64> {
    let mut counts: Vec<u64> = all.iter().copied().filter(|count| *count > 0).collect();
    counts.sort_unstable();
    counts.dedup();
    counts
}

/// Returns the numbers of remote workers to measure with; none if no remote workers are admitted.
fn nodes(arguments: &Arguments, remote: &RemoteWorkers) -> Result<Vec<u64>, Problem> {
    let hosts = remote.hosts.len() as u64;
    let nodes = counts(&arguments.nodes);
    let refuse = |message: String, remedy: &str| {
        Err(Problem {
            message,
            remedy: remedy.to_owned(),
        })
    };
    match (arguments.remote.has_others(), nodes.last()) {
        (false, Some(_)) => refuse(
            "--nodes counts remote workers, and none can connect".to_owned(),
            "name hosts with --ssh, or an address with --listen",
        ),
        (true, Some(most)) if hosts > 0 && *most > hosts => refuse(
            format!("--nodes {most}: there are {hosts} hosts"),
            "name more hosts with --ssh or --hosts",
        ),
        (true, None) if hosts == 0 => refuse(
            "it is not known how many workers will connect".to_owned(),
            "say how many to wait for with --nodes N",
        ),
        (true, None) => Ok(vec![hosts]),
        (_, Some(_) | None) => Ok(nodes),
    }
}

fn begin(arguments: &Arguments, remote: &RemoteWorkers) -> anyhow::Result<Run<ScalingSettings>> {
    let LoadedCase {
        case,
        measured,
        synthetic,
        notes,
        ..
    } = arguments.choice.load()?;
    require_record(&arguments.choice.case, &case, case.objective.condition)?;
    let crews = match arguments.crews.as_slice() {
        [] => vec![1, cores() as u64],
        some => some.to_vec(),
    };
    let settings = ScalingSettings {
        presets: arguments.presets.clone(),
        populations: counts(&arguments.populations),
        evaluations: arguments.evaluations,
        crews: counts(&crews),
        nodes: nodes(arguments, remote)?,
    };
    if settings.crews.is_empty() && settings.nodes.is_empty() {
        return Err(Problem {
            message: "there is nothing to measure on".to_owned(),
            remedy: "name numbers of worker processes with --crews, or remote workers with --ssh or --listen"
                .to_owned(),
        }
        .into());
    }
    // every search can be made before anything runs
    let space = Space::new(&case.unknowns)?;
    for search in settings.searches() {
        ScalingSettings::settings(search, &space, 1)?;
    }
    let path = if let Some(path) = &arguments.run {
        path.clone()
    } else {
        let decides = [settings.arguments()];
        let name = RunName {
            case_folder: &arguments.choice.case,
            case: &case,
            what: "sweep-scaling",
            set: &decides,
            measured: arguments.choice.measured.as_deref(),
            seed: arguments.seed,
        };
        name.path()?
    };
    let manifest = Manifest {
        measured,
        synthetic,
        notes,
        ..Manifest::new(&arguments.choice.case, arguments.seed, settings)?
    };
    Run::begin(&path, manifest, case)
}

/// Measures and prints the scaling of the searches.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let remote = arguments.remote.workers()?;
    let run = begin(arguments, &remote)?;
    let folder = run.folder.path();
    fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    run.save(0.0)?;
    let scaled = dispatcher::block_on(async {
        let mut stop = interrupt::listen();
        let mut display = Display::counting("searches done", run.case.objective_unit());
        let space = run.manifest.space(&run.case)?;
        let mut scale = ScalingRun::new(&run, &space);
        let scaled = async {
            let mut measured = scale.measure_local(&mut display, &mut stop).await?;
            measured.extend(
                scaling_remote::measure(&mut scale, &remote, &mut display, &mut stop).await?,
            );
            anyhow::Ok(ScalingResult::new(measured))
        };
        let scaled = scaled.await;
        display.clear();
        scaled
    });
    let scaled = scaled.inspect_err(|_| {
        let path = run.folder.path().display();
        let command = &run.manifest.command;
        message::print(&format!(
            "the rows finished so far are kept in {path}; to resume:\n  {command}"
        ));
    })?;
    show(&run, &scaled, arguments.output)
}

/// Writes the result files of a finished scaling sweep and prints its result.
fn show(
    run: &Run<ScalingSettings>,
    scaled: &ScalingResult,
    output: OutputChoice,
) -> anyhow::Result<()> {
    let subject = report::ScalingInput {
        case: &run.case,
        scaled,
        origin: run.origin(String::new())?,
    };
    let files = report::write(run.folder.path(), &subject)?;
    run.folder.write_json(RESULT, scaled)?;
    let page = files.first().map(|page| page.display().to_string());
    message::print(&format!("open {}", page.unwrap_or_default()));
    let tables = || text(&report::report(&subject), terminal::style());
    terminal::print(output.output, tables, scaled)
}
