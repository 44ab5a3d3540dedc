//! State of a worker, and its reaction to each message.
use super::{
    case::Incoming,
    options::{Ending, SessionOptions},
    proof::{self, Progress},
};
use crate::{
    outbox::Outbox,
    pool::{CaseBytes, Freed, Pool, Task},
    status::Status,
};
use link::{LinkError, WorkerEnd};
use protocol::{
    announce::Announcement,
    case::Reproducibility,
    id::{ContentHash, RunId},
    key::Lane,
    message::{Assignment, Attempt, Done, FromWorker, Heartbeat, ToWorker},
    wire::{self, FrameKind, WireError},
};
use std::{
    collections::{BTreeMap, VecDeque},
    time::Duration,
};
use tokio::task::{JoinError, JoinSet};

/// Interval at which a worker sends heartbeats to the coordinator.
const HEARTBEAT_INTERVAL: Duration = Duration::from_secs(1);

/// Consequence of a message for the session: continue or end.
#[derive(Debug)]
pub(super) enum Step {
    Go,
    End(Ending),
}

#[derive(Debug)]
pub(super) struct State {
    options: SessionOptions,
    announcement: Announcement,
    pool: Pool,
    /// Id of the current run; 0 until a coordinator has admitted the worker.
    run: RunId,
    admitted: bool,
    case: Option<CaseBytes>,
    proof: Progress,
    /// Repeatability of the results of the case's model (same bits, within a tolerance, or unknown).
    repeats: Reproducibility,
    incoming: Option<Incoming>,
    pub(super) fetching: JoinSet<Result<Vec<u8>, LinkError>>,
    waiting: VecDeque<Assignment>,
    /// Attempt that each slot is running, with the hash of its work, by slot index.
    running: BTreeMap<usize, (Attempt, ContentHash)>,
    outbox: Outbox,
    beats: u64,
    next_beat: Duration,
    last_work: Duration,
}

impl State {
    pub(super) fn new(options: SessionOptions, announcement: Announcement, pool: Pool) -> Self {
        Self {
            announcement,
            options,
            pool,
            run: RunId::default(),
            admitted: false,
            case: None,
            proof: Progress::Missing,
            repeats: Reproducibility::Bits,
            incoming: None,
            fetching: JoinSet::new(),
            waiting: VecDeque::new(),
            running: BTreeMap::new(),
            outbox: Outbox::default(),
            beats: 0,
            next_beat: Duration::ZERO,
            last_work: Duration::ZERO,
        }
    }

    pub(super) async fn handle_frame<L: WorkerEnd>(
        &mut self,
        link: &mut L,
        frame: &[u8],
        now: Duration,
    ) -> Step {
        let (run, message) = match wire::decode_frame::<ToWorker>(FrameKind::ToWorker, frame) {
            Ok(heard) => heard,
            Err(error @ WireError::Version { .. }) => {
                return Step::End(Ending::Refused(error.to_string()));
            }
            Err(error) => {
                tracing::debug!(%error, "a frame was dropped");
                return Step::Go;
            }
        };
        let ours = self.admitted && run == self.run;
        match message {
            ToWorker::Identify => self.announce(link),
            ToWorker::Admitted {
                case, case_bytes, ..
            } => {
                self.join(link, run, case, case_bytes).await;
                self.beat(link, now);
            }
            ToWorker::Refused { reason } => return Step::End(Ending::Refused(reason)),
            ToWorker::Run(order) if ours => self.take(link, *order, now),
            ToWorker::Cancel(attempt) if ours => self.cancel(attempt),
            ToWorker::Stored(attempts) if ours => self.outbox.acknowledge(&attempts),
            ToWorker::Ended if ours => {
                tracing::info!(run = %self.run, "the run is over");
                if self.options.embedded {
                    return Step::End(Ending::RunOver);
                }
                self.forget();
            }
            ToWorker::Run(_) | ToWorker::Cancel(_) | ToWorker::Stored(_) | ToWorker::Ended => {
                tracing::debug!(%run, "a message of another run was dropped");
            }
        }
        Step::Go
    }

