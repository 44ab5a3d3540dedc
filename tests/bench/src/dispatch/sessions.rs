//! Workers without slot processes: sessions on one thread over the memory link, or in a
//! separate process over the bus.
//!
//! Sessions speak the protocol as real workers do (announcement, proof, heartbeat, results) and answer an
//! empty job at once, or after the delay it requests. They never resend: the memory link loses nothing, and
//! over the bus an unanswered job is offered again.
use anyhow::Context as _;
use dispatch::{
    bench::processor_time,
    runtime::{Dispatch, DispatchOptions, local_socket},
    simulated::{Running, SimulatedWorker, outcome},
};
use link::{
    Blob, LinkError, WorkerEnd,
    keys::{KeyRole, Keys},
    locator::Locator,
    memory::{FaultInjection, Hub, MemoryCoordinator},
    zenoh::ZenohWorker,
};
use protocol::{
    announce::Announcement,
    id::{ContentHash, RunId, WorkerId},
    job::{Job, kind},
    key::Lane,
    message::{Assignment, Attempt, Cost, Done, FromWorker, Heartbeat, ToWorker},
    proof::ReferenceResult,
    wire::{self, FrameKind},
};
use std::{
    env, fs, io,
    path::Path,
    process::{Child, Command, Stdio},
    sync::Arc,
    thread,
    time::Duration,
};
use tempfile::TempDir;
use tokio::{
    sync::Semaphore,
    task::JoinSet,
    time::{Instant, MissedTickBehavior, sleep, sleep_until},
};

/// Name of the thread that runs sessions of this process.
const SESSIONS: &str = "bench-sessions";

/// Subfolder of the coordinator's key folder with the certificate that sessions use.
const WORKER: &str = "worker-01";
/// Interval at which a benchmark session sends heartbeats.
const BEAT: Duration = Duration::from_secs(1);

/// Maximum number of connections being opened at a time.
const OPENING: usize = 32;
/// Pause before a failed connection is retried.
const AGAIN: Duration = Duration::from_millis(200);

/// Running in-process sessions, which end when the link closes.
pub(super) struct Sessions(Option<thread::JoinHandle<()>>);

impl Sessions {
    /// Starts a number of in-process sessions and returns the coordinator's end of their memory link.
    pub(super) fn start(count: usize, blob: Blob) -> (MemoryCoordinator, Self) {
        let (end, hub) = Hub::new(FaultInjection::NONE, blob);
        let work = move || {
            let runtime = tokio::runtime::Builder::new_current_thread()
                .enable_time()
                .build();
            let Ok(runtime) = runtime else {
                tracing::error!("the sessions have no runtime");
                return;
            };
            runtime.block_on(async move {
                let mut sessions = JoinSet::new();
                for id in 1..=count as u64 {
                    sessions.spawn(serve(hub.worker(WorkerId(id)), WorkerId(id)));
                }
                drop(hub);
                while sessions.join_next().await.is_some() {}
            });
        };
        let thread = thread::Builder::new().name(SESSIONS.to_owned()).spawn(work);
        if let Err(error) = &thread {
            tracing::error!("the sessions cannot be started: {error}");
        }
        (end, Self(thread.ok()))
    }
}

impl Drop for Sessions {
    fn drop(&mut self) {
        if let Some(thread) = self.0.take()
            && thread.join().is_err()
        {
            tracing::error!("the thread of the sessions panicked");
        }
    }
}

/// Returns the processor time of this process so far, without that of the thread of its sessions.
pub(super) fn cost_without_sessions() -> Duration {
    let threads = fs::read_dir("/proc/self/task")
        .into_iter()
        .flatten()
        .flatten();
    let nanos = threads.filter_map(|thread| {
        let name = fs::read_to_string(thread.path().join("comm")).ok()?;
        (name.trim_end() == SESSIONS).then_some(())?;
        let stat = fs::read_to_string(thread.path().join("schedstat")).ok()?;
        stat.split_whitespace().next()?.parse::<u64>().ok()
    });
    processor_time().saturating_sub(Duration::from_nanos(nanos.sum()))
}

/// Opens a run that listens on a Unix socket, or over QUIC with the key material of its options, and starts sessions of
/// another process that connect to it. The socket's folder is to be kept while the run is open.
///
/// # Errors
/// If the run cannot be opened or the process not be started.
pub(crate) async fn open_with_connections(
    mut options: DispatchOptions,
    count: usize,
) -> anyhow::Result<(Dispatch, Connections, TempDir)> {
    let (folder, socket) = local_socket()?;
    let access = &mut options.access;
    access.listen = Some(match access.tls {
        Some(_) => "quic/127.0.0.1:0".to_owned(),
        None => socket.to_string(),
    });
    let tls = access.tls.as_ref().map(|folder| folder.join(WORKER));
    let dispatch = Dispatch::open(options).await?;
    let at = dispatch.listening().into_iter().next();
    let at = at.context("the run listens nowhere")?;
    let connections = Connections::start(count, &at, tls.as_deref())?;
    Ok((dispatch, connections, folder))
}

/// Child process whose sessions connect as workers over the bus; killed on drop.
pub(crate) struct Connections(Child);

impl Connections {
    /// Starts this program as a child process with a number of sessions that connect to an address, using the
    /// key material in a worker's folder if given.
    pub(crate) fn start(count: usize, connect: &str, tls: Option<&Path>) -> io::Result<Self> {
        let mut command = Command::new(env::current_exe()?);
        command.args(["peers", "sessions", connect, &count.to_string()]);
        if let Some(folder) = tls {
            command.arg("--tls").arg(folder);
        }
        Ok(Self(command.stdin(Stdio::null()).spawn()?))
    }
}

