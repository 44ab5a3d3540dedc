//! `workers up` and `workers logs`: builds a launch plan from the arguments, and prints or executes it.
use crate::cli::{
    argument::nodes::{HostsChoice, LaunchChoice},
    output::terminal,
};
use clap::{ArgGroup, Args};
use launch::{LaunchPlan, WorkerOptions, k8s, keys, slurm, ssh, systemd};
use link::{
    keys::{KeyRole, Keys},
    locator::{Locator, Protocol},
};
use run::session::launch::{execute, programs};
use std::{
    env,
    path::{Path, PathBuf},
    process::Command,
};
use support::Problem;

pub(super) const EXAMPLES: &str = "\
Examples:
  horsehead workers up --connect quic/head:7447 --tls keys --ssh node1,node2,me@node3:2222
  horsehead workers up --connect quic/head:7447 --tls keys --hosts hosts.txt --dry-run
  horsehead workers up --connect quic/head:7447 --tls keys --slurm nodes=4,time=02:00:00
  horsehead workers up --connect quic/10.0.0.1:7447 --tls keys --k8s replicas=4
  horsehead workers up --connect quic/head:7447 --tls keys --systemd slots=2

--dry-run prints all of it as a script of the shell, contacts nobody and writes nothing. Keys are
read from their folder and shown nowhere. A line of a file of hosts is `USER@HOST:PORT slots=N`.";

pub(super) const LOGS: &str = "\
Examples:
  horsehead workers logs --ssh node1
  horsehead workers logs worker-03 --tls keys";

/// Arguments of `workers up`: which workers to start, and where.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("place").required(true).args(["ssh", "hosts", "slurm", "k8s", "systemd"]))]
pub(super) struct Arguments {
    /// Address that workers dial: the coordinator's `--listen` as reachable from their hosts.
    #[arg(long, value_name = "LOCATOR", env = "HORSEHEAD_CONNECT", value_parser = Locator::parse)]
    connect: Locator,
    /// Folder that `horsehead keys new` made, for quic/ addresses.
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_TLS")]
    tls: Option<PathBuf>,
    #[command(flatten)]
    hosts: HostsChoice,
    /// A Slurm job: options of sbatch as KEY=VALUE, such as nodes=4,time=02:00:00.
    #[arg(long, value_name = "OPTIONS", env = "HORSEHEAD_SLURM")]
    slurm: Option<String>,
    /// A Kubernetes deployment: replicas=N, image=NAME, namespace=NAME, cpu=N, memory=SIZE.
    #[arg(long, value_name = "OPTIONS", env = "HORSEHEAD_K8S")]
    k8s: Option<String>,
    /// A unit of your systemd on this machine: slots=N.
    #[arg(long, value_name = "OPTIONS", env = "HORSEHEAD_SYSTEMD", num_args = 0..=1, default_missing_value = "")]
    systemd: Option<String>,
    /// Print what would be done, as a script, and do nothing.
    #[arg(long, env = "HORSEHEAD_DRY_RUN")]
    dry_run: bool,
    /// Time without work after which workers end; 0 for never.
    #[arg(
        long,
        value_name = "SECONDS",
        env = "HORSEHEAD_IDLE_TIMEOUT",
        default_value_t = 3600
    )]
    idle_timeout: u64,
    /// Time within which each host's worker must appear in a run; 0 to start it without checking.
    #[arg(
        long,
        value_name = "SECONDS",
        env = "HORSEHEAD_WAIT",
        default_value_t = 20
    )]
    wait: u64,
    #[command(flatten)]
    launch: LaunchChoice,
    /// Further argument of sbatch, as `--sbatch-arg=--account=physics`; may be repeated.
    #[arg(long, value_name = "ARG", env = "HORSEHEAD_SBATCH_ARG")]
    sbatch_arg: Vec<String>,
}

/// Arguments of `workers logs`.
#[derive(Debug, Args)]
pub(super) struct LogsArguments {
    /// Worker, by the name of its keys.
    #[arg(required_unless_present_any = ["ssh", "hosts"], requires = "tls")]
    name: Option<String>,
    /// Folder of keys, in which the worker's host is recorded.
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_TLS")]
    tls: Option<PathBuf>,
    #[command(flatten)]
    hosts: HostsChoice,
}

