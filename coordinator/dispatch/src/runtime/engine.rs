//! Task of an open run, which passes messages between link, scheduler core and journal, and makes no
//! decisions itself.
use super::{
    control::{
        PendingRequest,
        messages::{ControlReply, ControlRequest},
    },
    coordination::Coordination,
    error::DispatchError,
    local::{LocalEvent, LocalWorkers},
    parts::Parts,
    suspend::SuspendDetector,
    worker_control,
};
use crate::scheduler::{Command, Completed, Input, Snapshot};
use journal::event::{Asked, Event, JobReason};
use journal::{Journal, WriterReport};
use link::{CoordinatorEnd, LinkEvent};
use protocol::{
    id::{JobId, RunId, WorkerId},
    job::Job,
    key::Lane,
    message::{FromWorker, ToWorker},
    name::NO_CERTIFICATE,
    wire::{self, FrameKind, WireError},
};
use std::{
    mem,
    sync::{Arc, Mutex, PoisonError},
    time::{Duration, Instant},
};
use tokio::{
    sync::{
        mpsc::{UnboundedReceiver, UnboundedSender},
        oneshot,
    },
    time::{MissedTickBehavior, interval, timeout},
};

/// Interval at which the scheduler core checks its deadlines.
const TICK: Duration = Duration::from_millis(250);
/// Maximum age of the run's published snapshot; making a snapshot costs more than handling a result.
const FRESH: Duration = Duration::from_millis(20);
/// Maximum number of queued messages handled before the scheduler core checks its deadlines.
const MOST_WAITING: usize = 1 << 16;
/// Time limit at the end of a run for the last results to reach the journal; not applied while the disk is
/// full.
const LAST_WRITE: Duration = Duration::from_secs(1);

/// Request of the run's owner to the engine.
#[derive(Debug)]
pub(super) enum Request {
    /// Jobs submitted together; those with derivatives may be divided into parts.
    Submit(Vec<(JobId, Job, JobReason)>),
    /// Replaces the jobs that the run will probably submit next, likeliest first.
    Anticipate(Vec<Job>),
    /// Writes an event of the study to the journal.
    Record(Event),
    /// Asks for the state of the run as of now.
    Snapshot(oneshot::Sender<Snapshot>),
    /// Request that arrived on the control socket.
    Control(PendingRequest),
}

/// Summary of a run, from opening to closing in this process.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunSummary {
    /// State of the run when it was closed, including the account of slot time.
    pub last: Snapshot,
    /// Number of results taken from the journal instead of being computed.
    pub replayed: u64,
    /// Time between opening and closing \[s\].
    pub wall_s: f64,
}

type Deliver = UnboundedSender<Result<Completed, DispatchError>>;

/// Pause of a run whose journal cannot be written.
#[derive(Debug)]
struct Pause {
    /// Error of the operating system that prevents writing.
    why: String,
    /// Time at which the run ends if the journal still cannot be written.
    ends: tokio::time::Instant,
}

pub(super) struct Engine<L> {
    run: RunId,
    coordination: Coordination,
    journal: Journal,
    said: UnboundedReceiver<WriterReport>,
    link: L,
    workers: Option<LocalWorkers>,
    only_local: bool,
    deliver: Deliver,
    shown: Arc<Mutex<Snapshot>>,
    begun: Instant,
    sleep: SuspendDetector,
    replayed: u64,
    /// Current pause, while the journal cannot be written; `None` for a deleted journal, which is not waited
    /// for.
    paused: Option<Pause>,
    /// Maximum duration of a pause for a journal that cannot be written.
    pause_limit: Duration,
    /// Whether a pause exceeded its limit, so that the run ends without waiting for the journal.
    given_up: bool,
    /// Time at which the snapshot must be renewed; `None` if nothing has changed.
    stale_at: Option<tokio::time::Instant>,
}

impl<L: CoordinatorEnd> Engine<L> {
    pub(super) fn new(
        parts: Parts,
        link: L,
        workers: Option<LocalWorkers>,
        only_local: bool,
        deliver: Deliver,
        shown: Arc<Mutex<Snapshot>>,
    ) -> Self {
        let Parts {
            run,
            core,
            journal,
            said,
            pause_limit,
            divide,
            ..
        } = parts;
        let begun = Instant::now();
        Self {
            run,
            coordination: Coordination::new(core, divide),
            journal,
            said,
            link,
            workers,
            only_local,
            deliver,
            shown,
            begun,
            sleep: SuspendDetector::since_now(),
            replayed: 0,
            paused: None,
            pause_limit,
            given_up: false,
            stale_at: None,
        }
    }

