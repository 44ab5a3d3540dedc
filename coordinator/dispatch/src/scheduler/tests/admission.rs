//! Tests of the admission of workers to a run.
use super::*;
use protocol::{
    case::Reproducibility,
    proof::{MAX_SAMPLES, ReferenceResult, Sample},
};

#[test]
fn a_worker_without_the_case_gets_nothing() {
    let mut scene = Scene::new();
    scene.announce(1, 1, "m");
    scene.submit(0..1);
    assert_eq!(scene.given(), []);
    scene.beat(1, &[]);
    assert_eq!(scene.given().len(), 1);
}

/// Returns the reason sent to a refused worker, after checking that the notice to the user states the same
/// reason.
fn refusal(scene: &Scene, id: u64) -> Option<String> {
    let told = scene.other.iter().find_map(|command| match command {
        Command::Send {
            to,
            message: ToWorker::Refused { reason },
        } if *to == WorkerId(id) => Some(reason.clone()),
        Command::Send { .. }
        | Command::Store(_)
        | Command::Record(_)
        | Command::Deliver(_)
        | Command::Notice(_)
        | Command::Stop(_) => None,
    })?;
    let said = scene.notices().into_iter().any(
        |notice| matches!(notice, Notice::Refused { worker: WorkerId(it), reason, .. } if *it == id && *reason == told),
    );
    assert!(said, "both sides say it: {told}");
    Some(told)
}

fn effect(id: &str) -> protocol::announce::EffectDescriptor {
    protocol::announce::EffectDescriptor {
        id: id.to_owned(),
        title: id.to_owned(),
        joint: "saddle".to_owned(),
        place: protocol::announce::Place::Dynamics,
        generic: false,
        parameters: Vec::new(),
    }
}

/// Returns a worker's announcement with the given effects added to those supported by its model.
fn with(
    mut announcement: Announcement,
    effects: Vec<protocol::announce::EffectDescriptor>,
) -> Announcement {
    announcement.models[0].effects = effects;
    announcement
}

/// Checks that oversized or malformed announcements are refused with the field's name and not kept, since
/// they could fill the memory or corrupt a terminal.
#[test]
fn absurd_announcements_are_refused_by_the_name_of_the_field() {
    let long = || "x".repeat(256);
    let absurd = [
        (
            "host has 256 bytes, at most 255 are allowed",
            Announcement {
                host: long(),
                ..announcement("m")
            },
        ),
        (
            "host holds control characters",
            Announcement {
                host: "a\u{1b}[2J".to_owned(),
                ..announcement("m")
            },
        ),
        (
            "build has 256 bytes",
            Announcement {
                build: long(),
                ..announcement("m")
            },
        ),
        ("models.digest has 256 bytes", announcement(&long())),
        (
            "job_kinds has 8008 bytes, at most 4096 are allowed",
            Announcement {
                job_kinds: vec![String::new(); 1000],
                ..announcement("m")
            },
        ),
        (
            "models has",
            with(announcement("m"), vec![effect(&"x".repeat(300_000)); 2]),
        ),
    ];
    let mut scene = Scene::new();
    for (id, (reason, announcement)) in (2..).zip(absurd) {
        scene.hear(id, FromWorker::Announce(Box::new(announcement)));
        let told = refusal(&scene, id).unwrap();
        assert!(told.starts_with(reason), "{told}");
    }
    assert_eq!(scene.core.snapshot(scene.now).workers.len(), 0);
    let said: String = scene.notices().iter().map(ToString::to_string).collect();
    assert!(said.len() < 6 * 500 && !said.contains('\u{1b}'), "{said}");
}

#[test]
fn whoever_differs_is_refused_by_the_name_of_the_field() {
    let both = || vec![effect("pivot_friction"), effect("base_motion")];
    let first = || with(announcement("m"), both());
    let others = [
        (
            "protocol is 99, this coordinator speaks",
            Announcement {
                protocol: 99,
                ..first()
            },
        ),
        (
            "build is 9.9.9 test, this coordinator's is",
            Announcement {
                build: "9.9.9 test".to_owned(),
                ..first()
            },
        ),
        (
            "model digest is another, this run's is m",
            with(announcement("another"), both()),
        ),
        (
            "models has no `model`, which is the model kind of this run",
            Announcement {
                models: Vec::new(),
                ..first()
            },
        ),
        (
            "slots is 0, but must be 1 to",
            Announcement {
                slots: 0,
                ..first()
            },
        ),
        (
            "effects has no `base_motion`",
            with(first(), vec![effect("pivot_friction")]),
        ),
        (
            "effects has `fluid_pound`, which",
            with(first(), [both(), vec![effect("fluid_pound")]].concat()),
        ),
    ];
    let mut scene = Scene::new();
    scene.hear(1, FromWorker::Announce(Box::new(first())));
    for (id, (reason, announcement)) in (2..).zip(others) {
        scene.hear(id, FromWorker::Announce(Box::new(announcement)));
        let told = refusal(&scene, id).unwrap();
        assert!(told.starts_with(reason), "{told}");
    }
    assert_eq!(scene.core.snapshot(scene.now).workers.len(), 1);
    scene.hear(99, FromWorker::Announce(Box::new(first())));
    assert_eq!(refusal(&scene, 99), None);
}

