//! Scenarios: whole clusters without a socket, a file or a clock.
use super::*;
use protocol::{
    announce::Announcement,
    id::AttemptId,
    job::{Failure, Outcome},
    message::{Beat, FromWorker, Order},
};

const CASE: ContentHash = ContentHash([7; 32]);

/// A core with the time and everything it asked for.
struct Scene {
    core: Core,
    now: Duration,
    orders: Vec<(WorkerId, Order)>,
    acknowledged: Vec<(WorkerId, Attempt)>,
    cancelled: Vec<(WorkerId, Attempt)>,
    delivered: Vec<(u64, Outcome)>,
    storing: Vec<JobId>,
    other: Vec<Command>,
}

impl Scene {
    fn new() -> Self {
        Self::with(BTreeSet::new(), 1)
    }

    fn with(finished: BTreeSet<JobId>, epoch: u32) -> Self {
        let core = Core::new(CoreOptions {
            run: RunId(1),
            epoch,
            case: CASE,
            case_bytes: 10,
            model_digest: None,
            finished,
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
                Command::Deliver { id, outcome } => self.delivered.push((id.0, outcome)),
                Command::Store(finished) => self.storing.push(finished.job()),
                other @ (Command::Send { .. }
                | Command::Record(_)
                | Command::Notice(_)
                | Command::Stop(_)) => self.other.push(other),
            }
        }
        self.check();
    }

    /// What must hold after every step.
    fn check(&self) {
        for (id, pending) in &self.core.jobs {
            let queued = self.core.queue.contains(id);
            assert_eq!(
                queued,
                pending.holders.is_empty(),
                "job {id} is queued or held"
            );
            assert!(
                !self.core.has_finished(*id),
                "job {id} is pending or finished"
            );
            for holder in &pending.holders {
                assert!(self.core.members[holder].holds(*id), "{holder} holds {id}");
            }
        }
        for member in self.core.members.values() {
            let most = self.core.options.policy.per_slot * member.slots();
            assert!(member.leases.len() <= most, "more than {most} outstanding");
        }
    }

    fn hear(&mut self, from: u64, message: FromWorker) {
        self.tell(Input::Heard {
            from: WorkerId(from),
            message,
        });
    }

