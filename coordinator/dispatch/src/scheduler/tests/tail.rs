//! Tests of straggler handling at the end of a generation: waiting jobs are moved, slow ones copied.
use super::{
    simulated::{Cluster, ClusterSetting, Fault, Generations},
    *,
};

const LIMIT: Duration = Duration::from_hours(2);

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

/// Checks that copies of slow jobs cost at most five percent of the useful time when there is no fault.
#[test]
fn without_faults_copies_cost_at_most_five_percent() {
    for (seed, slow_one_in) in [(1, 0), (2, 0), (3, 10), (4, 10)] {
        let setting = ClusterSetting {
            seed,
            slow_one_in,
            ..ClusterSetting::even(16)
        };
        let mut cluster = Cluster::new(setting);
        cluster.run(&mut Generations::new(80, 25), LIMIT);
        let snapshot = cluster.snapshot();
        let wasted = snapshot.spent.speculative_us as f64 / snapshot.spent.useful_us as f64;
        assert!(
            wasted <= 0.05,
            "seed {seed}: {wasted} for {} copies",
            snapshot.copies
        );
        assert!(cluster.begun >= 2000 + u64::from(snapshot.copies) / 2);
    }
}

/// Checks that idle workers take over the jobs of a worker frozen in mid-generation (one of sixteen) long
/// before its silence is detected.
#[test]
fn a_frozen_worker_does_not_hold_up_its_generation() {
    let mut clean = Cluster::new(ClusterSetting::even(16));
    clean.run(&mut Generations::new(80, 1), LIMIT);
    let mut frozen = Cluster::new(ClusterSetting::even(16));
    frozen.fault(Duration::from_millis(4100), 7, Fault::Freeze);
    frozen.run(&mut Generations::new(80, 1), LIMIT);
    let ratio = frozen.now.as_secs_f64() / clean.now.as_secs_f64();
    assert!(
        ratio <= 1.5,
        "{ratio}: {:?} instead of {:?}",
        frozen.now,
        clean.now
    );
    assert!(frozen.snapshot().copies >= 1);
}

/// Checks that the slower of two copies is cancelled as soon as the first result is accepted.
#[test]
fn the_loser_of_two_copies_is_cancelled_at_once() {
    let mut scene = Scene::new();
    scene.wall_us = 1_000_000;
    scene.join(1, 1);
    scene.submit(0..6);
    for _ in 0..6 {
        for (to, attempt) in scene.given() {
            scene.now += Duration::from_secs(1);
            scene.finish(to, attempt);
        }
    }
    scene.submit(6..7);
    let slow = scene.given()[0].1;
    scene.join(2, 1);
    scene.wait(1, &[1, 2]);
    assert_eq!(scene.given(), [], "not slow yet");
    scene.wait(4, &[1, 2]);
    let copies = scene.given();
    assert_eq!(copies.len(), 1, "one copy, not one per tick");
    let (to, copy) = copies[0];
    assert_eq!((to, copy.job), (2, slow.job));
    assert_eq!(scene.core.snapshot(scene.now).copies, 1);
    scene.finish(1, slow);
    assert_eq!(scene.cancelled, [(WorkerId(2), copy)]);
    let spent = scene.core.snapshot(scene.now).spent;
    assert!(spent.speculative_us > 0, "{spent:?}");
    scene.finish(2, copy);
    assert_eq!(scene.delivered.len(), 7, "the late one changes nothing");
}

/// Checks that a frozen worker holding jobs costs the other workers neither throughput nor results.
#[test]
fn one_frozen_worker_of_sixty_four_costs_the_others_nothing() {
    let run = |freeze: bool| {
        let mut cluster = Cluster::new(ClusterSetting::even(64));
        if freeze {
            for n in 0..3 {
                cluster.fault(Duration::from_millis(4100 + 9000 * n), 7, Fault::Freeze);
                cluster.fault(Duration::from_millis(11_000 + 9000 * n), 7, Fault::Thaw);
            }
        }
        cluster.run(&mut Generations::new(4000, 1), LIMIT);
        assert_eq!(cluster.results.len(), 4000);
        4000.0 / cluster.now.as_secs_f64()
    };
    let (clean, frozen) = (run(false), run(true));
    let per_worker = frozen / 63.0 / (clean / 64.0);
    assert!(per_worker >= 0.9, "{per_worker}");
}
