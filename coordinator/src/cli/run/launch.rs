//! Workers on other nodes that come with a run and go with it; and carrying out any plan of workers.
//!
//! Where nothing else is said, the run listens on port 7447, for the address from which a host says that we
//! come, with keys in the run folder: started again, it is the same to its workers.
use super::folder::KEYS;
use crate::cli::{
    argument::{door::Door, workers::WorkersChoice},
    output::{problem::Problem, terminal},
};
use dispatch::runtime::locate::worker_program;
use launch::{
    Host, Plan, Program, WorkerOptions,
    execute::{LaunchError, carry_out},
    ssh,
};
use link::{
    keys::authority::{Authority, Validity},
    locator::{Locator, Protocol},
};
use std::{
    fs,
    path::Path,
    sync::{
        Arc,
        atomic::{AtomicBool, AtomicUsize, Ordering},
    },
    thread::{self, JoinHandle},
};

/// Where a run listens for workers that it brings up itself.
const LISTEN: &str = "quic/0.0.0.0:7447";
/// Days for which the keys of a run are valid.
const DAYS: u32 = 365;
/// Seconds that a host's worker may take to be seen in the run.
const WAIT_S: u64 = 30;
/// Seconds after which a worker ends that nobody told of the end of its run, as when this process is killed.
const IDLE_S: u64 = 600;

/// Workers that were brought up with a run.
#[derive(Debug)]
pub(crate) struct Launch {
    hosts: Vec<Host>,
    order: WorkerOptions,
    /// How the run listens for them.
    pub(crate) door: Door,
    /// No further step of bringing them up begins.
    cancelled: Arc<AtomicBool>,
    /// Brings them up.
    launching: Option<JoinHandle<()>>,
}

impl Launch {
    /// What is needed before the run listens: an address and keys; none where no host is named.
    pub(crate) fn prepare(workers: &WorkersChoice, run: &Path) -> anyhow::Result<Option<Self>> {
        let hosts = workers.hosts.read()?;
        let Some(first) = hosts.first() else {
            return Ok(None);
        };
        let mut door = workers.door.clone();
        let listen = door.listen.get_or_insert_with(|| LISTEN.to_owned());
        let mut connect = Locator::parse(listen)?;
        connect.host = match &workers.advertise {
            Some(address) => address.clone(),
            None => ssh::our_address(first).map_err(|error| remedied(&error))?,
        };
        if connect.protocol == Protocol::Quic && door.tls.is_none() {
            let folder = run.join(KEYS);
            let authority = authority(&folder)?;
            let own = [connect.bare_host(), "localhost", "127.0.0.1"].map(str::to_owned);
            authority.issue_coordinator(&own, Validity::days(DAYS))?;
            door.tls = Some(folder);
        }
        let order = WorkerOptions {
            tls: door.tls.as_deref().map(std::path::absolute).transpose()?,
            connect,
            idle_timeout: Some(IDLE_S),
            slots: None,
            prologue: String::new(),
            owner: owner(run)?,
        };
        Ok(Some(Self {
            hosts,
            order,
            door,
            cancelled: Arc::default(),
            launching: None,
        }))
    }

    /// Brings the workers up, beside the run; a host that fails is told of and not waited for.
    pub(crate) fn up(&mut self) -> anyhow::Result<()> {
        let plan = ssh::up(&self.order, &self.hosts, &programs(&[])?, WAIT_S);
        let plan = plan?;
        let cancelled = Arc::clone(&self.cancelled);
        let launching = thread::Builder::new()
            .name("launch".to_owned())
            .spawn(move || {
                if let Err(error) = carry_until(&plan, &cancelled) {
                    tracing::warn!("workers of other nodes: {error}");
                }
            })?;
        self.launching = Some(launching);
        Ok(())
    }

