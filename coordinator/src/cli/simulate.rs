//! `horsehead simulate`: one run of the machine.
use super::{
    CaseChoice, EXIT_CODES, OutputChoice, bus, condition, interrupt, json, output,
    problem::Usage,
    run_folder::{RunFolder, command_line},
};
use crate::{
    report::{self, Provenance, SingleRun, table},
    study::{self, Compared, Curves, Wanted, simulation_digest},
};
use anyhow::Context as _;
use clap::Args;
use protocol::case::Case;
use std::path::{Path, PathBuf};

/// Simulate one revolution: curves, verdict, counters.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Examples:
  horsehead simulate cases/cyjs10-5-37hb
  horsehead simulate cases/cyjs10-5-37hb --genes cases/cyjs10-5-37hb/table3_optimised.toml \\
      --condition 4rpm --out simulated

{EXIT_CODES}"))]
pub(super) struct Arguments {
    #[command(flatten)]
    choice: CaseChoice,
    /// Parameters: `recommended`, or a gene file such as a run's `calibrated.toml`.
    #[arg(
        long,
        value_name = "recommended|FILE",
        default_value = "recommended",
        env = "HORSEHEAD_GENES"
    )]
    genes: String,
    /// Working condition; that of the case's objective by default.
    #[arg(long, value_name = "NAME", env = "HORSEHEAD_CONDITION")]
    condition: Option<String>,
    /// Folder for the report, the figures and the curves; none are written without.
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_OUT")]
    out: Option<PathBuf>,
    #[command(flatten)]
    output: OutputChoice,
}

/// Simulates and shows.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let loaded = arguments.choice.load()?;
    let case = &loaded.case;
    let condition = condition(case, arguments.condition.as_deref())?;
    let genes = match arguments.genes.as_str() {
        "recommended" => case.recommended(),
        file => crate::case::read_genes(Path::new(file), case)?,
    };
    if let Some(folder) = &arguments.out {
        check_out(folder)?;
    }
    let individuals = vec![(arguments.genes.clone(), genes)];
    let motion_step_deg = if arguments.out.is_some() { 3.0 } else { 0.0 };
    let wanted = Wanted {
        condition,
        individuals,
        motion_step_deg,
    };
    let groups = compare_once("simulate", case, std::slice::from_ref(&wanted), 1)?;
    let curves = first(groups).context("no result came back")?;

    let run = SingleRun {
        case: case.clone(),
        provenance: Provenance {
            program: bus::PROGRAM.to_owned(),
            command: command_line(),
            run: format!("{} {}", case.name, case.conditions[condition].name),
            case_hash: bus::case_hash(case)?,
            measured_name: loaded.measured.clone(),
            preset: None,
            seed: None,
            digest: simulation_digest(&curves.simulation),
        },
        condition,
        genes_name: arguments.genes.clone(),
        genes: curves.genes.clone(),
        evaluation: curves.evaluation.clone(),
        simulation: curves.simulation.clone(),
        notes: loaded.notes.clone(),
    };
    if let Some(folder) = &arguments.out {
        let files = report::write_simulation(folder, &run)?;
        if let Some(first) = files.first() {
            output::tell(&format!(
                "wrote {} files; open {}",
                files.len(),
                first.display()
            ));
        }
    }
    let object = json::simulation((case, condition), &curves);
    let tables = || table::text(&table::simulation(&run), output::styled());
    output::print(arguments.output.output, tables, &object)
}

/// Refuses a folder that cannot be written, before anything is simulated for it.
fn check_out(folder: &Path) -> Result<(), Usage> {
    let tried = std::fs::create_dir_all(folder).and_then(|()| tempfile::tempfile_in(folder));
    match tried {
        Ok(_) => Ok(()),
        Err(error) => Err(Usage {
            message: format!("cannot write into {}: {error}", folder.display()),
            help: "choose a folder that can be written, with --out DIR".to_owned(),
        }),
    }
}

fn first(groups: Vec<Compared>) -> Option<Curves> {
    groups.into_iter().next()?.individuals.into_iter().next()
}

/// Scores and simulates on local workers, without a run folder that outlives the command.
pub(super) fn compare_once(
    kind: &str,
    case: &Case,
    wanted: &[Wanted],
    workers: usize,
) -> anyhow::Result<Vec<Compared>> {
    let scratch = tempfile::tempdir().context("cannot make a scratch folder")?;
    let settings = serde_json::to_string(&(kind, scratch.path()))?;
    bus::block_on(async {
        let mut stop = interrupt::listen();
        let options = bus::Options {
            run_dir: scratch.path().to_owned(),
            listen: None,
            insecure: false,
            local_workers: workers,
            kind: kind.to_owned(),
            settings,
        };
        let mut bus = bus::Bus::open(options, case).await?;
        let result = study::compare(&mut bus, case, wanted, &mut stop).await;
        bus.close().await?;
        Ok(result?)
    })
}

/// Where a run's result was kept, as the tables name it.
pub(super) fn run_name(folder: &RunFolder) -> String {
    folder.path().display().to_string()
}
