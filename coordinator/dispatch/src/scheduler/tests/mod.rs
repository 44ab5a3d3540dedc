//! Scenario tests of the scheduler without sockets, files or clocks.
use super::*;
use crate::simulated::{self, CASE, MODEL, PROOF, announcement, cost, job};
use journal::event::{Event, Spent};
use protocol::{
    announce::Announcement,
    case::Reproducibility,
    id::{AttemptId, ContentHash, JobId, RunId, WorkerId},
    job::{Answer, Failure, Outcome},
    message::{Assignment, Attempt, Done, FromWorker, Heartbeat, ToWorker},
};
use std::{
    collections::{BTreeMap, BTreeSet},
    mem,
    time::Duration,
};

mod accounting;
mod admission;
mod anticipated;
mod drain;
mod failure;
mod lease;
mod loss;
mod tail;
mod window;

/// Scheduler core under test, with a simulated time and the commands it has emitted.
struct Scene {
    core: Core,
    now: Duration,
    orders: Vec<(WorkerId, Assignment)>,
    acknowledged: Vec<(WorkerId, Attempt)>,
    cancelled: Vec<(WorkerId, Attempt)>,
    delivered: Vec<(u64, Outcome)>,
    storing: Vec<JobId>,
    other: Vec<Command>,
    /// Computing time that the simulated workers report per job \[us\].
    wall_us: u64,
}

impl Scene {
    fn new() -> Self {
        Self::with(JobSet::default(), 1)
    }

    fn with(finished: JobSet, epoch: u32) -> Self {
        let core = Core::new(CoreOptions {
            run: RunId(1),
            epoch,
            case: CASE,
            case_bytes: 10,
            model: MODEL.to_owned(),
            model_digest: None,
            repeats: Reproducibility::Bits,
            proof: None,
            finished,
            expected: BTreeSet::new(),
            policy: Policy::default(),
        });
        Self {
            core,
            now: Duration::from_secs(100),
            orders: Vec::new(),
            acknowledged: Vec::new(),
            cancelled: Vec::new(),
            delivered: Vec::new(),
            storing: Vec::new(),
            other: Vec::new(),
            wall_us: 1000,
        }
    }

    fn tell(&mut self, input: Input) {
        for command in self.core.handle(input, self.now) {
            match command {
                Command::Send {
                    to,
                    message: ToWorker::Run(order),
                } => self.orders.push((to, *order)),
                Command::Send {
                    to,
                    message: ToWorker::Cancel(attempt),
                } => {
                    self.cancelled.push((to, attempt));
                }
                Command::Send {
                    to,
                    message: ToWorker::Stored(attempts),
                } => {
                    self.acknowledged
                        .extend(attempts.into_iter().map(|attempt| (to, attempt)));
                }
                Command::Deliver(done) => self.delivered.push((done.id.0, done.outcome)),
                Command::Store(finished) => self.storing.push(finished.job()),
                other @ (Command::Send { .. }
                | Command::Record(_)
                | Command::Notice(_)
                | Command::Stop(_)) => self.other.push(other),
            }
        }
        self.core.check_invariants();
    }

    fn hear(&mut self, from: u64, message: FromWorker) {
        self.tell(Input::Message {
            from: WorkerId(from),
            message,
        });
    }

    fn announce(&mut self, id: u64, slots: u32, digest: &str) {
        let announcement = Announcement {
            slots,
            ..announcement(digest)
        };
        self.hear(id, FromWorker::Announce(Box::new(announcement)));
    }

    fn join(&mut self, id: u64, slots: u32) {
        self.announce(id, slots, "m");
        self.beat(id, &[]);
    }

    fn beat(&mut self, id: u64, running: &[Attempt]) {
        let running = running.to_vec();
        self.hear(
            id,
            FromWorker::Beat(Heartbeat {
                case: Some(CASE),
                proof: Some(PROOF),
                running,
                ..Heartbeat::default()
            }),
        );
    }

    fn submit(&mut self, jobs: std::ops::Range<u64>) {
        for id in jobs {
            self.tell(Input::Submit {
                id: JobId(id),
                job: job(id),
            });
        }
    }

    fn finish(&mut self, from: u64, attempt: Attempt) {
        self.answer(from, attempt, Outcome::Done(Answer::Nothing(vec![1])));
    }

    fn fail(&mut self, from: u64, attempt: Attempt, failure: Failure) {
        self.answer(from, attempt, Outcome::Failed(failure));
    }

    fn answer(&mut self, from: u64, attempt: Attempt, outcome: Outcome) {
        let work = job(attempt.job.0).work_hash();
        let done = Done {
            attempt,
            work,
            cost: cost(self.wall_us),
            outcome,
        };
        self.hear(from, FromWorker::Done(Box::new(done)));
    }

    fn stored(&mut self) {
        let jobs = mem::take(&mut self.storing);
        self.tell(Input::Stored { jobs });
    }

    /// Returns the orders sent to workers since the last call, as pairs of worker and attempt.
    fn given(&mut self) -> Vec<(u64, Attempt)> {
        let orders = self.orders.drain(..);
        orders.map(|(to, order)| (to.0, order.attempt)).collect()
    }

    fn wait(&mut self, seconds: u64, speaking: &[u64]) {
        for _ in 0..seconds * 4 {
            self.now += Duration::from_millis(250);
            for id in speaking {
                let leases = self.core.members.get(&WorkerId(*id)).map(|member| {
                    member
                        .leases
                        .iter()
                        .map(|lease| lease.attempt)
                        .collect::<Vec<_>>()
                });
                self.beat(*id, &leases.unwrap_or_default());
            }
            self.tell(Input::Tick);
        }
    }

    fn notices(&self) -> Vec<&Notice> {
        let mut notices = Vec::new();
        for command in &self.other {
            if let Command::Notice(notice) = command {
                notices.push(notice);
            }
        }
        notices
    }
}

fn crash() -> Failure {
    Failure::crashed("signal 11".to_owned())
}