    fn announce(&mut self, id: u64, slots: u32, digest: &str) {
        let announcement = Announcement {
            protocol: wire::VERSION,
            build: "1".to_owned(),
            model_digest: digest.to_owned(),
            host: "host".to_owned(),
            pid: 3,
            slots,
            cores: 8,
            job_kinds: Vec::new(),
            effects: Vec::new(),
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
            FromWorker::Beat(Beat {
                case: Some(CASE),
                running,
                ..Beat::default()
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
        self.answer(from, attempt, Outcome::Nothing(vec![1]));
    }

    fn fail(&mut self, from: u64, attempt: Attempt, failure: Failure) {
        self.answer(from, attempt, Outcome::Failed(failure));
    }

    fn answer(&mut self, from: u64, attempt: Attempt, outcome: Outcome) {
        let work = work_hash(&job(attempt.job.0));
        let done = Done {
            attempt,
            work,
            wall_us: 1000,
            outcome,
        };
        self.hear(from, FromWorker::Done(Box::new(done)));
    }

    fn stored(&mut self) {
        let jobs = mem::take(&mut self.storing);
        self.tell(Input::Stored { jobs });
    }

    /// Orders since the last call, as (worker, attempt).
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

fn job(n: u64) -> Job {
    Job::Nothing {
        payload: n.to_le_bytes().to_vec(),
        reply_bytes: 1,
        delay_ms: 0,
    }
}

fn crash() -> Failure {
    Failure::Crashed {
        how: "signal 11".to_owned(),
    }
}

#[test]
fn jobs_go_to_idle_workers_first_and_each_holds_two_per_slot_at_most() {
    let mut scene = Scene::new();
    scene.join(1, 1);
    scene.join(2, 2);
    scene.submit(0..10);
    let given = scene.given();
    let jobs: Vec<u64> = given.iter().map(|(_, attempt)| attempt.job.0).collect();
    assert_eq!(jobs, [0, 1, 2, 3, 4, 5]);
    let first: BTreeSet<u64> = given[..3].iter().map(|(to, _)| *to).collect();
    assert_eq!(
        first.len(),
        2,
        "both are busy before anyone gets a second job per slot"
    );
    assert_eq!(given.iter().filter(|(to, _)| *to == 1).count(), 2);
}

#[test]
fn a_worker_without_the_case_gets_nothing() {
    let mut scene = Scene::new();
    scene.announce(1, 1, "m");
    scene.submit(0..1);
    assert_eq!(scene.given(), []);
    scene.beat(1, &[]);
    assert_eq!(scene.given().len(), 1);
}

#[test]
fn a_result_is_acknowledged_only_once_it_is_stored() {
    let mut scene = Scene::new();
    scene.join(1, 1);
    scene.submit(0..1);
    let (_, attempt) = scene.given()[0];
    scene.finish(1, attempt);
    assert_eq!(scene.delivered.len(), 1);
    assert_eq!(scene.acknowledged, []);
    // repeated by an impatient worker: neither delivered nor acknowledged before it is safe
    scene.finish(1, attempt);
    assert_eq!((scene.delivered.len(), scene.acknowledged.len()), (1, 0));
    scene.stored();
    assert_eq!(scene.acknowledged, [(WorkerId(1), attempt)]);
    scene.finish(1, attempt);
    assert_eq!((scene.delivered.len(), scene.acknowledged.len()), (1, 2));
}

#[test]
fn a_silent_worker_is_lost_after_four_seconds_and_its_late_result_still_counts() {
    let mut scene = Scene::new();
    scene.join(1, 1);
    scene.submit(0..1);
    let (_, first) = scene.given()[0];
    scene.join(2, 1);
    scene.wait(4, &[2]);
    assert_eq!(scene.given(), []);
    scene.wait(1, &[2]);
    let again = scene.given();
    assert_eq!(again.len(), 1);
    assert_eq!((again[0].0, again[0].1.job), (2, JobId(0)));
    assert_ne!(again[0].1, first, "another attempt");
    // the first one wakes up and is first: its result counts, the other attempt is cancelled
    scene.finish(1, first);
    assert_eq!(scene.delivered.len(), 1);
    assert_eq!(scene.cancelled, [(WorkerId(2), again[0].1)]);
    scene.finish(2, again[0].1);
    assert_eq!(scene.delivered.len(), 1);
    scene.stored();
    assert_eq!(scene.acknowledged.len(), 2, "both may forget it");
}

#[test]
fn a_coordinator_that_stood_still_blames_nobody() {
    let mut scene = Scene::new();
    scene.join(1, 1);
    scene.submit(0..1);
    scene.now += Duration::from_mins(5);
    scene.tell(Input::Tick);
    assert_eq!(scene.core.snapshot(scene.now).lost, 0);
    assert!(
        scene
            .notices()
            .iter()
            .any(|notice| matches!(notice, Notice::Stalled { .. }))
    );
    scene.wait(5, &[]);
    assert_eq!(
        scene.core.snapshot(scene.now).lost,
        1,
        "silence afterwards still counts"
    );
}

#[test]
fn an_order_that_got_lost_is_sent_again_as_the_same_attempt() {
    let mut scene = Scene::new();
    scene.join(1, 1);
    scene.submit(0..1);
    let given = scene.given();
    for _ in 0..3 {
        scene.now += Duration::from_millis(900);
        scene.beat(1, &[]);
    }
    assert_eq!(scene.given(), given);
    scene.now += Duration::from_millis(900);
    scene.beat(1, &[given[0].1]);
    assert_eq!(scene.given(), []);
}

#[test]
fn a_job_that_crashes_twice_is_given_up_and_recorded() {
    let mut scene = Scene::new();
    scene.join(1, 1);
    scene.submit(0..1);
    let (_, first) = scene.given()[0];
    scene.fail(1, first, crash());
    assert_eq!(scene.delivered, []);
    let (_, second) = scene.given()[0];
    scene.fail(1, second, crash());
    assert_eq!(scene.delivered, [(0, Outcome::Failed(crash()))]);
    assert_eq!(scene.storing, [JobId(0)]);
    assert_eq!(scene.given(), []);
}

/// A job over which workers die runs alone, so that no other job can be blamed or harmed.
#[test]
fn a_job_that_killed_two_workers_runs_alone_and_two_more_are_the_end() {
    let mut scene = Scene::new();
    scene.submit(0..1);
    for worker in 1..=2 {
        scene.join(worker, 2);
        assert_eq!(scene.given().len(), 1);
        scene.tell(Input::Gone {
            worker: WorkerId(worker),
        });
    }
    assert!(scene.notices().contains(&&Notice::Quarantined {
        job: JobId(0),
        workers: 2
    }));
    scene.submit(1..9);
    scene.join(3, 2);
    let given = scene.given();
    assert_eq!(given.len(), 1, "nothing else beside it: {given:?}");
    assert_eq!(given[0].1.job, JobId(0));
    scene.join(4, 2);
    assert_eq!(scene.given().len(), 4, "others go on elsewhere");
    scene.tell(Input::Gone {
        worker: WorkerId(3),
    });
    assert_eq!(scene.given(), [], "it waits for a worker of its own");
    scene.join(5, 1);
    assert_eq!(scene.given()[0].1.job, JobId(0));
    scene.tell(Input::Gone {
        worker: WorkerId(5),
    });
    assert_eq!(
        scene.delivered,
        [(0, Outcome::Failed(Failure::Lost { workers: 4 }))]
    );
}

#[test]
fn what_waited_on_a_lost_worker_is_not_blamed() {
    let mut scene = Scene::new();
    scene.submit(0..2);
    for worker in 1..=4 {
        scene.join(worker, 1);
        assert_eq!(
            scene.given().len(),
            2 - usize::from(worker > 2),
            "worker {worker}"
        );
        scene.tell(Input::Gone {
            worker: WorkerId(worker),
        });
    }
    // the job in front was lost four times, the one behind it never
    assert_eq!(
        scene.delivered,
        [(0, Outcome::Failed(Failure::Lost { workers: 4 }))]
    );
    assert!(scene.core.jobs[&JobId(1)].failures.losses <= 1);
}

#[test]
fn a_refusal_goes_to_the_others_and_ends_when_all_have_refused() {
    let refusal = || Failure::Refused {
        reason: "no dynamics".to_owned(),
    };
    let mut scene = Scene::new();
    scene.join(1, 1);
    scene.join(2, 1);
    scene.submit(0..1);
    let (first, attempt) = scene.given()[0];
    scene.fail(first, attempt, refusal());
    let (second, attempt) = scene.given()[0];
    assert_ne!(first, second);
    scene.fail(second, attempt, refusal());
    assert_eq!(scene.delivered, [(0, Outcome::Failed(refusal()))]);
    assert_eq!(
        scene.storing,
        [],
        "another build may do better: no result of the run"
    );
}

#[test]
fn if_everything_fails_the_run_stops_with_one_message() {
    let mut scene = Scene::new();
    scene.join(1, 1);
    scene.submit(0..20);
    let bad = Failure::Misconfigured {
        field: "beam".to_owned(),
        problem: "no mass".to_owned(),
    };
    for _ in 0..10 {
        for (to, attempt) in scene.given() {
            scene.fail(to, attempt, bad.clone());
        }
    }
    let stops: Vec<&Command> = scene
        .other
        .iter()
        .filter(|command| matches!(command, Command::Stop(_)))
        .collect();
    assert_eq!(
        stops,
        [&Command::Stop(Stop::EverythingFails { jobs: 8, last: bad })]
    );
}

#[test]
fn another_model_is_refused_by_name() {
    let mut scene = Scene::new();
    scene.join(1, 1);
    scene.announce(2, 1, "another");
    let mut refused = None;
    for command in &scene.other {
        if let Command::Send {
            to: WorkerId(2),
            message: ToWorker::Refused { reason },
        } = command
        {
            refused = Some(reason);
        }
    }
    let reason = refused.unwrap();
    assert!(
        reason.contains("model_digest is another, this run's is m"),
        "{reason}"
    );
    scene.announce(3, 0, "m");
    assert_eq!(scene.core.snapshot(scene.now).workers.len(), 1);
}

#[test]
fn people_are_told_once_that_nobody_is_there() {
    let mut scene = Scene::new();
    scene.submit(0..3);
    scene.wait(60, &[]);
    assert_eq!(
        scene.notices(),
        [&Notice::NoWorker {
            jobs: 3,
            refused: 0
        }]
    );
}

/// A worker that outlived the coordinator keeps what it computes, and delivers what it finished
/// before the jobs were even submitted again.
#[test]
fn work_that_outlived_the_coordinator_is_not_done_again() {
    let mut scene = Scene::with(BTreeSet::from([JobId(0)]), 2);
    let old = |job| Attempt {
        job: JobId(job),
        attempt: AttemptId(1 << 16),
    };
    scene.announce(1, 2, "m");
    scene.beat(1, &[old(2), old(3)]);
    scene.finish(1, old(1));
    scene.finish(1, old(0));
    assert_eq!(scene.acknowledged, [(WorkerId(1), old(0))], "known already");
    scene.submit(1..5);
    assert_eq!(scene.delivered.len(), 1, "job 1, finished meanwhile");
    let given: Vec<u64> = scene
        .given()
        .iter()
        .map(|(_, attempt)| attempt.job.0)
        .collect();
    assert_eq!(given, [4], "2 and 3 are being computed");
    scene.finish(1, old(2));
    scene.finish(1, old(3));
    assert_eq!(scene.delivered.len(), 3);
}

#[test]
fn an_answer_to_another_question_is_not_taken() {
    let mut scene = Scene::new();
    scene.join(1, 1);
    scene.submit(0..1);
    let (_, attempt) = scene.given()[0];
    let work = ContentHash::of(b"another job");
    let outcome = Outcome::Nothing(Vec::new());
    let done = Done {
        attempt,
        work,
        wall_us: 1,
        outcome,
    };
    scene.hear(1, FromWorker::Done(Box::new(done)));
    assert_eq!(scene.delivered, []);
}

#[test]
fn an_idle_worker_takes_what_waits_elsewhere() {
    let mut scene = Scene::new();
    scene.join(1, 2);
    scene.submit(0..4);
    let held = scene.given();
    assert_eq!(held.len(), 4);
    scene.now += Duration::from_millis(60);
    scene.join(2, 1);
    let moved = scene.given();
    assert_eq!(moved.len(), 1);
    assert_eq!(
        (moved[0].0, moved[0].1.job),
        (2, JobId(3)),
        "the last one in the line"
    );
    assert_eq!(scene.cancelled, [(WorkerId(1), held[3].1)]);
}

#[test]
fn an_overdue_job_gets_a_second_longer_try() {
    let mut scene = Scene::new();
    scene.join(1, 1);
    scene.submit(0..1);
    let first = scene.orders[0].1.deadline_ms;
    let (_, attempt) = scene.given()[0];
    let overdue = || Failure::Deadline { limit_ms: 120_000 };
    scene.fail(1, attempt, overdue());
    assert_eq!(scene.orders[0].1.deadline_ms, 2 * first);
    let (_, attempt) = scene.given()[0];
    scene.fail(1, attempt, overdue());
    assert_eq!(scene.delivered, [(0, Outcome::Failed(overdue()))]);
}

/// The worker ends what is overdue; should it not, the core does.
#[test]
fn a_worker_that_does_not_end_an_overdue_job_loses_it() {
    let mut scene = Scene::new();
    scene.join(1, 1);
    scene.submit(0..1);
    let (_, attempt) = scene.given()[0];
    scene.wait(129, &[1]);
    assert_eq!(scene.cancelled, []);
    scene.wait(4, &[1]);
    assert_eq!(scene.cancelled, [(WorkerId(1), attempt)]);
}

/// A worker that leaves in good order is not counted as lost, even if its connection ends next.
#[test]
fn leaving_blames_no_job() {
    let mut scene = Scene::new();
    scene.join(1, 1);
    scene.submit(0..1);
    scene.given();
    let reason = "it was asked to end".to_owned();
    scene.hear(1, FromWorker::Leaving { reason });
    let answer = Command::Send {
        to: WorkerId(1),
        message: ToWorker::Ended,
    };
    assert!(scene.other.contains(&answer), "it waits for an answer");
    scene.tell(Input::Gone {
        worker: WorkerId(1),
    });
    assert_eq!(scene.core.snapshot(scene.now).lost, 0);
    assert_eq!(scene.core.jobs[&JobId(0)].failures.losses, 0);
    scene.join(2, 1);
    assert_eq!(scene.given().len(), 1);
}
