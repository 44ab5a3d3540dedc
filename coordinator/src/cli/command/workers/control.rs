//! `workers list`, `drain` and `down`: send requests to the coordinator process of a run over its control
//! socket.
use crate::cli::{
    argument::{nodes::HostsChoice, output::OutputChoice},
    output::terminal,
};
use clap::Args;
use dispatch::runtime::control::{self, SOCKET, messages::ControlRequest};
use dispatch::scheduler::{WorkerPhase, WorkerReport};
use launch::ssh::{self, EndedWorkers};
use report::table::{Row, Table, text};
use run::{message, session::launch::execute};
use serde::Serialize;
use std::{
    fs,
    path::{Path, PathBuf},
};
use support::Problem;

pub(super) const LIST: &str = "\
Examples:
  horsehead workers list
  horsehead workers list --run runs/cyjs10-5-37hb-quick-seed1 --output json";

pub(super) const DRAIN: &str = "\
Examples:
  horsehead workers drain worker-03
  horsehead workers drain node7 --now --run runs/cyjs10-5-37hb-quick-seed1

A worker is named by its keys, its host or its id. It stays, idle, until the run ends or
`horsehead workers down` ends it.";

pub(super) const DOWN: &str = "\
Examples:
  horsehead workers down worker-03
  horsehead workers down --now
  horsehead workers down --ssh node1,node2
  horsehead workers down --ssh node1,node2 --all

Through the run, workers finish their jobs and end, all of them if none is named. With --ssh or
--hosts the processes that `workers up` launched there are ended at once, whether a run goes on or
not; what they hold is given to others. Workers of a run that was started with --ssh end with that
run, or with --all.";

/// Argument that selects a run.
#[derive(Debug, Args)]
pub(super) struct RunChoice {
    /// Run folder [default: the only one below runs/ with a running coordinator].
    #[arg(long, value_name = "RUN", env = "HORSEHEAD_RUN")]
    run: Option<PathBuf>,
}

/// Arguments of `workers list`.
#[derive(Debug, Args)]
pub(super) struct ListArguments {
    #[command(flatten)]
    run: RunChoice,
    #[command(flatten)]
    output: OutputChoice,
}

/// Arguments of `workers drain`.
#[derive(Debug, Args)]
pub(super) struct DrainArguments {
    /// Workers, by name, host or id.
    #[arg(required = true, value_name = "NAME")]
    names: Vec<String>,
    /// Return at once the jobs that the workers hold.
    #[arg(long, env = "HORSEHEAD_NOW")]
    now: bool,
    #[command(flatten)]
    run: RunChoice,
}

/// Arguments of `workers down`.
#[derive(Debug, Args)]
pub(super) struct DownArguments {
    /// Workers, by name, host or id [default: all but those that the run started on its own machine].
    #[arg(value_name = "NAME", conflicts_with_all = ["ssh", "hosts"])]
    names: Vec<String>,
    /// Return at once the jobs that the workers hold.
    #[arg(long, env = "HORSEHEAD_NOW")]
    now: bool,
    /// End all workers: also those that the run started on its own machine; with --ssh or --hosts, also
    /// those there that were not launched by `workers up`.
    #[arg(long, conflicts_with = "names", env = "HORSEHEAD_ALL")]
    all: bool,
    #[command(flatten)]
    run: RunChoice,
    #[command(flatten)]
    hosts: HostsChoice,
}

/// JSON object printed by `workers list --output json`; a stable format: keys are never removed or redefined.
#[derive(Debug, Serialize)]
struct ListOutput<'a> {
    run: String,
    workers: &'a [WorkerReport],
}

pub(super) fn list(arguments: &ListArguments) -> anyhow::Result<()> {
    let folder = arguments.run.folder()?;
    let workers = ask(&folder, &ControlRequest::List)?;
    let object = ListOutput {
        run: folder.display().to_string(),
        workers: &workers,
    };
    terminal::print(arguments.output.output, || table(&workers), &object)
}

/// Stops the assignment of jobs to the named workers.
pub(super) fn drain(arguments: &DrainArguments) -> anyhow::Result<()> {
    let question = ControlRequest::Drain {
        names: arguments.names.clone(),
        now: arguments.now,
        end: false,
    };
    let workers = ask(&arguments.run.folder()?, &question)?;
    print_request(&workers, arguments.now, "gets no more jobs");
    Ok(())
}

