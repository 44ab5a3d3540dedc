//! Tests of failed attempts: when a job is retried, given up, and recorded.
use super::{
    simulated::{Cluster, ClusterSetting, Generations},
    *,
};

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

/// Checks that a job failed by one worker is retried on another, even if it must wait for that; a bad worker
/// that fails all jobs at once is always the least loaded.
#[test]
fn what_fails_at_one_worker_is_tried_again_at_another() {
    let mut scene = Scene::new();
    for worker in 1..=3 {
        scene.join(worker, 1);
    }
    scene.submit(0..30);
    let mut failed = 0;
    while scene.delivered.len() < 30 {
        let given = scene.given();
        let (bad, good): (Vec<_>, Vec<_>) = given.into_iter().partition(|(at, _)| *at == 1);
        assert!(bad.len() + good.len() > 0, "the run stands still");
        for (_, attempt) in bad {
            failed += 1;
            let failure = if failed % 2 == 0 {
                crash()
            } else {
                Failure::deadline(120_000)
            };
            scene.fail(1, attempt, failure);
        }
        for (at, attempt) in good {
            scene.finish(at, attempt);
        }
    }
    assert!(failed > 1, "the bad one was never tried");
    let done = |(_, outcome): &(u64, Outcome)| matches!(outcome, Outcome::Done(_));
    assert!(scene.delivered.iter().all(done), "{:?}", scene.delivered);
    // with the others gone it is the bad one's again, within the limit of tries
    scene.submit(30..31);
    let (first, attempt) = scene.given()[0];
    scene.fail(first, attempt, crash());
    for other in (1..=3).filter(|other| *other != first) {
        scene.tell(Input::Disconnected {
            worker: WorkerId(other),
        });
    }
    scene.wait(70, &[first]);
    let given = scene.given();
    assert_eq!(given.last().map(|(at, _)| *at), Some(first), "{given:?}");
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
        [&Command::Stop(StopReason::EverythingFails {
            jobs: 8,
            last: bad
        })]
    );
}

#[test]
fn an_overdue_job_gets_a_second_longer_try() {
    let mut scene = Scene::new();
    scene.join(1, 1);
    scene.submit(0..1);
    let first = scene.orders[0].1.deadline_ms;
    let (_, attempt) = scene.given()[0];
    let overdue = || Failure::deadline(120_000);
    scene.fail(1, attempt, overdue());
    assert_eq!(scene.orders[0].1.deadline_ms, 2 * first);
    let (_, attempt) = scene.given()[0];
    scene.fail(1, attempt, overdue());
    assert_eq!(scene.delivered, [(0, Outcome::Failed(overdue()))]);
}

/// Checks that the coordinator ends an overdue job if the worker does not.
#[test]
fn a_worker_that_does_not_end_an_overdue_job_loses_it() {
    let mut scene = Scene::new();
    scene.join(1, 1);
    scene.submit(0..1);
    let (_, attempt) = scene.given()[0];
    // eight times two minutes, and ten seconds
    scene.wait(969, &[1]);
    assert_eq!(scene.cancelled, []);
    scene.wait(4, &[1]);
    assert_eq!(scene.cancelled, [(WorkerId(1), attempt)]);
}

/// Checks, on clusters of many kinds, that jobs that kill their first workers cost these alone and that every job
/// is done in the end.
#[test]
fn jobs_that_kill_their_workers_are_done_in_the_end_whatever_else_those_held() {
    const KILLERS: &[u64] = &[3, 11, 12];
    for seed in 1..=60 {
        let setting = ClusterSetting {
            seed,
            slots: 1 + usize::try_from(seed % 3).unwrap(),
            delay: Duration::from_millis(if seed % 2 == 0 { 2 } else { 700 }),
            killers: KILLERS,
            ..ClusterSetting::even(1 + seed % 6)
        };
        let mut cluster = Cluster::new(setting);
        cluster.run(&mut Generations::new(80, 1), Duration::from_hours(1));
        for (job, outcome) in &cluster.results {
            let expected = Outcome::Done(Answer::Nothing(vec![1]));
            assert_eq!(*outcome, expected, "job {job}, seed {seed}");
        }
        let lost = cluster.snapshot().lost;
        assert!((6..=18).contains(&lost), "seed {seed}: {lost} workers");
    }
}
