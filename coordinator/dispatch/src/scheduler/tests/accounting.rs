//! Tests of the slot-time accounting, compared with the simulated workers' own clocks.
use super::{
    simulated::{Cluster, ClusterSetting, Fault, Generations},
    *,
};
use journal::event::{Event, WorkerAccount};

const LIMIT: Duration = Duration::from_hours(2);

/// Returns the slot time of all workers of the cluster, after checking that its kinds of use add up to the
/// connected time.
fn balanced(cluster: &Cluster) -> Spent {
    let spent = cluster.snapshot().spent;
    let share = spent.sum_us() as f64 / spent.connected_us as f64;
    assert!((share - 1.0).abs() < 1e-3, "{share} of {spent:?}");
    spent
}

#[test]
fn the_kinds_add_up_and_useful_time_is_what_workers_computed() {
    for slots in [1, 3] {
        let setting = ClusterSetting {
            slots,
            ..ClusterSetting::even(7)
        };
        let mut cluster = Cluster::new(setting);
        cluster.run(&mut Generations::new(80, 20), LIMIT);
        let spent = balanced(&cluster);
        let useful = spent.useful_us as f64 / 1e6 / cluster.computed.as_secs_f64();
        assert!((0.99..1.01).contains(&useful), "{useful} {spent:?}");
        assert_eq!((spent.lost_us, spent.failed_us), (0, 0));
        assert!(spent.barrier_us > 5 * spent.starved_us, "{spent:?}");
    }
}

/// Checks that network latency counts as starved, neither as barrier nor as useful time.
#[test]
fn time_on_the_way_counts_as_starved() {
    let mut policy_of_one = Cluster::new(ClusterSetting {
        delay: Duration::from_millis(400),
        ..ClusterSetting::even(4)
    });
    policy_of_one.core_mut().options.policy.jobs_per_slot = 1;
    policy_of_one.run(&mut Generations::new(100, 3), LIMIT);
    let spent = balanced(&policy_of_one);
    let computed = policy_of_one.computed.as_secs_f64();
    assert!((spent.useful_us as f64 / 1e6 / computed - 1.0).abs() < 0.01);
    assert!(spent.starved_us > spent.useful_us / 10, "{spent:?}");
}

#[test]
fn killed_and_frozen_workers_show_as_lost_time() {
    let mut cluster = Cluster::new(ClusterSetting::even(8));
    for n in 0..10 {
        cluster.fault(Duration::from_secs(10 + 7 * n), n % 8, Fault::Kill);
    }
    cluster.fault(Duration::from_secs(3), 5, Fault::Freeze);
    cluster.run(&mut Generations::new(80, 10), LIMIT);
    let spent = balanced(&cluster);
    let lost = spent.lost_us as f64 / 1e6;
    // ten kills cost at most two seconds each, the freeze the four until it is noticed
    assert!((1.0..26.0).contains(&lost), "{lost}");
    assert_eq!(cluster.results.len(), 800);
}

#[test]
fn accounts_of_all_workers_are_in_the_journal_and_are_the_same_as_the_live_one() {
    let mut cluster = Cluster::new(ClusterSetting::even(3));
    cluster.fault(Duration::from_secs(20), 1, Fault::Kill);
    cluster.run(&mut Generations::new(30, 20), LIMIT);
    let live = cluster.snapshot().spent;
    let closing = {
        let now = cluster.now;
        cluster.core_mut().handle(Input::Close, now)
    };
    let last = closing.into_iter().filter_map(|command| match command {
        Command::Record(event) => Some(event),
        Command::Send { .. }
        | Command::Store(_)
        | Command::Deliver(_)
        | Command::Notice(_)
        | Command::Stop(_) => None,
    });
    let mut workers: BTreeMap<WorkerId, WorkerAccount> = BTreeMap::new();
    let mut minutes = 0;
    for event in mem::take(&mut cluster.accounts).into_iter().chain(last) {
        if let Event::Accounted(account) = event {
            minutes += 1;
            for row in account.workers {
                workers.insert(row.worker, row);
            }
        }
    }
    assert!(
        minutes >= 4,
        "each minute, at the loss and at the end: {minutes}"
    );
    assert_eq!(workers.len(), 4, "three and the successor of one");
    let mut folded = Spent::default();
    for row in workers.values() {
        folded.add(&row.spent);
    }
    assert_eq!(folded, live);
}

/// Checks that the computing time excludes workers that start, fetch the case and build the model; the
/// estimate of the remaining time is derived from it.
#[test]
fn waiting_for_workers_and_for_them_to_get_ready_is_not_computing() {
    let mut scene = Scene::new();
    scene.submit(0..2);
    scene.wait(60, &[]);
    let computing = |scene: &Scene| scene.core.snapshot(scene.now).computing;
    scene.announce(1, 1, "m");
    scene.hear(1, FromWorker::Beat(Heartbeat::default()));
    scene.wait(2, &[]);
    assert_eq!(computing(&scene), Duration::ZERO);
    scene.beat(1, &[]);
    scene.wait(3, &[1]);
    assert_eq!(computing(&scene), Duration::from_secs(3));
    for (worker, attempt) in scene.given() {
        scene.finish(worker, attempt);
    }
    scene.wait(5, &[1]);
    assert_eq!(computing(&scene), Duration::from_secs(3));
    assert!(scene.core.snapshot(scene.now).done == 2);
}
