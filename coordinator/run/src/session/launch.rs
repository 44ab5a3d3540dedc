//! Starts workers on other hosts for the duration of a run, and executes any launch plan.
//!
//! By default, the run listens on port 7447 of every interface, at the address of this machine that a host
//! reports for its SSH connection, with keys kept in the run folder; a restarted run therefore has the same
//! address and keys for its workers.
use super::interrupt;
use crate::{folder::KEYS, message};
use dispatch::runtime::{RemoteAccess, locate::worker_program};
use launch::{
    Host, LaunchPlan, Program, WorkerOptions,
    execute::{Cancellation, LaunchError, execute_plan},
    ssh::{self, EndedWorkers},
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
        atomic::{AtomicUsize, Ordering},
    },
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};
use support::Problem;

/// Default listening address of a run that launches its own workers.
const LISTEN: &str = "quic/0.0.0.0:7447";
/// Validity of the certificates created for a run (days).
const DAYS: u32 = 365;
/// Time within which a launched worker must join the run before it is reported as missing (s).
const WAIT_S: u64 = 30;
/// Idle time (s) after which a launched worker exits if it is never told that its run ended, for example
/// because this process was killed.
const IDLE_S: u64 = 600;

/// Longest wait at the end of a run for a step that is still launching a worker.
const LAST_STEP: Duration = Duration::from_secs(30);
/// Interval at which the end of the launched workers is looked for.
const POLL: Duration = Duration::from_millis(50);

/// Workers of other machines that take part in a run: those that connect by themselves, and those that are launched
/// for its time.
#[derive(Clone, Debug, Default)]
pub struct RemoteWorkers {
    /// Address at which workers may connect.
    pub access: RemoteAccess,
    /// Hosts on which workers are launched.
    pub hosts: Vec<Host>,
    /// Name or address under which the hosts reach this machine; `None` for the one from which the first of them says
    /// that this machine comes.
    pub advertise: Option<String>,
    /// Simulations at a time on each launched worker; `None` for one per hardware thread.
    pub slots: Option<u16>,
    /// Worker programs for hosts of another architecture, as `ARCH=PATH`.
    pub programs: Vec<String>,
    /// Shell lines to run before a launched worker.
    pub prologue: String,
}

/// Workers on other hosts that are launched together with a run and stopped with it.
#[derive(Debug)]
pub(crate) struct Launch {
    hosts: Vec<Host>,
    options: WorkerOptions,
    /// Worker programs, by the processors of the hosts.
    programs: Vec<Program>,
    /// Listening address and keys of the run, through which the launched workers connect.
    pub(crate) endpoint: RemoteAccess,
    /// Cancellation of the launching and of the ending of workers.
    cancelled: [Arc<Cancellation>; 2],
    /// Thread that launches the workers; `None` before [`Launch::up`].
    launching: Option<JoinHandle<()>>,
}

impl Launch {
    /// Determines the listening address and creates the keys for workers on other hosts, before the run
    /// starts to listen; returns `None` if no host is named.
    ///
    /// # Errors
    /// If a host does not say from where this machine comes, or keys or worker programs cannot be made or read.
    pub(crate) fn prepare(workers: &RemoteWorkers, run: &Path) -> anyhow::Result<Option<Self>> {
        let Some(first) = workers.hosts.first() else {
            return Ok(None);
        };
        let mut access = workers.access.clone();
        let listen = access.listen.get_or_insert_with(|| LISTEN.to_owned());
        let mut connect = Locator::parse(listen)?;
        connect.host = match &workers.advertise {
            Some(address) => address.clone(),
            None => ssh::our_address(first).map_err(|error| to_problem(&error))?,
        };
        if connect.protocol == Protocol::Quic && access.tls.is_none() {
            let folder = run.join(KEYS);
            let authority = authority(&folder)?;
            let own = [connect.bare_host(), "localhost", "127.0.0.1"].map(str::to_owned);
            authority.issue_coordinator(&own, Validity::days(DAYS))?;
            access.tls = Some(folder);
        }
        let order = WorkerOptions {
            tls: access.tls.as_deref().map(std::path::absolute).transpose()?,
            connect,
            idle_timeout: Some(IDLE_S),
            slots: workers.slots,
            prologue: workers.prologue.clone(),
            owner: owner(run)?,
        };
        Ok(Some(Self {
            hosts: workers.hosts.clone(),
            options: order,
            programs: programs(&workers.programs)?,
            endpoint: access,
            cancelled: Default::default(),
            launching: None,
        }))
    }

    /// Launches the workers on a separate thread, concurrently with the run; a host that fails is reported
    /// and not waited for.
    ///
    /// # Errors
    /// If the plan of the launch cannot be made.
    pub(crate) fn up(&mut self) -> anyhow::Result<()> {
        let plan = ssh::up(&self.options, &self.hosts, &self.programs, WAIT_S);
        let plan = plan?;
        let [cancelled, _] = self.cancelled.clone();
        let launching = thread::Builder::new()
            .name("launch".to_owned())
            .spawn(move || {
                if let Err(error) = execute_plan_until(&plan, &cancelled) {
                    tracing::warn!("workers on other hosts could not be started: {error}");
                }
            })?;
        self.launching = Some(launching);
        Ok(())
    }

