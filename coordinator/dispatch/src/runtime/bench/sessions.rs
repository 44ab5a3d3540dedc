//! Workers that are only sessions: many of them on one thread over the memory link, or in a process
//! of their own over the bus.
//!
//! They speak the protocol as real ones do (announcement, proof, heartbeat, results) and answer a
//! job that does nothing at once, or after the sleep that it asks for. They repeat nothing: the memory link loses nothing, and over the bus
//! what is not answered in time is offered again.
use super::meter::SESSIONS;
use crate::simulated::{Running, Worker, outcome};
use link::{
    Blob, LinkError, WorkerEnd,
    keys::{Keys, Role},
    locator::Locator,
    memory::{Faults, Hub, MemoryCoordinator},
    zenoh::ZenohWorker,
};
use protocol::{
    announce::Announcement,
    id::{ContentHash, RunId, WorkerId},
    job::{Job, kind},
    key::Lane,
    message::{Attempt, Beat, Cost, Done, FromWorker, Order, ToWorker},
    proof::Proof,
    wire::{self, Kind},
};
use std::{
    env, io,
    path::Path,
    process::{Child, Command, Stdio},
    sync::Arc,
    thread,
    time::Duration,
};
use tokio::{
    sync::Semaphore,
    task::JoinSet,
    time::{Instant, MissedTickBehavior, sleep, sleep_until},
};

/// How often a worker speaks.
const BEAT: Duration = Duration::from_secs(1);

/// Connections that are opened at a time.
const OPENING: usize = 32;
/// Pause before a connection that failed is tried again.
const AGAIN: Duration = Duration::from_millis(200);

/// Running sessions; they end with the link.
pub(super) struct Sessions(Option<thread::JoinHandle<()>>);

impl Sessions {
    /// Starts so many sessions; the coordinator's end of their link.
    pub(super) fn start(count: usize, blob: Blob) -> (MemoryCoordinator, Self) {
        let (end, hub) = Hub::new(Faults::NONE, blob);
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

/// A process with sessions over the bus; ended when dropped.
pub(super) struct Connections(Child);

impl Connections {
    /// Starts this program again, with so many sessions that dial an address, with the key material
    /// of a worker's folder if it takes any.
    pub(super) fn start(count: usize, connect: &str, tls: Option<&Path>) -> io::Result<Self> {
        let mut command = Command::new(env::current_exe()?);
        command.args(["bench", "sessions", connect, &count.to_string()]);
        // not what this process was told
        command.env_remove("HORSEHEAD_TLS");
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

/// Dials an address with so many sessions and serves until all have been told to end; with the key
/// material of a worker's folder where certificates are asked for.
///
/// # Errors
/// What is wrong with the key material; the first connection that cannot be opened, and why trying
/// again does not help.
pub async fn connect(to: &Locator, count: usize, tls: Option<&Path>) -> Result<(), LinkError> {
    let keys = tls.map(|folder| Keys::read(folder, Role::Worker));
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
                    Err(error) if error.may_pass() => sleep(AGAIN).await,
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
    let mut sleeper = Worker::new(0, 1, 1.0);
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
                let Ok((of, message)) = wire::unseal::<ToWorker>(Kind::ToWorker, &frame) else {
                    continue;
                };
                match message {
                    ToWorker::Admitted { case: hash, .. } => {
                        (run, case) = (of, Some(hash));
                        beat(&mut number, case, &sleeper)
                    }
                    ToWorker::Run(order) if sleeps(&order.job) => {
                        sleeper.take(*order);
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
        match wire::seal(Kind::FromWorker, run, &message) {
            Ok(frame) => link.send(run, lane, frame),
            Err(error) => tracing::error!(%error, "a message cannot be sent"),
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

/// Jobs that are answered at once are never seen to run.
fn beat(number: &mut u64, case: Option<ContentHash>, sleeper: &Worker) -> FromWorker {
    *number += 1;
    let proof = Proof::Bits(ContentHash::of(b"sessions compute nothing"));
    FromWorker::Beat(Beat {
        number: *number,
        ..sleeper.beat(case, proof)
    })
}

/// Whether a job takes time.
const fn sleeps(job: &Job) -> bool {
    matches!(job, Job::Nothing { delay_ms, .. } if *delay_ms > 0)
}

fn answer(Order { attempt, job, .. }: Order) -> Done {
    Done {
        attempt,
        work: job.work_hash(),
        cost: Cost::default(),
        outcome: outcome(&job),
    }
}