impl Drop for Connections {
    fn drop(&mut self) {
        // fails only if it has ended by itself
        drop(self.0.kill());
        drop(self.0.wait());
    }
}

/// Connects a number of sessions to an address and serves until all have been told to end, using the key
/// material in a worker's folder if given.
///
/// # Errors
/// Unusable key material, or the first connection that cannot be opened for a reason that retrying does not
/// cure.
pub(super) async fn connect(
    to: &Locator,
    count: usize,
    tls: Option<&Path>,
) -> Result<(), LinkError> {
    let keys = tls.map(|folder| Keys::read(folder, KeyRole::Worker));
    let keys = keys.transpose()?.map(Arc::new);
    let opening = Arc::new(Semaphore::new(OPENING));
    let mut sessions = JoinSet::new();
    for process in 1..=count as u64 {
        let (to, opening, keys) = (to.clone(), Arc::clone(&opening), keys.clone());
        sessions.spawn(async move {
            let place = opening.acquire().await;
            let link = loop {
                match ZenohWorker::open(&to, keys.as_deref(), process).await {
                    Ok(link) => break link,
                    Err(error) if error.is_retryable() => sleep(AGAIN).await,
                    Err(error) => return Err(error),
                }
            };
            drop(place);
            serve(link, WorkerId(process)).await;
            Ok(())
        });
    }
    while let Some(ended) = sessions.join_next().await {
        match ended {
            Ok(ended) => ended?,
            Err(error) => tracing::error!("a session broke down: {error}"),
        }
    }
    Ok(())
}

async fn serve<L: WorkerEnd>(mut link: L, id: WorkerId) {
    let mut run = RunId::default();
    let mut case = None;
    let mut number = 0;
    let mut beats = tokio::time::interval(BEAT);
    beats.set_missed_tick_behavior(MissedTickBehavior::Delay);
    let begun = Instant::now();
    // the slot of jobs that sleep, with what is in it and until when
    let mut sleeper = SimulatedWorker::new(0, 1, 1.0);
    let mut asleep: Option<(Attempt, Instant)> = None;
    loop {
        if asleep.is_none()
            && let Some(attempt) = sleeper.begin(begun.elapsed())
        {
            let delay = sleeper.running.last().map(Running::delay);
            asleep = Some((attempt, Instant::now() + delay.unwrap_or_default()));
        }
        let until = asleep.map_or_else(Instant::now, |(_, until)| until);
        let message = tokio::select! {
            frame = link.receive() => {
                let Some(frame) = frame else { return };
                let Ok((of, message)) = wire::decode_frame::<ToWorker>(FrameKind::ToWorker, &frame) else {
                    continue;
                };
                match message {
                    ToWorker::Admitted { case: hash, .. } => {
                        (run, case) = (of, Some(hash));
                        beat(&mut number, case, &sleeper)
                    }
                    ToWorker::Run(order) if sleeps(&order.job) => {
                        sleeper.enqueue(*order);
                        continue;
                    }
                    ToWorker::Run(order) => FromWorker::Done(Box::new(answer(*order))),
                    ToWorker::Identify => announce(id),
                    ToWorker::Ended | ToWorker::Refused { .. } => return,
                    ToWorker::Cancel(attempt) => {
                        sleeper.cancel(attempt, begun.elapsed());
                        asleep = asleep.filter(|(running, _)| *running != attempt);
                        continue;
                    }
                    ToWorker::Stored(attempts) => {
                        sleeper.settle(attempts);
                        continue;
                    }
                }
            }
            () = sleep_until(until), if asleep.is_some() => {
                let woken = asleep.take();
                match woken.and_then(|(attempt, _)| sleeper.finish(attempt, begun.elapsed())) {
                    Some(done) => FromWorker::Done(Box::new(done)),
                    None => continue,
                }
            }
            _ = beats.tick() => match case {
                Some(_) => beat(&mut number, case, &sleeper),
                None => announce(id),
            },
        };
        let lane = match message {
            FromWorker::Done(_) => Lane::Data,
            FromWorker::Announce(_) | FromWorker::Beat(_) | FromWorker::Leaving { .. } => {
                Lane::Control
            }
        };
        match wire::encode_frame(FrameKind::FromWorker, run, &message) {
            Ok(frame) => link.send(run, lane, frame),
            Err(error) => tracing::error!("a message cannot be sent: {error}"),
        }
    }
}

fn announce(id: WorkerId) -> FromWorker {
    FromWorker::Announce(Box::new(Announcement {
        protocol: wire::VERSION,
        build: format!("{} session", env!("CARGO_PKG_VERSION")),
        host: id.to_string(),
        pid: std::process::id(),
        slots: 1,
        cores: 1,
        job_kinds: vec![kind::NOTHING.to_owned()],
        models: Vec::new(),
    }))
}

/// Builds a heartbeat; jobs answered at once never appear as running.
fn beat(number: &mut u64, case: Option<ContentHash>, sleeper: &SimulatedWorker) -> FromWorker {
    *number += 1;
    let proof = ReferenceResult::Bits(ContentHash::of(b"sessions compute nothing"));
    FromWorker::Beat(Heartbeat {
        number: *number,
        ..sleeper.beat(case, proof)
    })
}

/// Returns whether a job asks a benchmark session to delay its answer.
const fn sleeps(job: &Job) -> bool {
    matches!(job, Job::Nothing { delay_ms, .. } if *delay_ms > 0)
}

fn answer(Assignment { attempt, job, .. }: Assignment) -> Done {
    Done {
        attempt,
        work: job.work_hash(),
        cost: Cost::default(),
        outcome: outcome(&job),
    }
}