/// Ends workers, through the coordinator of the run or directly over ssh.
pub(super) fn down(arguments: &DownArguments) -> anyhow::Result<()> {
    let hosts = arguments.hosts.read()?;
    if !hosts.is_empty() {
        let which = if arguments.all {
            EndedWorkers::All
        } else {
            EndedWorkers::Unowned
        };
        return execute(&ssh::down(&hosts, which));
    }
    let folder = arguments.run.folder()?;
    let mut names = arguments.names.clone();
    if names.is_empty() && !arguments.all {
        let workers = ask(&folder, &ControlRequest::List)?;
        let all = workers.len();
        let remote = workers.into_iter().filter(|worker| !worker.local);
        names = remote.map(|worker| worker.id).collect();
        if names.is_empty() {
            message::print(&match all {
                0 => "no worker takes part".to_owned(),
                all => format!(
                    "the run started its {all} workers itself and needs them; --all ends them too"
                ),
            });
            return Ok(());
        }
    }
    let question = ControlRequest::Drain {
        names,
        now: arguments.now,
        end: true,
    };
    let workers = ask(&folder, &question)?;
    print_request(&workers, arguments.now, "ends");
    Ok(())
}

/// Prints for each drained or ended worker what happens to it and to the jobs that it holds.
fn print_request(workers: &[WorkerReport], now: bool, what: &str) {
    for WorkerReport {
        name, host, jobs, ..
    } in workers
    {
        let held = match (jobs.len(), now) {
            (0, _) => String::new(),
            (held, true) => format!(", and hands back {held} jobs"),
            (held, false) => format!(" after the {held} jobs that it holds"),
        };
        message::print(&format!("{name} on {host} {what}{held}"));
    }
    if workers.is_empty() {
        message::print("no worker takes part");
    }
}

fn ask(folder: &Path, question: &ControlRequest) -> anyhow::Result<Vec<WorkerReport>> {
    Ok(
        control::send_request(folder, question).map_err(|error| {
            Problem {
        message: error.to_string(),
        remedy:
            "`horsehead workers list --run RUN` with the folder of a run that goes on shows its \
               workers"
                .to_owned(),
    }
        })?,
    )
}

impl RunChoice {
    /// Returns the run folder given by the user, or else the only one below `runs/` whose coordinator
    /// answers.
    ///
    /// # Errors
    /// If no coordinator or more than one answers.
    fn folder(&self) -> anyhow::Result<PathBuf> {
        if let Some(folder) = &self.run {
            return Ok(folder.clone());
        }
        let entries = fs::read_dir("runs").into_iter().flatten().flatten();
        let with_socket = entries.map(|entry| entry.path());
        let with_socket = with_socket.filter(|folder| folder.join(SOCKET).exists());
        let answers =
            |folder: &PathBuf| control::send_request(folder, &ControlRequest::List).is_ok();
        let mut found: Vec<PathBuf> = with_socket.filter(answers).collect();
        match (found.pop(), found.len()) {
            (Some(folder), 0) => Ok(folder),
            (None, _) => Err(Problem {
                message: "no run below runs/ has a running coordinator".to_owned(),
                remedy: "give the folder of a run in progress with --run RUN".to_owned(),
            }
            .into()),
            (Some(folder), more) => Err(Problem {
                message: format!("{} runs are in progress", more + 1),
                remedy: format!("name one of them, as --run {}", folder.display()),
            }
            .into()),
        }
    }
}

fn table(workers: &[WorkerReport]) -> String {
    let row = |worker: &WorkerReport| {
        let state = match worker.state {
            WorkerPhase::Joining => "joining",
            WorkerPhase::Working => "working",
            WorkerPhase::Draining => "draining",
            WorkerPhase::Drained => "drained",
        };
        let jobs = worker.jobs.iter().take(worker.slots as usize);
        let jobs: Vec<String> = jobs
            .map(|job| format!("{} ({:.0} s)", job.job, job.for_s))
            .collect();
        Row::new(
            format!("{} {}", worker.name, worker.id),
            [
                worker.host.clone(),
                worker.slots.to_string(),
                worker.version.clone(),
                state.to_owned(),
                if jobs.is_empty() {
                    "-".to_owned()
                } else {
                    jobs.join(", ")
                },
                worker.done.to_string(),
                format!("{:.1}", worker.per_minute),
                format!("{:.0} s", worker.last_seen_s),
            ],
        )
    };
    let head = [
        "worker",
        "host",
        "slots",
        "version",
        "state",
        "jobs in hand",
        "done",
        "a minute",
        "last seen",
    ];
    let rows: Vec<Row> = workers.iter().map(row).collect();
    if rows.is_empty() {
        return "no worker takes part\n".to_owned();
    }
    text(&Table::new("Workers", head, rows), terminal::style())
}
