//! `horsehead verify`: scores the parameters found by a run under a condition that took no part in the fit.
use crate::cli::{
    argument::{
        case::load_case_at,
        individual::condition,
        output::OutputChoice,
        workers::{cores, worker_count},
    },
    output::{
        object::{calibration::VerifyOutput, score},
        problem::EXIT_CODES,
        terminal,
    },
};
use anyhow::Context as _;
use case::{read_genes, require_record};
use clap::Args;
use report::table;
use run::{
    calibration::{CalibrationRun, condition_result, pair},
    folder::GENES,
    message,
    session::temporary::compare_once,
};
use std::{path::PathBuf, time::Instant};
use study::CompareRequest;
use support::Problem;

/// Score a run's parameters under another working condition (the paper's Table 4).
#[derive(Debug, Args)]
#[command(after_help = format!("\
Example:
  horsehead verify runs/cyjs10-5-37hb-quick-seed1 --condition 4rpm

{EXIT_CODES}"))]
pub(super) struct Arguments {
    /// Run folder of a calibration.
    #[arg(value_name = "RUN", env = "HORSEHEAD_RUN")]
    run: PathBuf,
    /// Working condition; it must have a record.
    #[arg(long, value_name = "NAME", env = "HORSEHEAD_CONDITION")]
    condition: String,
    /// Folder whose inputs and records replace those of the case.
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_MEASURED")]
    measured: Option<PathBuf>,
    /// Worker processes to start [default: one per core].
    #[arg(long, value_name = "N", env = "HORSEHEAD_WORKERS", value_parser = worker_count())]
    workers: Option<usize>,
    #[command(flatten)]
    output: OutputChoice,
}

/// Scores the recommended and the optimised parameters and prints them side by side.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let started = Instant::now();
    let run = CalibrationRun::open(&arguments.run)?;
    let parameters = run.folder.file(GENES);
    if !parameters.exists() {
        return Err(Problem {
            message: format!(
                "{} has no calibrated parameters yet",
                arguments.run.display()
            ),
            remedy: format!("finish the run first:\n  {}", run.resume_command()),
        }
        .into());
    }
    let (case, best) = match arguments.measured.as_deref() {
        Some(measured) => {
            let folder = &run.manifest.case_folder;
            let (loaded, start) = load_case_at(folder, Some(measured), Some(&parameters))?;
            let start = start.context("the gene file was not read")?;
            (loaded.case, start.genes)
        }
        None => (run.case.clone(), read_genes(&parameters, &run.case)?),
    };
    let condition = condition(&case, Some(&arguments.condition))?;
    require_record(&run.manifest.case_folder, &case, condition)?;
    let wanted = CompareRequest {
        condition,
        first: 0,
        individuals: pair(&case, &best),
        frames: 0,
        columns: Vec::new(),
    };
    let workers = arguments.workers.unwrap_or_else(|| cores().min(4)).max(1);
    let groups = compare_once("verify", &case, std::slice::from_ref(&wanted), workers)?;
    let compared = groups.first().context("no result came back")?;
    let result = condition_result(compared).context("a result is missing")?;
    let [recommended, optimised] = compared.individuals.as_slice() else {
        anyhow::bail!("a result is missing");
    };
    let object = VerifyOutput {
        run: run.folder.path().display().to_string(),
        case: &case.name,
        condition: &arguments.condition,
        wall_s: started.elapsed().as_secs_f64(),
        scores: score::condition(&case, recommended, optimised),
        machine: report::condition_checks(&case, &result),
    };
    for note in &run.manifest.notes {
        message::print(&format!("note: {note}"));
    }
    let tables = || {
        let table = table::text(&table::table_4(&case, &result), terminal::style());
        let machine = report::machine(&object.machine, terminal::style());
        format!("{table}\n{machine}")
    };
    terminal::print(arguments.output.output, tables, &object)
}
