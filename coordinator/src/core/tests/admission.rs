//! Who may take part.
use super::*;

#[test]
fn a_worker_without_the_case_gets_nothing() {
    let mut scene = Scene::new();
    scene.announce(1, 1, "m");
    scene.submit(0..1);
    assert_eq!(scene.given(), []);
    scene.beat(1, &[]);
    assert_eq!(scene.given().len(), 1);
}

/// Why a worker was refused, as it was told, and whether people were told the same.
fn refusal(scene: &Scene, id: u64) -> Option<String> {
    let told = scene.other.iter().find_map(|command| match command {
        Command::Send {
            to,
            message: ToWorker::Refused { reason },
        } if *to == WorkerId(id) => Some(reason.clone()),
        Command::Send { .. }
        | Command::Store(_)
        | Command::Record(_)
        | Command::Deliver { .. }
        | Command::Notice(_)
        | Command::Stop(_) => None,
    })?;
    let said = scene.notices().into_iter().any(
        |notice| matches!(notice, Notice::Refused { worker: WorkerId(it), reason, .. } if *it == id && *reason == told),
    );
    assert!(said, "both sides say it: {told}");
    Some(told)
}

#[test]
fn whoever_differs_is_refused_by_the_name_of_the_field() {
    let effect = |id: &str| protocol::announce::EffectDescriptor {
        id: id.to_owned(),
        title: id.to_owned(),
        joint: "saddle".to_owned(),
        place: protocol::announce::Place::Dynamics,
        generic: false,
        parameters: Vec::new(),
    };
    let first = || Announcement {
        effects: vec![effect("pivot_friction"), effect("rope_toe")],
        ..announcement("m")
    };
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
            "model_digest is another, this run's is m",
            Announcement {
                model_digest: "another".to_owned(),
                ..first()
            },
        ),
        (
            "slots is 0, allowed are 1 to",
            Announcement {
                slots: 0,
                ..first()
            },
        ),
        (
            "effects has no rope_toe",
            Announcement {
                effects: vec![effect("pivot_friction")],
                ..first()
            },
        ),
        (
            "effects has fluid_pound that",
            Announcement {
                effects: [first().effects, vec![effect("fluid_pound")]].concat(),
                ..first()
            },
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

fn prove(scene: &mut Scene, id: u64, proof: [u8; 32]) {
    scene.hear(
        id,
        FromWorker::Beat(Beat {
            case: Some(CASE),
            proof: Some(ContentHash(proof)),
            ..Beat::default()
        }),
    );
}

/// The digest is the same, yet the case's reference individual has other bits: nothing it computes
/// can be trusted.
#[test]
fn another_result_of_the_reference_individual_is_refused() {
    let mut scene = Scene::new();
    scene.announce(1, 1, "m");
    scene.submit(0..3);
    scene.hear(
        1,
        FromWorker::Beat(Beat {
            case: Some(CASE),
            ..Beat::default()
        }),
    );
    assert_eq!(scene.given(), [], "nothing before the proof");
    prove(&mut scene, 1, [1; 32]);
    assert_eq!(scene.given().len(), 2);
    let proved = Event::Proved {
        proof: ContentHash([1; 32]),
    };
    assert!(scene.other.contains(&Command::Record(proved)));
    scene.announce(2, 1, "m");
    prove(&mut scene, 2, [2; 32]);
    let told = refusal(&scene, 2).unwrap();
    assert!(told.starts_with("proof is 0202"), "{told}");
    assert_eq!(scene.given(), []);
    scene.announce(3, 1, "m");
    prove(&mut scene, 3, [1; 32]);
    assert_eq!(scene.given().len(), 1);
}

/// A worker that held jobs when it was found out gives them back, and no job is to blame.
#[test]
fn a_worker_that_changes_its_proof_loses_its_jobs() {
    let mut scene = Scene::new();
    scene.announce(1, 1, "m");
    prove(&mut scene, 1, [1; 32]);
    scene.submit(0..1);
    assert_eq!(scene.given().len(), 1);
    prove(&mut scene, 1, [2; 32]);
    assert!(refusal(&scene, 1).is_some());
    assert_eq!(scene.core.snapshot(scene.now).workers.len(), 0);
    assert_eq!(scene.core.jobs[&JobId(0)].failures.losses, 0);
    scene.announce(3, 1, "m");
    prove(&mut scene, 3, [1; 32]);
    assert_eq!(scene.given().len(), 1);
}
