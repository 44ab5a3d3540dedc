//! Tests of a steady-state search (without generations) on simulated clusters: bitwise equal results under
//! all faults, and the share of the cluster's capacity used.
use super::{
    simulated::{Cluster, ClusterSetting, Fault, Generations, SimulatedSearch},
    *,
};
use search::{
    strategy::{
        Settings, build,
        memetic::{MemeticSettings, window::WindowSettings},
    },
    test_function::CLIFF,
};

const LIMIT: Duration = Duration::from_hours(20);

fn settings(window: usize, generations: u32) -> Settings {
    Settings::of(&WindowSettings {
        window,
        memetic: MemeticSettings {
            population: 30,
            generations,
            crossover_trials: 5,
            mutation_trials: 5,
            ..MemeticSettings::paper()
        },
    })
}

/// Runs a search on a cluster and returns the digest of its evaluation log, and the cluster.
fn run(settings: &Settings, mut cluster: Cluster) -> (String, Cluster) {
    let space = CLIFF.space();
    let tell = |genes: &[f64]| CLIFF.tell(&space, genes);
    let mut source = SimulatedSearch::new(build(settings, &space, 11).unwrap(), &tell);
    cluster.run(&mut source, LIMIT);
    (source.digest(), cluster)
}

#[test]
fn one_three_seven_and_forty_workers_with_delays_losses_and_kills_make_the_same_log() {
    let settings = settings(24, 12);
    let space = CLIFF.space();
    let tell = |genes: &[f64]| CLIFF.tell(&space, genes);
    // the reference is told in id order, without any cluster
    let mut alone = SimulatedSearch::new(build(&settings, &space, 11).unwrap(), &tell);
    while alone.strategy.finished().is_none() {
        for proposal in alone.strategy.ask() {
            alone.strategy.tell(proposal.id, tell(&proposal.genes));
        }
    }
    let expected = alone.digest();
    let links = [(0.0, 0.0), (0.2, 0.2)];
    let places = links.map(|link| [1, 3, 7, 40].map(|workers| (link, workers)));
    for (seed, ((loss, duplication), workers)) in (1..).zip(places.into_iter().flatten()) {
        let setting = ClusterSetting {
            seed,
            slow_one_in: 10,
            delay: Duration::from_millis(700),
            loss,
            duplication,
            ..ClusterSetting::even(workers)
        };
        let mut cluster = Cluster::new(setting);
        for n in 0..10 {
            cluster.fault(
                Duration::from_millis(1500 + 1700 * n),
                (n * 3) % workers,
                Fault::Kill,
            );
        }
        let (digest, cluster) = run(&settings, cluster);
        assert_eq!(digest, expected, "{workers} workers, {loss} lost");
        let snapshot = cluster.snapshot();
        // where many messages are lost, one may be killed before it has joined, another not be heard
        let killed = snapshot.lost == 10 || (loss > 0.0 && snapshot.lost > 5);
        assert!(killed && snapshot.repeated > 0, "{snapshot:?}");
        assert!(
            duplication == 0.0 || snapshot.duplicates > 0,
            "{snapshot:?}"
        );
    }
    let (other, _) = run(
        &self::settings(25, 12),
        Cluster::new(ClusterSetting::even(3)),
    );
    assert_ne!(other, expected, "the window is part of what decides");
}

/// Builds a cluster of mixed speed: computing times spread by 30 %, one worker in ten half as fast.
fn mixed(workers: u64) -> Cluster {
    Cluster::new(ClusterSetting {
        slow_one_in: 10,
        ..ClusterSetting::even(workers)
    })
}

fn windowed(workers: u64, per_worker: usize, evaluations: u32) -> f64 {
    let window = per_worker * usize::try_from(workers).unwrap();
    let settings = settings(window, evaluations / 40);
    run(&settings, mixed(workers)).1.capacity_used()
}

fn generational(workers: u64, evaluations: u64) -> f64 {
    let mut cluster = mixed(workers);
    cluster.run(&mut Generations::new(80, evaluations / 80), LIMIT);
    cluster.capacity_used()
}

#[test]
fn a_window_uses_what_a_barrier_leaves_idle() {
    let (barrier, window) = (generational(40, 1600), windowed(40, 3, 4000));
    assert!(barrier < 0.7, "{barrier}");
    assert!(window > 0.9, "{window}");
    let (barrier, window) = (generational(16, 1600), windowed(16, 3, 2000));
    assert!(barrier < 0.9, "{barrier}");
    assert!(window > 0.94, "{window}");
    // 80 individuals a generation on 80 workers: the slowest of each decides
    let (barrier, window) = (generational(80, 1600), windowed(80, 3, 8000));
    assert!(barrier < 0.45, "{barrier}");
    assert!(window > 0.9, "{window}");
}