    /// Ends them, those among them that are being started too.
    pub(crate) fn down(mut self) {
        self.cancelled.store(true, Ordering::Relaxed);
        let is_launching = |launching: &JoinHandle<()>| !launching.is_finished();
        let launching = self.launching.take().filter(is_launching);
        let down = ssh::down(&self.hosts, Some(&self.order));
        // whoever waits for a worker to take part goes on once its process has ended
        let mut ended = carry(&down);
        if let Some(launching) = launching {
            // a step that had begun may have started a worker behind that
            drop(launching.join());
            ended = carry(&down);
        }
        if let Err(error) = ended {
            tracing::warn!("workers of other nodes may go on for {IDLE_S} s: {error}");
        }
    }
}

/// The authority of a run's own keys: the one that earlier processes of the run had, or a new one with the keys of a
/// first worker.
fn authority(folder: &Path) -> anyhow::Result<Authority> {
    if !folder.exists() {
        // a process that is killed here leaves no half of a folder under its name
        let part = folder.with_extension("part");
        if part.exists() {
            fs::remove_dir_all(&part)?;
        }
        let new = Authority::create(&part)?;
        new.issue_worker("worker-01", Validity::days(DAYS))?;
        fs::rename(&part, folder)?;
    }
    Ok(Authority::open(folder)?)
}

/// The name under which a run owns the workers that it launches: the same for every process of the run.
fn owner(run: &Path) -> std::io::Result<String> {
    let uname = rustix::system::uname();
    let host = uname.nodename().to_string_lossy();
    let place = format!("{host}:{}", std::path::absolute(run)?.display());
    let hash = blake3::hash(place.as_bytes()).to_hex();
    Ok(format!("run-{}", hash.chars().take(16).collect::<String>()))
}

/// Carries a plan out and tells how it ended at each place.
pub(crate) fn carry(plan: &Plan) -> anyhow::Result<()> {
    carry_until(plan, &AtomicBool::new(false))
}

/// The same until it is cancelled.
fn carry_until(plan: &Plan, cancelled: &AtomicBool) -> anyhow::Result<()> {
    let failed = AtomicUsize::new(0);
    carry_out(plan, cancelled, &|part, ended| match ended {
        Ok(()) => terminal::tell(&format!("{}: {}", part.place, part.then)),
        Err(error) => {
            failed.fetch_add(1, Ordering::Relaxed);
            terminal::tell(&format!("error: {error}; {}", error.remedy));
        }
    })
    .map_err(|error| remedied(&error))?;
    match failed.into_inner() {
        0 => Ok(()),
        failed => anyhow::bail!("{failed} of {} places failed", plan.parts.len()),
    }
}

/// What failed, with its remedy.
fn remedied(error: &LaunchError) -> Problem {
    Problem {
        message: error.to_string(),
        remedy: error.remedy.clone(),
    }
}

/// The worker that `horsehead` would start here, then those that were named for other machines, which
/// come before it where they are for the same.
pub(crate) fn programs(named: &[String]) -> Result<Vec<Program>, Problem> {
    let mut programs = Vec::new();
    for text in named {
        let wrong = |why: &str| Problem {
            message: format!("--worker-program {text}: {why}"),
            remedy: "write ARCH=PATH with ARCH as `uname -m` says on the host".to_owned(),
        };
        let (machine, path) = text.split_once('=').ok_or_else(|| wrong("it has no ="))?;
        let program = Program::read(Path::new(path))?;
        if program.machine != machine {
            return Err(wrong(&format!("it is a program for {}", program.machine)));
        }
        programs.push(program);
    }
    match worker_program() {
        Ok(path) => {
            let own = Program::read(&path)?;
            if programs
                .iter()
                .all(|program| program.machine != own.machine)
            {
                programs.insert(0, own);
            }
        }
        Err(error) if programs.is_empty() => {
            return Err(Problem {
                message: error.to_string(),
                remedy: "or name one with --worker-program ARCH=PATH".to_owned(),
            });
        }
        Err(_) => {}
    }
    Ok(programs)
}