fn bits(byte: u8) -> ReferenceResult {
    ReferenceResult::Bits(ContentHash([byte; 32]))
}

fn prove(scene: &mut Scene, id: u64, proof: ReferenceResult) {
    scene.hear(
        id,
        FromWorker::Beat(Heartbeat {
            case: Some(CASE),
            proof: Some(proof),
            ..Heartbeat::default()
        }),
    );
}

/// Checks that a worker with an equal digest but another result of the reference individual is refused, since
/// its results cannot be trusted.
#[test]
fn another_result_of_the_reference_individual_is_refused() {
    let mut scene = Scene::new();
    scene.announce(1, 1, "m");
    scene.submit(0..3);
    scene.hear(
        1,
        FromWorker::Beat(Heartbeat {
            case: Some(CASE),
            ..Heartbeat::default()
        }),
    );
    assert_eq!(scene.given(), [], "nothing before the proof");
    prove(&mut scene, 1, bits(1));
    assert_eq!(scene.given().len(), 2);
    let proved = Event::Proved { proof: bits(1) };
    assert!(scene.other.contains(&Command::Record(proved)));
    scene.announce(2, 1, "m");
    prove(&mut scene, 2, bits(2));
    let told = refusal(&scene, 2).unwrap();
    assert!(told.starts_with("proof is 0202"), "{told}");
    assert_eq!(scene.given(), []);
    scene.announce(3, 1, "m");
    prove(&mut scene, 3, bits(1));
    assert_eq!(scene.given().len(), 1);
}

/// Checks that, for models without bitwise repeatable results, a worker is admitted if its result of the
/// reference individual agrees within the case's tolerance, and that a worker on which the external program
/// fails is refused once another worker has succeeded.
#[test]
fn values_of_the_reference_individual_may_differ_by_what_the_case_allows() {
    let values = |value: f64| ReferenceResult::Values(vec![Sample { value, scale: 2.0 }]);
    let mut scene = Scene::new();
    scene.core.options.repeats = Reproducibility::Within(0.01);
    for id in 1..5 {
        scene.announce(id, 1, "m");
    }
    prove(&mut scene, 1, ReferenceResult::Failed);
    assert_eq!(refusal(&scene, 1), None, "nobody has done better");
    prove(&mut scene, 2, values(1.0));
    prove(&mut scene, 3, values(1.019));
    assert_eq!((refusal(&scene, 2), refusal(&scene, 3)), (None, None));
    prove(&mut scene, 4, values(1.021));
    let told = refusal(&scene, 4).unwrap();
    assert!(
        told.starts_with("proof is 1.021 where this run's is 1"),
        "{told}"
    );
    assert!(told.contains("reference_tolerance"), "{told}");
    prove(&mut scene, 1, ReferenceResult::Failed);
    let told = refusal(&scene, 1).unwrap();
    assert!(told.starts_with("proof is a failure"), "{told}");
    let many = vec![
        Sample {
            value: 1.0,
            scale: 1.0
        };
        MAX_SAMPLES + 1
    ];
    prove(&mut scene, 3, ReferenceResult::Values(many));
    assert!(refusal(&scene, 3).unwrap().contains("65 values"));
    scene.submit(0..1);
    assert_eq!(scene.given().len(), 1);
}

/// Checks that a worker refused while holding jobs, because its proof changed, loses these jobs without a
/// failure counted against them.
#[test]
fn a_worker_that_changes_its_proof_loses_its_jobs() {
    let mut scene = Scene::new();
    scene.announce(1, 1, "m");
    prove(&mut scene, 1, bits(1));
    scene.submit(0..1);
    assert_eq!(scene.given().len(), 1);
    prove(&mut scene, 1, bits(2));
    assert!(refusal(&scene, 1).is_some());
    assert_eq!(scene.core.snapshot(scene.now).workers.len(), 0);
    assert_eq!(scene.core.jobs[&JobId(0)].failures.losses, 0);
    scene.announce(3, 1, "m");
    prove(&mut scene, 3, bits(1));
    assert_eq!(scene.given().len(), 1);
}

