//! The command line: one command per file, each with the same habits.
//!
//! Results go to standard output, everything else to standard error. `--output json` prints
//! exactly one object. Exit codes: 0 done, 1 failed, 2 usage or bad input, 130 interrupted.
mod answer;
mod bench;
mod bus;
mod calibrate;
mod case;
mod completions;
mod diagnose;
mod diagnosed;
mod diagnosis_json;
mod explain;
mod export;
mod finish;
mod head;
mod head_files;
mod integrators;
mod interrupt;
mod json;
mod keys;
mod output;
mod problem;
mod progress;
mod report;
mod run_folder;
mod simulate;
mod verify;
mod whole_box;

use clap::{
    Args, Parser, Subcommand, ValueEnum,
    builder::{RangedU64ValueParser, TypedValueParser},
};
use problem::Usage;
use std::{
    path::{Path, PathBuf},
    process::ExitCode,
};

/// What the help of every command ends with.
const EXIT_CODES: &str = "\
Exit codes: 0 done, 1 failed, 2 usage or bad input, 130 interrupted.";

/// Makes a simulation of a rope-driven pumping unit agree with its strain gauges.
#[derive(Debug, Parser)]
#[command(name = "horsehead", version, max_term_width = 100, after_help = FIRST_STEPS)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

const FIRST_STEPS: &str = "\
First steps:
  horsehead case check cases/cyjs10-5-37hb
  horsehead simulate cases/cyjs10-5-37hb
  horsehead calibrate cases/cyjs10-5-37hb
  horsehead diagnose cases/cyjs10-5-37hb

Exit codes: 0 done, 1 failed, 2 usage or bad input, 130 interrupted.";

#[derive(Debug, Subcommand)]
enum Command {
    Simulate(simulate::Arguments),
    Calibrate(calibrate::Arguments),
    Verify(verify::Arguments),
    Diagnose(diagnose::Arguments),
    Head(head::Arguments),
    Report(report::Arguments),
    Explain(explain::Arguments),
    Export(export::Arguments),
    Case(case::Arguments),
    Keys(keys::Arguments),
    Bench(bench::Arguments),
    Completions(completions::Arguments),
}

/// How results are printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Output {
    /// Tables for people.
    Table,
    /// One JSON object for programs.
    Json,
}

/// The choice of output, shared by all commands.
#[derive(Clone, Copy, Debug, Args)]
struct OutputChoice {
    /// How results are printed on standard output.
    #[arg(long, value_enum, default_value = "table", env = "HORSEHEAD_OUTPUT")]
    output: Output,
}

/// Where a case comes from, shared by commands that read one.
#[derive(Clone, Debug, Args)]
struct CaseChoice {
    /// Case folder, with `case.toml` in it.
    #[arg(value_name = "CASE")]
    case: PathBuf,
    /// Folder whose load cards and gauge records replace those of the case: a new test of the
    /// same machine.
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_MEASURED")]
    measured: Option<PathBuf>,
}

/// Which parameters are simulated, and under which condition.
#[derive(Clone, Debug, Args)]
struct IndividualChoice {
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
}

impl IndividualChoice {
    /// Its genes in the case's order.
    fn genes(&self, case: &protocol::case::Case) -> anyhow::Result<Vec<f64>> {
        Ok(match self.genes.as_str() {
            "recommended" => case.recommended(),
            file => crate::case::read_genes(Path::new(file), case)?,
        })
    }

    /// Position of its condition in the case.
    fn condition(&self, case: &protocol::case::Case) -> Result<usize, Usage> {
        condition(case, self.condition.as_deref())
    }
}

/// How workers on other machines may join; not at all by default.
#[derive(Clone, Debug, Default, Args)]
struct Door {
    /// Where workers on other machines may connect, as `quic/0.0.0.0:7447`.
    #[arg(long, value_name = "LOCATOR", env = "HORSEHEAD_LISTEN")]
    listen: Option<String>,
    /// Folder of certificates for `quic/` addresses, as `horsehead keys new` makes it.
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_TLS")]
    tls: Option<PathBuf>,
    /// Allow other machines to connect without certificates.
    #[arg(long, env = "HORSEHEAD_INSECURE")]
    insecure: bool,
}

/// A case that was read.
struct LoadedCase {
    case: protocol::case::Case,
    /// Where the records came from.
    measured: String,
    /// Whether the case says that they were computed.
    synthetic: bool,
    /// What there is to know about them.
    notes: Vec<String>,
}

impl CaseChoice {
    /// Reads the case; what is worth knowing goes to standard error.
    fn load(&self) -> anyhow::Result<LoadedCase> {
        load_case(&self.case, self.measured.as_deref())
    }
}

fn load_case(folder: &Path, measured: Option<&Path>) -> anyhow::Result<LoadedCase> {
    let overrides = crate::case::Overrides {
        measured: measured.map(Path::to_owned),
    };
    let loaded = crate::case::load_with_notes(folder, &overrides)?;
    let notes: Vec<String> = loaded.notes.iter().map(ToString::to_string).collect();
    for note in &notes {
        output::tell(&format!("note: {note}"));
    }
    let measured = measured.unwrap_or(folder).display().to_string();
    Ok(LoadedCase {
        case: loaded.case,
        measured,
        synthetic: loaded.synthetic,
        notes,
    })
}

/// Position of a condition by name; the calibrated one without.
fn condition(case: &protocol::case::Case, name: Option<&str>) -> Result<usize, Usage> {
    let Some(name) = name else {
        return Ok(case.objective.condition);
    };
    case.condition(name).ok_or_else(|| {
        let known: Vec<&str> = case.conditions.iter().map(|c| c.name.as_str()).collect();
        Usage {
            message: format!("the case has no condition `{name}`"),
            help: format!("it has: {}", known.join(", ")),
        }
    })
}

/// Numbers of local worker processes: more would only get in each other's way.
fn worker_count() -> impl TypedValueParser<Value = usize> {
    RangedU64ValueParser::<usize>::new().range(0..=1024)
}

/// How many local worker processes to start by default: one per core.
fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Runs the program; its exit code says how it ended.
pub fn main() -> ExitCode {
    let cli = Cli::parse();
    output::diagnostics();
    let ended = match cli.command {
        Command::Simulate(arguments) => simulate::run(&arguments),
        Command::Calibrate(arguments) => calibrate::run(&arguments),
        Command::Verify(arguments) => verify::run(&arguments),
        Command::Diagnose(arguments) => diagnose::run(&arguments),
        Command::Head(arguments) => head::run(&arguments),
        Command::Report(arguments) => report::run(&arguments),
        Command::Explain(arguments) => explain::run(&arguments),
        Command::Export(arguments) => export::run(&arguments),
        Command::Case(arguments) => case::run(&arguments),
        Command::Keys(arguments) => keys::run(&arguments),
        Command::Bench(arguments) => bench::run(&arguments),
        Command::Completions(arguments) => completions::run(&arguments),
    };
    match ended {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => problem::explain(&error),
    }
}

#[cfg(test)]
mod tests;