    pub(super) async fn run(mut self, mut requests: UnboundedReceiver<Request>) -> RunSummary {
        let mut ticks = interval(TICK);
        ticks.set_missed_tick_behavior(MissedTickBehavior::Delay);
        loop {
            let pause_ends = self.pause_ends();
            tokio::select! {
                request = requests.recv() => match request {
                    Some(Request::Submit(jobs)) => self.submit(jobs),
                    Some(Request::Anticipate(jobs)) => self.anticipate(jobs),
                    Some(Request::Record(event)) => self.record(event),
                    Some(Request::Snapshot(to)) => {
                        let now = self.begun.elapsed();
                        // who asked may not wait any more
                        drop(to.send(self.coordination.core().snapshot(now)));
                    }
                    Some(Request::Control((question, to))) => {
                        let reply = self.ask(&question);
                        // who asked may not wait any more
                        drop(to.send(reply));
                    }
                    None => break,
                },
                heard = self.link.receive() => match heard {
                    Some(heard) => self.hear(heard),
                    None => break,
                },
                Some(appended) = self.said.recv() => self.appended(appended),
                event = local_event(&mut self.workers) => self.local(event),
                _ = ticks.tick() => {
                    self.catch_up().await;
                    self.wake();
                    self.handle(Input::Tick);
                    self.show();
                }
                () = until(self.stale_at) => self.show(),
                () = until(pause_ends) => self.give_up(),
            }
        }
        self.close().await
    }

    /// Returns the time at which the current pause exceeds its limit.
    fn pause_ends(&self) -> Option<tokio::time::Instant> {
        let pause = self.paused.as_ref().filter(|_| !self.given_up);
        pause.map(|pause| pause.ends)
    }

    /// Ends the run because its journal could not be written for longer than the pause limit.
    fn give_up(&mut self) {
        self.given_up = true;
        if let Some(pause) = &self.paused {
            let (why, limit) = (pause.why.clone(), self.pause_limit);
            self.give(Err(DispatchError::Paused { why, limit }));
        }
    }

    /// Handles all messages that have already arrived, so that no worker counts as silent while its messages
    /// are queued.
    async fn catch_up(&mut self) {
        for _ in 0..MOST_WAITING {
            let waiting = tokio::task::coop::unconstrained(self.link.receive());
            let heard = tokio::select! {
                biased;
                Some(heard) = waiting => heard,
                () = std::future::ready(()) => return,
            };
            self.hear(heard);
        }
    }

    /// Tells the scheduler core if the machine was suspended since the last call, and for how long.
    fn wake(&mut self) {
        let time = self.sleep.since_last();
        if time > TICK {
            self.handle(Input::Suspended { time });
        }
    }

    /// Submits jobs; results that the journal already holds are delivered at once.
    fn submit(&mut self, jobs: Vec<(JobId, Job, JobReason)>) {
        let mut new = Vec::with_capacity(jobs.len());
        for (id, job, reason) in jobs {
            let is_new = self.is_new(id, &job);
            // of a job with a result the request may have been lost to damage
            if is_new || !self.journal.holds_request(id) {
                let asked = Asked::new(id, &job, reason);
                self.record(Event::Asked(Box::new(asked)));
            }
            if is_new {
                new.push((id, job));
            }
        }
        let commands = self.coordination.submit(new, self.begun.elapsed());
        self.execute(commands);
    }

    /// Replaces the anticipated jobs, which idle slots compute ahead.
    fn anticipate(&mut self, jobs: Vec<Job>) {
        let commands = self.coordination.anticipate(jobs, self.begun.elapsed());
        self.execute(commands);
    }