/// Checks that a worker whose heartbeat reports another case than that of the run is refused at once, with
/// both cases named; a worker between two runs reports no case.
#[test]
fn another_case_is_refused_at_once_and_by_name() {
    let mut scene = Scene::new();
    scene.announce(1, 1, "m");
    scene.submit(0..1);
    scene.hear(
        1,
        FromWorker::Beat(Heartbeat {
            case: Some(ContentHash([9; 32])),
            proof: Some(PROOF),
            ..Heartbeat::default()
        }),
    );
    let told = refusal(&scene, 1).unwrap();
    assert!(told.starts_with("case is 0909"), "{told}");
    assert!(told.contains("this run's is 0707"), "{told}");
    assert_eq!(scene.given(), []);
    assert_eq!(scene.core.snapshot(scene.now).workers.len(), 0);
}

/// Checks that results in transit from a refused worker are not accepted, since it may compute something
/// else.
#[test]
fn results_of_the_refused_are_not_accepted() {
    let mut scene = Scene::new();
    scene.announce(1, 1, "m");
    prove(&mut scene, 1, bits(1));
    scene.submit(0..1);
    let (_, attempt) = scene.given()[0];
    prove(&mut scene, 1, bits(2));
    scene.finish(1, attempt);
    assert_eq!(scene.delivered, []);
    scene.announce(2, 1, "m");
    prove(&mut scene, 2, bits(1));
    let (_, attempt) = scene.given()[0];
    scene.finish(2, attempt);
    assert_eq!(scene.delivered.len(), 1);
}

#[test]
fn another_version_of_the_wire_is_answered_each_time_and_told_once() {
    let mut scene = Scene::new();
    scene.join(1, 1);
    for _ in 0..3 {
        for worker in [1, 2] {
            scene.tell(Input::OtherVersion {
                from: WorkerId(worker),
                version: 99,
            });
        }
    }
    let told: Vec<String> = scene.notices().iter().map(ToString::to_string).collect();
    let told: Vec<&String> = told.iter().filter(|it| it.contains("version 99")).collect();
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(told[0].contains("use the same build"), "{told:?}");
    let answer = Command::Send {
        to: WorkerId(2),
        message: ToWorker::Identify,
    };
    let answers = scene.other.iter().filter(|it| **it == answer);
    assert_eq!(answers.count(), 3);
    // somebody who speaks in the name of one of ours does it no harm
    scene.submit(0..1);
    let (_, attempt) = scene.given()[0];
    scene.finish(1, attempt);
    assert_eq!(scene.delivered.len(), 1);
}

/// Checks that a worker's reason for leaving is truncated before it is shown and recorded.
#[test]
fn a_long_farewell_is_cut() {
    let mut scene = Scene::new();
    scene.join(1, 1);
    let reason = format!("\u{1b}[31m{}", "x".repeat(100_000));
    scene.hear(1, FromWorker::Leaving { reason });
    let said = scene.notices().pop().unwrap().to_string();
    assert!(said.len() < 300 && said.contains("[31mxxx"), "{said}");
}

/// Checks that results arriving before their job is submitted are discarded from unknown workers and kept up
/// to a memory limit from members.
#[test]
fn early_results_are_kept_of_members_and_up_to_a_budget() {
    const LONG: usize = 10 << 20;
    let early = |job: u64, bytes: usize| Done {
        attempt: Attempt {
            job: JobId(job),
            attempt: AttemptId(1),
        },
        work: super::job(job).work_hash(),
        cost: cost(1),
        outcome: Outcome::Done(Answer::Nothing(vec![0; bytes])),
    };
    let mut scene = Scene::new();
    scene.core.options.expected = [WorkerId(7)].into();
    scene.hear(9, FromWorker::Done(Box::new(early(0, 1))));
    assert_eq!(scene.core.unclaimed.bytes(), 0, "of a stranger");
    scene.hear(7, FromWorker::Done(Box::new(early(1, 1))));
    assert!(scene.core.unclaimed.bytes() > 0, "of one who is expected");
    scene.join(1, 1);
    for job in 10..20 {
        scene.hear(1, FromWorker::Done(Box::new(early(job, LONG))));
        // the same again costs nothing
        scene.hear(1, FromWorker::Done(Box::new(early(job, LONG))));
    }
    let kept = unclaimed_results::MOST_BYTES / LONG;
    let bytes = scene.core.unclaimed.bytes();
    assert!(
        (kept * LONG..=unclaimed_results::MOST_BYTES).contains(&bytes),
        "{bytes}"
    );
    scene.submit(0..2);
    scene.submit(10..20);
    let delivered: Vec<u64> = scene.delivered.iter().map(|(job, _)| *job).collect();
    assert_eq!(delivered, [1, 10, 11, 12, 13, 14, 15]);
    assert_eq!(scene.core.unclaimed.bytes(), 0);
    // it repeats the others
    scene.hear(1, FromWorker::Done(Box::new(early(16, LONG))));
    assert_eq!(scene.delivered.len(), 8);
}