    /// Ends the workers that [`Self::up`] launched, including those that are still being started; an interrupt
    /// ends the wait for them. Without `up` nothing is ended: another process of the run may have launched workers.
    ///
    /// Blocks for at most the limits of its steps.
    pub(crate) fn down(mut self) {
        let Some(launching) = self.launching.take() else {
            return;
        };
        let cancelled = self.cancelled.clone();
        let stop = interrupt::listen();
        // whoever interrupted the run itself waits for its end, and may interrupt that, too
        let was_interrupted = *stop.borrow();
        let ended = thread::spawn(move || self.end(&launching));
        while !ended.is_finished() {
            if !was_interrupted && *stop.borrow() {
                for plan in &cancelled {
                    plan.kill();
                }
            }
            thread::sleep(POLL);
        }
        let ended = ended.join().map(|ended| {
            anyhow::ensure!(!cancelled[1].is_killed(), "interrupted");
            ended
        });
        match ended {
            Ok(Ok(())) => {}
            Ok(Err(error)) => tracing::warn!(
                "workers on other hosts could not be stopped and end by themselves after {IDLE_S} s: {error}"
            ),
            Err(_) => tracing::error!("the thread that ends workers panicked"),
        }
    }

    /// Executes the plan that ends the launched workers.
    fn end(&self, launching: &JoinHandle<()>) -> anyhow::Result<()> {
        let [up, ending] = &self.cancelled;
        let was_launching = !launching.is_finished();
        up.finish();
        let down = ssh::down(&self.hosts, EndedWorkers::OwnedBy(&self.options));
        // whoever waits for a worker to take part goes on once its process has ended
        let ended = execute_plan_until(&down, ending);
        if !was_launching {
            return ended;
        }
        let until = Instant::now() + LAST_STEP;
        while !launching.is_finished() && !up.is_killed() {
            if Instant::now() > until {
                up.kill();
            }
            thread::sleep(POLL);
        }
        // a step that had begun may have started a worker behind that
        execute_plan_until(&down, ending)
    }
}

/// Returns the certificate authority of the run: that of earlier processes of the run, or a new one that has
/// also issued the keys of a first worker.
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

/// Returns the owner name of the workers that the run launches, derived from host name and run folder and
/// thus equal for every process of the run.
fn owner(run: &Path) -> std::io::Result<String> {
    let uname = rustix::system::uname();
    let host = uname.nodename().to_string_lossy();
    let place = format!("{host}:{}", std::path::absolute(run)?.display());
    let hash = blake3::hash(place.as_bytes()).to_hex();
    Ok(format!("run-{}", hash.chars().take(16).collect::<String>()))
}

/// Executes a plan for launching workers and prints the outcome at each host.
///
/// # Errors
/// If the plan cannot be executed, or a place failed.
pub fn execute(plan: &LaunchPlan) -> anyhow::Result<()> {
    execute_plan_until(plan, &Cancellation::default())
}

/// Executes a plan for launching workers like [`execute`], until it is cancelled.
fn execute_plan_until(plan: &LaunchPlan, cancelled: &Cancellation) -> anyhow::Result<()> {
    let failed = AtomicUsize::new(0);
    execute_plan(plan, cancelled, &|part, ended| match ended {
        Ok(()) => message::print(&format!("{}: {}", part.place, part.success_message)),
        Err(error) => {
            failed.fetch_add(1, Ordering::Relaxed);
            message::print(&format!("error: {error}; {}", error.remedy));
        }
    })
    .map_err(|error| to_problem(&error))?;
    match failed.into_inner() {
        0 => Ok(()),
        failed => anyhow::bail!("{failed} of {} places failed", plan.parts.len()),
    }
}

fn to_problem(error: &LaunchError) -> Problem {
    Problem {
        message: error.to_string(),
        remedy: error.remedy.clone(),
    }
}

/// Returns the worker programs to copy to hosts, by machine architecture: the one of this machine first, then
/// those in `named`; a named program replaces the local one for the same architecture.
///
/// # Errors
/// If a program is not named as `ARCH=PATH`, cannot be read, or is for another architecture.
pub fn programs(named: &[String]) -> Result<Vec<Program>, Problem> {
    let mut programs = Vec::new();
    for text in named {
        let wrong = |why: &str| Problem {
            message: format!("--worker-program {text}: {why}"),
            remedy: "write ARCH=PATH, where ARCH is the output of `uname -m` on the host"
                .to_owned(),
        };
        let (machine, path) = text
            .split_once('=')
            .ok_or_else(|| wrong("the = between ARCH and PATH is missing"))?;
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
                remedy: "name a worker program with --worker-program ARCH=PATH".to_owned(),
            });
        }
        Err(_) => {}
    }
    Ok(programs)
}