    async fn join<L: WorkerEnd>(
        &mut self,
        link: &mut L,
        run: RunId,
        case: ContentHash,
        case_bytes: u64,
    ) {
        let again = self.admitted && run == self.run;
        if run != self.run {
            self.forget();
            self.run = run;
        }
        if !again {
            tracing::info!(%run, "admitted");
            self.options.status.set(Status::Admitted);
            if let Err(error) = link.announce_presence(run).await {
                // the heartbeat alone will do
                tracing::warn!(%error, "cannot declare the worker's presence on the bus");
            }
        }
        self.admitted = true;
        self.outbox.make_all_due();
        let held = self.case.as_ref().is_some_and(|held| held.hash == case);
        let mut incoming = self.incoming.iter();
        if held || !incoming.any(|incoming| incoming.hash() == case) {
            self.incoming = (!held).then(|| Incoming::new(case, case_bytes));
            self.fetching.abort_all();
        }
        self.fetch(link);
    }

    /// Requests the next part of the case from the coordinator, unless a request is pending.
    fn fetch<L: WorkerEnd>(&mut self, link: &L) {
        if let (Some(incoming), true) = (&self.incoming, self.fetching.is_empty()) {
            self.fetching
                .spawn(link.fetch(self.run, incoming.hash(), incoming.next()));
        }
    }

    pub(super) fn piece<L: WorkerEnd>(
        &mut self,
        link: &mut L,
        piece: Result<Result<Vec<u8>, LinkError>, JoinError>,
    ) -> Step {
        match (piece, &mut self.incoming) {
            (Ok(Ok(piece)), Some(incoming)) => {
                if let Some(case) = incoming.take(&piece) {
                    tracing::debug!(hash = %case.hash, bytes = case.bytes.len(), "the case is here");
                    self.case = Some(case);
                    self.proof = Progress::Missing;
                    self.incoming = None;
                    if let Some(refused) = self.start_proof() {
                        return refused;
                    }
                }
                self.fetch(link);
            }
            // asked for again at the next tick
            (Ok(Err(error)), _) => tracing::debug!(%error, "a piece is missing"),
            (Ok(Ok(_)) | Err(_), _) => {}
        }
        Step::Go
    }

    /// Starts the computation of the case's reference individual in a slot, if its proof is missing and a
    /// slot is free.
    fn start_proof(&mut self) -> Option<Step> {
        let missing = self.proof == Progress::Missing;
        let case = self.case.as_ref().filter(|_| missing)?;
        let slot = (0..self.pool.len()).find(|slot| !self.running.contains_key(slot))?;
        match proof::task(self.options.simulators, case) {
            Ok((task, repeats)) => {
                self.proof = Progress::Running;
                self.repeats = repeats;
                self.running.insert(slot, (task.attempt, case.hash));
                self.pool.run(slot, task);
                None
            }
            Err(reason) => Some(Step::End(Ending::Refused(reason))),
        }
    }

    fn take<L: WorkerEnd>(&mut self, link: &mut L, order: Assignment, now: Duration) {
        self.last_work = now;
        let attempt = order.attempt;
        if let Some(done) = self.outbox.get(attempt) {
            let message = FromWorker::Done(Box::new(done.clone()));
            self.send(link, Lane::Data, &message);
        } else if !self.holds(attempt) && !self.outbox.is_settled(attempt) {
            self.waiting.push_back(order);
            self.fill();
        }
    }

    fn holds(&self, attempt: Attempt) -> bool {
        self.running.values().any(|(held, _)| *held == attempt)
            || self.waiting.iter().any(|order| order.attempt == attempt)
    }

    fn fill(&mut self) {
        for slot in 0..self.pool.len() {
            if self.running.contains_key(&slot) {
                continue;
            }
            let Some(Assignment {
                attempt,
                deadline_ms,
                job,
            }) = self.waiting.pop_front()
            else {
                return;
            };
            let work = job.work_hash();
            self.running.insert(slot, (attempt, work));
            let deadline = Duration::from_millis(deadline_ms);
            let case = self.case.clone();
            self.pool.run(
                slot,
                Task {
                    attempt,
                    deadline,
                    job: Box::new(job),
                    case,
                },
            );
        }
    }

    fn cancel(&mut self, attempt: Attempt) {
        self.waiting.retain(|order| order.attempt != attempt);
        self.outbox.acknowledge(&[attempt]);
        self.outbox.remember(attempt);
        for (slot, (held, _)) in &self.running {
            if *held == attempt {
                self.pool.cancel(*slot, attempt);
            }
        }
    }

