//! `horsehead keys`: creates certificates for workers on other machines.
use crate::cli::{argument::workers::worker_count, output::problem::EXIT_CODES};
use clap::{Args, Subcommand};
use link::keys::{
    CA_KEY, KeyError, KeyRole, Keys, WORKER,
    authority::{Authority, Validity},
};
use run::message;
use std::path::{Path, PathBuf};
use support::Problem;

/// Make the certificates with which workers join over a network.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// Make an authority, the coordinator's certificate and one folder per worker.
    #[command(after_help = format!("\
Examples:
  horsehead keys new keys --workers 4 --host head.example
  horsehead keys new keys --host head --host 192.168.7.1 --days 90

The coordinator is started with --tls keys, a worker with --tls worker-01 once its folder
keys/worker-01 has been copied to its machine. One folder may serve any number of workers.

{EXIT_CODES}"))]
    New {
        /// Folder to make.
        folder: PathBuf,
        /// How many folders for workers to make: worker-01, worker-02 and so on.
        #[arg(long, value_name = "N", default_value_t = 4, env = "HORSEHEAD_WORKERS", value_parser = worker_count())]
        workers: usize,
        /// Name or address that workers dial; may be repeated [default: this machine's name].
        /// `localhost` and `127.0.0.1` are always there.
        #[arg(
            long,
            value_name = "NAME",
            env = "HORSEHEAD_HOST",
            value_delimiter = ','
        )]
        host: Vec<String>,
        /// How long the certificates are valid.
        #[arg(long, value_name = "DAYS", default_value_t = 365, env = "HORSEHEAD_DAYS", value_parser = clap::value_parser!(u32).range(1..=3650))]
        days: u32,
    },
    /// Issue certificates for further workers, each with a folder of its own.
    #[command(after_help = format!("\
Example:
  horsehead keys add keys rack2-node7

Its name joins the file `workers`, which a running coordinator reads again every second; taking a
line out of that file throws a worker out. While it runs, a coordinator has room for new names
of the form worker-01, worker-02; others may join when it is started again.

{EXIT_CODES}"))]
    Add {
        /// Folder that `keys new` made, with its `ca.key`.
        folder: PathBuf,
        /// Names of the workers.
        #[arg(required = true, value_name = "NAME")]
        names: Vec<String>,
        /// How long the certificates are valid.
        #[arg(long, value_name = "DAYS", default_value_t = 365, env = "HORSEHEAD_DAYS", value_parser = clap::value_parser!(u32).range(1..=3650))]
        days: u32,
    },
    /// Report whether a folder of certificates can be used, and for what.
    #[command(after_help = format!("Example:\n  horsehead keys check keys\n\n{EXIT_CODES}"))]
    Check {
        /// The coordinator's or a worker's folder.
        folder: PathBuf,
    },
}

/// Runs the selected action of `horsehead keys`: new, add or check.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    match &arguments.action {
        Action::New {
            folder,
            workers,
            host,
            days,
        } => make(folder, *workers, host, Validity::days(*days)),
        Action::Add {
            folder,
            names,
            days,
        } => add(folder, names, Validity::days(*days)),
        Action::Check { folder } => check(folder),
    }
    .map_err(|error| refuse(&error).into())
}

fn make(folder: &Path, workers: usize, hosts: &[String], valid: Validity) -> Result<(), KeyError> {
    let mut hosts = hosts.to_vec();
    if hosts.is_empty() {
        let name = rustix::system::uname();
        hosts.push(name.nodename().to_string_lossy().into_owned());
    }
    hosts.extend(["localhost", "127.0.0.1"].map(str::to_owned));
    hosts.dedup();
    let authority = Authority::create(folder)?;
    authority.issue_coordinator(&hosts, valid)?;
    for number in 1..=workers {
        authority.issue_worker(&format!("worker-{number:02}"), valid)?;
    }
    let at = folder.display();
    let dial = hosts.first().map_or("HEAD", String::as_str);
    message::print(&format!(
        "made {at} for {} and {workers} workers\n\
         coordinator: horsehead calibrate CASE --listen quic/0.0.0.0:7447 --tls {at}\n\
         each worker: copy {at}/worker-01 (or another) to its machine, then\n  \
         horsehead-worker --connect quic/{dial}:7447 --tls worker-01\n\
         {CA_KEY} signs the certificates of further workers and is needed for nothing else: keep it safe",
        hosts.join(", "),
    ));
    Ok(())
}

fn add(folder: &Path, names: &[String], valid: Validity) -> Result<(), KeyError> {
    let authority = Authority::open(folder)?;
    for name in names {
        let made = authority.issue_worker(name, valid)?;
        message::print(&format!("made {}", made.display()));
    }
    Ok(())
}

fn check(folder: &Path) -> Result<(), KeyError> {
    if folder.join(WORKER[0]).exists() {
        let keys = Keys::read(folder, KeyRole::Worker)?;
        message::print(&format!(
            "{} can be used by workers, as \"{}\"",
            folder.display(),
            keys.owner()
        ));
    } else {
        let keys = Keys::read(folder, KeyRole::Coordinator)?;
        let names: Vec<&str> = keys.workers().iter().map(String::as_str).collect();
        message::print(&format!(
            "{} can be used by a coordinator; {} workers may join: {}",
            folder.display(),
            names.len(),
            names.join(", ")
        ));
    }
    Ok(())
}

fn refuse(error: &KeyError) -> Problem {
    Problem {
        message: error.to_string(),
        remedy: String::new(),
    }
}
