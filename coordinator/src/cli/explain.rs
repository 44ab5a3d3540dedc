//! `horsehead explain`: why workers were idle, from the journal of a run.
use super::{EXIT_CODES, OutputChoice, output, run_folder::RunFolder};
use crate::{
    account::{self, RunAccount},
    journal,
    report::table,
};
use clap::Args;
use serde::Serialize;
use std::{collections::BTreeMap, path::PathBuf};

/// Say how the workers of a run spent their time, and why they were idle.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Example:
  horsehead explain runs/cyjs10-5-37hb-quick-seed1

Works while the run goes on, too: accounts are written each minute and when workers go.
{EXIT_CODES}"))]
pub(super) struct Arguments {
    /// Run folder of a calibration.
    #[arg(value_name = "RUN", env = "HORSEHEAD_RUN")]
    run: PathBuf,
    #[command(flatten)]
    output: OutputChoice,
}

/// What programs read.
#[derive(Debug, Serialize)]
struct ExplainOutput {
    /// The run's folder.
    run: String,
    /// Coordinator processes that worked on it.
    processes: u32,
    /// Results recorded.
    results: u64,
    /// Attempts that failed.
    failed_attempts: u64,
    /// Slot time by use (s).
    slot_seconds: BTreeMap<&'static str, f64>,
    /// Why slots were not useful.
    why: Vec<String>,
    /// Why workers went, with how often.
    left: Vec<(String, u64)>,
    /// What of the journal could not be read.
    damage: Vec<String>,
}

impl ExplainOutput {
    fn new(run: String, account: &RunAccount) -> Self {
        let seconds = |us: u64| us as f64 / 1e6;
        let mut slot_seconds: BTreeMap<&'static str, f64> = account
            .spent
            .kinds()
            .map(|(kind, us)| (kind, seconds(us)))
            .into();
        slot_seconds.insert("connected", seconds(account.spent.connected_us));
        Self {
            run,
            processes: account.processes,
            results: account.results,
            failed_attempts: account.failed,
            slot_seconds,
            why: account.reasons(),
            left: account.left.clone(),
            damage: account.damage.iter().map(ToString::to_string).collect(),
        }
    }
}

/// Reads the journal and explains.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let folder = RunFolder::at(&arguments.run)?;
    let account = account::read(&folder.file(journal::FILE))?;
    let object = ExplainOutput::new(arguments.run.display().to_string(), &account);
    let text = || {
        let mut lines = vec![
            table::text(&table::slot_time(&account.spent), output::styled())
                .trim_end()
                .to_owned(),
            format!(
                "{} results by {} workers under {} coordinator processes",
                object.results,
                account.workers.len(),
                object.processes
            ),
        ];
        lines.extend(object.why.iter().cloned());
        lines.extend(object.left.iter().map(|(why, times)| match times {
            1 => format!("a worker left: {why}"),
            _ => format!("{times} workers left: {why}"),
        }));
        lines.extend(object.damage.iter().cloned());
        lines.join("\n") + "\n"
    };
    output::print(arguments.output.output, text, &object)
}
