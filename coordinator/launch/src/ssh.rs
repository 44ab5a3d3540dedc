//! Workers on hosts reachable by `ssh`, using the user's own `ssh` and its configuration.
//!
//! On a host all files lie below `~/.cache/horsehead` (or `$XDG_CACHE_HOME`), readable by their owner only:
//! programs by the hash of their content, copied once, and a folder per worker with its keys, log, process id
//! and command line.
mod script;

use super::{
    execute::{self, Cancellation, LaunchError},
    host::Host,
    keys,
    plan::{LaunchPlan, PlanPart, PlanStep, STEP, StepInput},
    program::Program,
    shell::line,
    worker_options::WorkerOptions,
};
use link::keys::{CA, WORKER};
use std::time::Duration;
use support::Problem;

/// Options of every ssh call: no prompts at the terminal, and a timeout for hosts that do not respond.
const OPTIONS: [&str; 4] = [
    "BatchMode=yes",
    "ConnectTimeout=15",
    "ServerAliveInterval=5",
    "ServerAliveCountMax=3",
];

/// Maximum time for copying a worker program to a host.
const COPY: Duration = Duration::from_mins(15);
/// Maximum time for ending the workers of a host, which is part of ending a command.
const DOWN: Duration = Duration::from_secs(30);

/// Plans one worker per host, each with the program for its architecture and its own keys, and a check
/// lasting up to `wait_s` seconds that the worker takes part (0: no check).
///
/// # Errors
/// [`Problem`] if there are no keys for a host, or a host is named twice.
pub fn up(
    order: &WorkerOptions,
    hosts: &[Host],
    programs: &[Program],
    wait_s: u64,
) -> Result<LaunchPlan, Problem> {
    for (at, host) in hosts.iter().enumerate() {
        if hosts
            .iter()
            .take(at)
            .any(|other| other.to_string() == host.to_string())
        {
            return Err(Problem::new(
                format!("{host} is named twice"),
                "a host has one worker with a slot for each of its cores",
            ));
        }
    }
    let (names, first) = if let Some(folder) = &order.tls {
        keys::assign(folder, hosts)?
    } else {
        let names = (1..=hosts.len()).map(|number| format!("worker-{number:02}"));
        (names.collect(), Vec::new())
    };
    let parts = hosts.iter().zip(names).map(|(host, name)| {
        let order = WorkerOptions {
            slots: host.slots.or(order.slots),
            ..order.clone()
        };
        part(&order, host, &name, programs, wait_s)
    });
    Ok(LaunchPlan {
        local_steps: first,
        parts: parts.collect(),
    })
}

fn part(
    order: &WorkerOptions,
    host: &Host,
    name: &str,
    programs: &[Program],
    wait_s: u64,
) -> PlanPart {
    let folder = &format!("{name}{}", owner_suffix(order));
    let mut steps = vec![PlanStep::Run {
        what: "see whether a worker can run there".to_owned(),
        command: shell(host, "sh -s"),
        input: StepInput::Text(script::probe(programs)),
        only_if: None,
        asks: true,
        limit: STEP,
        remedy: "name a program for it with --worker-program ARCH=PATH; deploy/portable.sh builds \
                 one for older systems"
            .to_owned(),
    }];
    steps.extend(programs.iter().map(|program| PlanStep::Run {
        what: "copy the worker there".to_owned(),
        command: shell(host, &as_sh_command(&script::copy(program))),
        input: StepInput::File(program.path.clone()),
        only_if: Some(format!("need {}", program.machine)),
        asks: false,
        limit: COPY,
        remedy: "make room in its ~/.cache/horsehead, or set XDG_CACHE_HOME there".to_owned(),
    }));
    if let Some(keys) = &order.tls {
        let from = keys.join(name).display().to_string();
        let tar = ["tar", "-C", &from, "-cf", "-", CA, WORKER[0], WORKER[1]];
        steps.push(PlanStep::Run {
            what: format!("give it the keys of {name}"),
            command: shell(host, &as_sh_command(&script::take_keys(folder))),
            input: StepInput::Command(tar.map(str::to_owned).to_vec()),
            only_if: None,
            asks: false,
            limit: STEP,
            remedy: format!("see what `horsehead keys check {from}` says; the host needs tar"),
        });
    }
    // what loads modules is written for bash and for logins
    let reader = if order.prologue.is_empty() {
        "sh -s"
    } else {
        "bash -l -s"
    };
    steps.push(PlanStep::Run {
        what: "start the worker".to_owned(),
        command: shell(host, reader),
        input: StepInput::Text(script::start(order, folder, programs)),
        only_if: None,
        asks: false,
        limit: STEP,
        remedy: format!("see {}", log_command(host)),
    });
    if wait_s > 0 {
        steps.push(PlanStep::Run {
            what: "see that it takes part in a run".to_owned(),
            command: shell(host, "sh -s"),
            input: StepInput::Text(script::watch(folder, wait_s)),
            only_if: None,
            asks: false,
            limit: Duration::from_secs(wait_s) + STEP,
            remedy: format!(
                "it was started; its coordinator must run and be reached at {} from there. See {}",
                order.connect,
                log_command(host)
            ),
        });
    }
    PlanPart {
        place: host.to_string(),
        success_message: if wait_s > 0 {
            format!("takes part as {name}")
        } else {
            format!("started as {name}")
        },
        steps,
    }
}