/// Builds the plan for launching workers, and prints it (`--dry-run`) or executes it.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let plan = plan(arguments)?;
    if arguments.dry_run {
        return terminal::write(&plan.to_string());
    }
    execute(&plan)
}

fn plan(arguments: &Arguments) -> Result<LaunchPlan, Problem> {
    let tls = match (arguments.connect.protocol, &arguments.tls) {
        (Protocol::Unix, _) => {
            return Err(Problem {
                message: format!(
                    "{} can be reached from this machine alone",
                    arguments.connect
                ),
                remedy: format!(
                    "give the coordinator a quic/ address; on this machine start horsehead-worker --connect {}",
                    arguments.connect
                ),
            });
        }
        (Protocol::Tcp, _) => None,
        (Protocol::Quic, Some(folder)) => Some(absolute(folder)),
        (Protocol::Quic, None) => {
            return Err(Problem {
                message: format!("{} needs certificates: give --tls DIR", arguments.connect),
                remedy: "`horsehead keys new DIR --host NAME` makes them".to_owned(),
            });
        }
    };
    let order = WorkerOptions {
        connect: arguments.connect.clone(),
        tls,
        idle_timeout: Some(arguments.idle_timeout).filter(|seconds| *seconds > 0),
        slots: arguments.launch.slots,
        prologue: arguments.launch.prologue()?,
        owner: String::new(),
    };
    if let Some(options) = &arguments.k8s {
        return k8s::up(&order, options, shared_key_folder(&order)?.as_deref());
    }
    let programs = programs(&arguments.launch.worker_program)?;
    let own = programs.first().ok_or_else(|| Problem {
        message: "there is no worker program".to_owned(),
        remedy: "name one with --worker-program ARCH=PATH".to_owned(),
    })?;
    if let Some(options) = &arguments.slurm {
        let name = shared_key_folder(&order)?;
        return slurm::up(&order, options, &arguments.sbatch_arg, own, name.as_deref());
    }
    if let Some(options) = &arguments.systemd {
        let home = env::var_os("HOME").map_or_else(PathBuf::new, PathBuf::from);
        let usual = home.join(".config");
        let configuration = env::var_os("XDG_CONFIG_HOME").map_or(usual, PathBuf::from);
        let name = shared_key_folder(&order)?;
        return systemd::up(&order, options, own, name.as_deref(), &configuration);
    }
    ssh::up(&order, &arguments.hosts.read()?, &programs, arguments.wait)
}

/// Returns the name of the key folder that all workers of a launch use, for launches with a common file
/// system or secret; `None` without TLS.
fn shared_key_folder(order: &WorkerOptions) -> Result<Option<String>, Problem> {
    let Some(folder) = &order.tls else {
        return Ok(None);
    };
    let read = Keys::read(folder, KeyRole::Coordinator);
    let name = read.map(|keys| {
        keys.workers()
            .iter()
            .find(|name| folder.join(name).is_dir())
            .cloned()
    });
    match name {
        Ok(Some(name)) => Ok(Some(name)),
        Ok(None) => Err(Problem {
            message: format!("{} has no folder of a worker", folder.display()),
            remedy: "`horsehead keys add DIR worker-01` makes one".to_owned(),
        }),
        Err(error) => Err(Problem {
            message: error.to_string(),
            remedy: "--tls takes the folder that `horsehead keys new DIR --host NAME` made"
                .to_owned(),
        }),
    }
}

fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

/// Prints the end of the worker logs of the given hosts.
pub(super) fn logs(arguments: &LogsArguments) -> anyhow::Result<()> {
    let hosts = match (&arguments.name, &arguments.tls) {
        (Some(name), Some(folder)) => vec![keys::host_of(folder, name)?],
        _ => arguments.hosts.read()?,
    };
    for host in hosts {
        let command = ssh::logs(&host);
        let words = command.iter().skip(1);
        let status = Command::new("ssh").args(words).status();
        if !status.is_ok_and(|status| status.success()) {
            anyhow::bail!("{host}: its log cannot be shown");
        }
    }
    Ok(())
}