    pub(super) fn freed<L: WorkerEnd>(
        &mut self,
        link: &mut L,
        freed: Freed,
        now: Duration,
    ) -> Step {
        self.last_work = now;
        let held = self.running.remove(&freed.slot);
        if freed.attempt == proof::ATTEMPT {
            let of = held.map(|(_, case)| case);
            if of != self.case.as_ref().map(|case| case.hash) {
                // of a case that was left meanwhile: it proves nothing
                self.fill();
                return Step::Go;
            }
            match Progress::of(freed.outcome, self.repeats) {
                Ok(proof) => self.proof = proof,
                Err(reason) => return Step::End(Ending::Refused(reason)),
            }
            self.send_beat(link);
            self.fill();
            return Step::Go;
        }
        if let (Some(outcome), Some((attempt, work))) = (freed.outcome, held) {
            let done = Done {
                attempt,
                work,
                cost: freed.cost,
                outcome,
            };
            if !self.outbox.is_settled(attempt) {
                self.send(link, Lane::Data, &FromWorker::Done(Box::new(done.clone())));
                self.outbox.put(done, now);
            }
        }
        self.fill();
        Step::Go
    }

    pub(super) fn tick<L: WorkerEnd>(&mut self, link: &mut L, now: Duration) -> Step {
        for done in self.outbox.due(now) {
            self.send(link, Lane::Data, &FromWorker::Done(Box::new(done)));
        }
        self.fetch(link);
        if let Some(refused) = self.start_proof() {
            return refused;
        }
        if now >= self.next_beat {
            self.beat(link, now);
        }
        let idle = self.waiting.is_empty() && self.running.is_empty();
        match self.options.idle_timeout {
            Some(timeout) if idle && now.saturating_sub(self.last_work) >= timeout => {
                Step::End(Ending::Idle)
            }
            _ => Step::Go,
        }
    }

    fn beat<L: WorkerEnd>(&mut self, link: &mut L, now: Duration) {
        self.next_beat = now + HEARTBEAT_INTERVAL;
        if self.admitted {
            self.send_beat(link);
        } else {
            self.announce(link);
        }
    }

    /// Sends a heartbeat, unless a slot is stuck.
    fn send_beat<L: WorkerEnd>(&mut self, link: &mut L) {
        if !self.pool.is_alive() {
            tracing::error!("a slot is stuck: no heartbeat is sent");
            return;
        }
        let here = self.incoming.is_none();
        let beat = Heartbeat {
            number: self.beats,
            // what is held of an earlier run says nothing of this one
            case: self.case.as_ref().map(|case| case.hash).filter(|_| here),
            proof: self.proof.known().filter(|_| here),
            running: self
                .running
                .values()
                .map(|(attempt, _)| *attempt)
                .filter(|attempt| *attempt != proof::ATTEMPT)
                .collect(),
            waiting: self.waiting.iter().map(|order| order.attempt).collect(),
            finished: self.outbox.attempts(),
        };
        self.beats += 1;
        self.send(link, Lane::Control, &FromWorker::Beat(beat));
    }

    fn announce<L: WorkerEnd>(&self, link: &mut L) {
        let message = FromWorker::Announce(Box::new(self.announcement.clone()));
        self.send(link, Lane::Control, &message);
    }

    /// Tells the coordinator that the worker leaves, unless the coordinator itself caused this; returns
    /// whether an acknowledgement is to be expected.
    pub(super) fn leave<L: WorkerEnd>(&self, link: &mut L, ending: &Ending) -> bool {
        let reason = match ending {
            Ending::Asked => "it was asked to end",
            Ending::Idle => "there was no work",
            Ending::RunOver | Ending::Refused(_) | Ending::Unlinked => return false,
        };
        let message = FromWorker::Leaving {
            reason: reason.to_owned(),
        };
        self.send(link, Lane::Control, &message);
        self.admitted
    }

    /// Waits until the coordinator acknowledges that the worker leaves.
    pub(super) async fn await_leave_ack<L: WorkerEnd>(&self, link: &mut L) {
        while let Some(frame) = link.receive().await {
            if matches!(
                wire::decode_frame(FrameKind::ToWorker, &frame),
                Ok((_, ToWorker::Ended))
            ) {
                return;
            }
        }
    }

    fn send<L: WorkerEnd>(&self, link: &mut L, lane: Lane, message: &FromWorker) {
        match wire::encode_frame(FrameKind::FromWorker, self.run, message) {
            Ok(frame) => link.send(self.run, lane, frame),
            Err(error) => tracing::error!(%error, "a message cannot be sent"),
        }
    }

    /// Discards queue, results and running jobs, because the run they belong to is over.
    fn forget(&mut self) {
        self.admitted = false;
        self.waiting.clear();
        self.outbox.clear();
        for (slot, (attempt, _)) in &self.running {
            self.outbox.remember(*attempt);
            self.pool.cancel(*slot, *attempt);
        }
    }
}