/// Returns a folder suffix, a hash of the certificate authority or of the coordinator's address, that
/// separates workers of different coordinators on a host, since two runs may use the same worker names.
fn owner_suffix(order: &WorkerOptions) -> String {
    let authority = order.tls.as_ref().map(|keys| std::fs::read(keys.join(CA)));
    let whose = match authority {
        Some(Ok(certificate)) => certificate,
        Some(Err(_)) | None => order.connect.to_string().into_bytes(),
    };
    let hash = blake3::hash(&whose).to_hex();
    format!("-{}", hash.chars().take(8).collect::<String>())
}

/// Selection of the workers on a host that are ended.
#[derive(Clone, Copy, Debug)]
pub enum EndedWorkers<'a> {
    /// All workers on the host, whatever launched them.
    All,
    /// The workers that were launched without an owner, by `horsehead workers up`.
    Unowned,
    /// The workers launched by the owner of these options ([`WorkerOptions::owner`]) for the same coordinator.
    OwnedBy(&'a WorkerOptions),
}

/// Plans the end of workers on hosts.
pub fn down(hosts: &[Host], which: EndedWorkers<'_>) -> LaunchPlan {
    let (mark, owner) = match which {
        EndedWorkers::All => (String::new(), None),
        EndedWorkers::Unowned => (String::new(), Some("")),
        EndedWorkers::OwnedBy(options) => (owner_suffix(options), Some(options.owner.as_str())),
    };
    let parts = hosts.iter().map(|host| PlanPart {
        place: host.to_string(),
        success_message: "its workers have ended".to_owned(),
        steps: vec![PlanStep::Run {
            what: "end its workers".to_owned(),
            command: shell(host, "sh -s"),
            input: StepInput::Text(script::end(&mark, owner)),
            only_if: None,
            asks: false,
            limit: DOWN,
            remedy: "its workers end by themselves only with --idle-timeout".to_owned(),
        }],
    });
    LaunchPlan {
        local_steps: Vec::new(),
        parts: parts.collect(),
    }
}

/// Returns the address of this machine as seen by a host.
///
/// # Errors
/// If the host cannot be reached, or its ssh does not report the address.
pub fn our_address(host: &Host) -> Result<String, LaunchError> {
    let step = PlanStep::Run {
        what: "ask from which address we come".to_owned(),
        command: shell(host, "sh -s"),
        input: StepInput::Text("echo \"${SSH_CONNECTION%% *}\"\n".to_owned()),
        only_if: None,
        asks: true,
        limit: STEP,
        remedy: "name the address with --advertise".to_owned(),
    };
    execute::run(&host.to_string(), &[step], &Cancellation::default()).and_then(|address| {
        if address.is_empty() {
            return Err(LaunchError {
                place: host.to_string(),
                step: "ask from which address we come".to_owned(),
                why: "its SSH_CONNECTION variable is empty".to_owned(),
                remedy: "name the address with --advertise".to_owned(),
            });
        }
        let is_long = address.contains(':');
        Ok(if is_long {
            format!("[{address}]")
        } else {
            address
        })
    })
}

/// Returns the command that shows the end of the worker logs on a host.
pub fn logs(host: &Host) -> Vec<String> {
    shell(host, &as_sh_command(&script::tail()))
}

/// Returns the command line with which a user shows the worker logs of a host.
fn log_command(host: &Host) -> String {
    format!("`horsehead workers logs --ssh {host}`")
}

/// Builds an ssh call that runs a command in the host's login shell.
fn shell(host: &Host, command: &str) -> Vec<String> {
    let mut words = vec!["ssh".to_owned()];
    for option in OPTIONS {
        words.extend(["-o".to_owned(), option.to_owned()]);
    }
    if let Some(port) = host.port {
        words.extend(["-p".to_owned(), port.to_string()]);
    }
    words.extend([host.target.clone(), command.to_owned()]);
    words
}

/// Wraps a script as a quoted `sh -c` command, for ssh calls whose standard input carries data.
fn as_sh_command(script: &str) -> String {
    line(&["sh".to_owned(), "-c".to_owned(), script.to_owned()])
}