    /// Returns whether a submitted job has no result in the journal; if it has one, delivers that.
    fn is_new(&mut self, id: JobId, job: &Job) -> bool {
        match self.journal.recall(id) {
            Ok(None) => return true,
            Ok(Some(finished)) if finished.work == job.work_hash() => {
                self.replayed += 1;
                self.give(Ok(Completed {
                    id,
                    cost: finished.cost,
                    outcome: finished.outcome,
                    replayed: true,
                }));
            }
            Ok(Some(_)) => self.give(Err(DispatchError::JobDiffers { job: id })),
            Err(error) => self.give(Err(error.into())),
        }
        false
    }

    /// Answers a request from the control socket, draining workers as requested.
    fn ask(&mut self, question: &ControlRequest) -> ControlReply {
        let own_host = rustix::system::uname();
        let named = |id: WorkerId, host: &str, pid: u32| {
            let name = self.link.owner(id);
            let is_local = host == own_host.nodename().to_string_lossy()
                && (self.workers.as_ref()).is_some_and(|own| own.has_started(pid));
            (name.unwrap_or_else(|| NO_CERTIFICATE.to_owned()), is_local)
        };
        let core = self.coordination.core();
        let mut workers = core.worker_reports(self.begun.elapsed(), named);
        for held in workers.iter_mut().flat_map(|(_, worker)| &mut worker.jobs) {
            held.job = self.coordination.submitted_id(JobId(held.job)).0;
        }
        let (drains, reply) = worker_control::answer(question, workers);
        for (worker, how) in drains {
            self.handle(Input::Drain { worker, how });
        }
        reply
    }

    fn hear(&mut self, heard: LinkEvent) {
        let (from, frame) = match heard {
            LinkEvent::Disconnected(worker) => {
                self.wake();
                return self.handle(Input::Disconnected { worker });
            }
            LinkEvent::Frame(from, frame) => (from, frame),
        };
        match wire::decode_frame::<FromWorker>(FrameKind::FromWorker, &frame) {
            Ok((run, message)) => {
                let known = run == self.run || matches!(message, FromWorker::Announce(_));
                self.handle(if known {
                    Input::Message { from, message }
                } else {
                    Input::OtherRun { from }
                });
            }
            Err(WireError::Version { found: version }) => {
                self.handle(Input::OtherVersion { from, version });
            }
            Err(error) => tracing::debug!(%from, %error, "a frame was dropped"),
        }
    }

    fn appended(&mut self, appended: WriterReport) {
        match appended {
            WriterReport::Stored(jobs) => {
                self.handle(Input::Stored { jobs });
            }
            WriterReport::Paused(why) => {
                self.handle(Input::Writable(false));
                tracing::error!(
                    "the journal cannot be written ({why}): the run is paused and no result is lost; \
                     free space on the disk and it continues by itself. After {} s it ends with the results it has",
                    self.pause_limit.as_secs()
                );
                let ends = tokio::time::Instant::now() + self.pause_limit;
                self.paused = Some(Pause { why, ends });
            }
            WriterReport::Deleted => {
                self.handle(Input::Writable(false));
                self.give(Err(self.journal.deleted().into()));
            }
            WriterReport::Resumed => {
                (self.paused, self.given_up) = (None, false);
                self.handle(Input::Writable(true));
                tracing::warn!("the journal can be written again: the run continues");
            }
        }
    }

    fn local(&mut self, event: LocalEvent) {
        match event {
            LocalEvent::Ended { how } => {
                tracing::warn!("a local worker {how}; it is started again");
            }
            LocalEvent::GivenUp { how } => {
                tracing::warn!(
                    "a local worker {how}; it has ended too often and is not started again"
                );
            }
            LocalEvent::AllGivenUp { how } if self.only_local => {
                self.give(Err(DispatchError::LocalWorkers { how }));
            }
            LocalEvent::AllGivenUp { .. } => {}
        }
    }

    fn handle(&mut self, input: Input) {
        let commands = self.coordination.handle(input, self.begun.elapsed());
        self.execute(commands);
    }

    fn execute(&mut self, commands: Vec<Command>) {
        self.stale_at
            .get_or_insert_with(|| tokio::time::Instant::now() + FRESH);
        for command in commands {
            match command {
                Command::Send { to, message } => self.send(to, &message),
                Command::Store(finished) => self.record(Event::Finished(finished)),
                Command::Record(event) => self.record(event),
                Command::Deliver(completed) => self.give(Ok(completed)),
                Command::Notice(notice) if notice.is_routine() => tracing::info!("{notice}"),
                Command::Notice(notice) => tracing::warn!("{notice}"),
                Command::Stop(stop) => self.give(Err(stop.into())),
            }
        }
        let results = self.coordination.core().results();
        if let Some(workers) = &self.workers {
            workers.note_results(results);
        }
    }

