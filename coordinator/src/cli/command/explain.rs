//! `horsehead explain`: how workers spent their time and why they were idle, from the journal of a run.
use crate::cli::{
    argument::output::OutputChoice,
    output::{problem::EXIT_CODES, terminal},
};
use clap::Args;
use journal::account::{self, HostUse, JobUse, RunAccount};
use journal::event::Spent;
use report::table::{self, Table};
use run::folder::RunFolder;
use serde::Serialize;
use std::{collections::BTreeMap, path::PathBuf};

/// Maximum number of given-up jobs that the output lists individually.
const MOST_NAMED: usize = 10;

/// Say how the workers of a run spent their time, and why they were idle.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Example:
  horsehead explain runs/cyjs10-5-37hb-quick-seed1

Works while the run goes on, too: accounts are written each minute and when workers go.
{EXIT_CODES}"))]
pub(super) struct Arguments {
    /// Run folder of a calibration or diagnosis.
    #[arg(value_name = "RUN", env = "HORSEHEAD_RUN")]
    run: PathBuf,
    #[command(flatten)]
    output: OutputChoice,
}

/// JSON object printed by `explain --output json`.
#[derive(Debug, Serialize)]
struct ExplainOutput {
    run: String,
    /// Number of coordinator processes that have worked on the run, one after another.
    processes: u32,
    /// Total wall time of the run's coordinator processes, as far as the journal accounts for it (s).
    wall_s: f64,
    /// Number of simulation results recorded in the journal.
    results: u64,
    /// Number of failed attempts at jobs.
    failed_attempts: u64,
    /// Total time of all worker slots, divided by activity (s).
    slot_seconds: BTreeMap<&'static str, f64>,
    /// Work done by each machine, by host name.
    hosts: BTreeMap<String, HostOutput>,
    /// Durations of the run's jobs, by kind of job.
    jobs: BTreeMap<&'static str, JobOutput>,
    /// Reasons why worker slots did no useful work.
    why: Vec<String>,
    /// Reasons why workers left the run, each with its number of occurrences.
    left: Vec<(String, u64)>,
    /// Numbers of the jobs that were given up, each with the reason.
    given_up: Vec<(u64, String)>,
    /// Descriptions of the parts of the journal that could not be read.
    damage: Vec<String>,
}

/// Work done by one machine.
#[derive(Debug, Serialize)]
struct HostOutput {
    workers: u64,
    slots: u32,
    results: u64,
    failed_attempts: u64,
    slot_seconds: BTreeMap<&'static str, f64>,
}

/// Durations of the jobs of one kind.
#[derive(Debug, Serialize)]
struct JobOutput {
    results: u64,
    machine_failed: u64,
    median_s: f64,
    usual_s: f64,
    longest_s: f64,
    slot_s: f64,
    processor_s: f64,
}

fn slot_seconds(spent: &Spent) -> BTreeMap<&'static str, f64> {
    let connected = ("connected", spent.connected_us);
    let kinds = spent.kinds().into_iter().chain([connected]);
    kinds.map(|(kind, us)| (kind, us as f64 / 1e6)).collect()
}

impl ExplainOutput {
    fn new(run: String, account: &RunAccount) -> Self {
        let host = |(name, used): (&str, HostUse)| {
            let output = HostOutput {
                workers: used.workers,
                slots: used.slots,
                results: used.done,
                failed_attempts: used.failed,
                slot_seconds: slot_seconds(&used.spent),
            };
            (name.to_owned(), output)
        };
        let job = |(kind, used): (&&'static str, &JobUse)| {
            let output = JobOutput {
                results: used.results,
                machine_failed: used.machine_failed,
                median_s: used.median_s,
                usual_s: used.usual_s,
                longest_s: used.longest_s,
                slot_s: used.wall_s,
                processor_s: used.processor_s,
            };
            (*kind, output)
        };
        Self {
            run,
            processes: account.processes,
            wall_s: account.wall_s,
            results: account.results,
            failed_attempts: account.failed,
            slot_seconds: slot_seconds(&account.spent),
            hosts: account.hosts().into_iter().map(host).collect(),
            jobs: account.jobs.iter().map(job).collect(),
            why: account.reasons(),
            left: account.left.clone(),
            given_up: account.given_up.clone(),
            damage: journal::describe_damage(&account.damage),
        }
    }
}

/// Reads the journal of a run and prints how its workers spent their time.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let folder = RunFolder::at(&arguments.run)?;
    let account = account::read(&folder.file(journal::FILE))?;
    let object = ExplainOutput::new(arguments.run.display().to_string(), &account);
    terminal::print(arguments.output.output, || text(&account, &object), &object)
}

fn text(account: &RunAccount, object: &ExplainOutput) -> String {
    let shown = |shown: &Table| table::text(shown, terminal::style()).trim_end().to_owned();
    let several = |count: u64, one: &str| match count {
        1 => format!("1 {one}"),
        _ => format!("{count} {one}s"),
    };
    let mut lines = vec![
        format!(
            "{} by {} under {}",
            several(object.results, "result"),
            several(account.workers.len() as u64, "worker"),
            match object.processes {
                1 => "1 coordinator process".to_owned(),
                count => format!("{count} coordinator processes, one after the other"),
            },
        ),
        String::new(),
        shown(&report::slot_time(&account.spent)),
    ];
    lines.extend(object.why.iter().cloned());
    for more in [report::hosts(account), report::jobs(account)] {
        lines.extend([String::new(), shown(&more)]);
    }
    lines.extend(object.left.iter().map(|(why, times)| match times {
        1 => format!("a worker left: {why}"),
        _ => format!("{times} workers left: {why}"),
    }));
    let named = object.given_up.iter().take(MOST_NAMED);
    lines.extend(named.map(|(job, why)| format!("job {job} was given up: {why}")));
    if let Some(more @ 1..) = object.given_up.len().checked_sub(MOST_NAMED) {
        lines.push(format!("{more} more jobs were given up"));
    }
    lines.extend(object.damage.iter().cloned());
    lines.join("\n") + "\n"
}