    fn send(&mut self, to: WorkerId, message: &ToWorker) {
        let lane = match message {
            ToWorker::Run(_) | ToWorker::Cancel(_) => Lane::Data,
            ToWorker::Identify
            | ToWorker::Admitted { .. }
            | ToWorker::Refused { .. }
            | ToWorker::Stored(_)
            | ToWorker::Ended => Lane::Control,
        };
        match wire::encode_frame(FrameKind::ToWorker, self.run, message) {
            Ok(frame) => self.link.send(to, lane, frame),
            Err(error) => tracing::error!(%error, "a message cannot be sent"),
        }
    }

    fn record(&self, event: Event) {
        if let Err(error) = self.journal.append(event) {
            self.give(Err(error.into()));
        }
    }

    fn give(&self, completed: Result<Completed, DispatchError>) {
        // the owner may have lost interest
        drop(self.deliver.send(completed));
    }

    fn show(&mut self) {
        self.stale_at = None;
        let snapshot = self.coordination.core().snapshot(self.begun.elapsed());
        *self.shown.lock().unwrap_or_else(PoisonError::into_inner) = snapshot;
    }

    /// Waits until the last results are in the journal, up to the pause limit if the disk is full, since
    /// workers discard their results when told that the run ends.
    async fn write_last(&mut self) {
        let mut ends = tokio::time::Instant::now() + LAST_WRITE;
        let mut ticks = interval(TICK);
        let mut told = false;
        while self.coordination.core().unstored() > 0 && !self.given_up {
            if self.paused.is_some() && !mem::replace(&mut told, true) {
                tracing::error!(
                    "the run ends once its last {} results are written: free space on the disk. A second \
                     interrupt ends it without them; workers then keep them for the next start of \
                     the run, and missing ones are computed again",
                    self.coordination.core().unstored()
                );
            }
            let pause_ends = self.pause_ends();
            tokio::select! {
                appended = self.said.recv() => {
                    let Some(appended) = appended else { return };
                    self.appended(appended);
                    ends = tokio::time::Instant::now() + LAST_WRITE;
                }
                // nobody may come to count as silent, or stand in a queue, meanwhile
                Some(heard) = self.link.receive() => self.hear(heard),
                _ = ticks.tick() => {
                    self.handle(Input::Tick);
                    self.show();
                }
                () = until(pause_ends) => self.give_up(),
                () = tokio::time::sleep_until(ends), if self.paused.is_none() => {
                    tracing::warn!(
                        "the last results were not written to the journal in time; they are computed again when the run is continued"
                    );
                    return;
                }
            }
        }
    }

    async fn close(mut self) -> RunSummary {
        self.anticipate(Vec::new());
        self.handle(Input::Finish);
        self.write_last().await;
        self.handle(Input::Close);
        self.record(Event::Closed);
        let now = self.begun.elapsed();
        let last = self.coordination.core().snapshot(now);
        let workers = self.workers.take();
        let mut journal = self.journal;
        let ended = tokio::task::spawn_blocking(move || drop(workers));
        self.link.close().await;
        let written = tokio::task::spawn_blocking(move || journal.close());
        for (what, ending) in [("local workers", ended), ("journal", written)] {
            if !matches!(timeout(2 * LAST_WRITE, ending).await, Ok(Ok(()))) {
                tracing::warn!("the {what} did not end in time");
            }
        }
        RunSummary {
            last,
            replayed: self.replayed,
            wall_s: now.as_secs_f64(),
        }
    }
}

async fn until(moment: Option<tokio::time::Instant>) {
    match moment {
        Some(moment) => tokio::time::sleep_until(moment).await,
        None => std::future::pending().await,
    }
}

async fn local_event(workers: &mut Option<LocalWorkers>) -> LocalEvent {
    let event = match workers {
        Some(workers) => workers.event().await,
        None => None,
    };
    match event {
        Some(event) => event,
        None => std::future::pending().await,
    }
}
