//! Tests of anticipated jobs: they take idle slots alone, give way to requested jobs, and are claimed or
//! withdrawn.
use super::*;

fn anticipate(scene: &mut Scene, jobs: std::ops::Range<u64>) {
    for id in jobs {
        let (id, job) = (JobId(id), job(id));
        scene.tell(Input::Anticipate { id, job });
    }
}

fn jobs(given: &[(u64, Attempt)]) -> Vec<u64> {
    given.iter().map(|(_, attempt)| attempt.job.0).collect()
}

/// Returns the slot time spent on accepted results and on results that nobody requested \[us\].
fn useful_and_speculative(scene: &Scene) -> (u64, u64) {
    let spent = scene.core.snapshot(scene.now).spent;
    (spent.useful_us, spent.speculative_us)
}

#[test]
fn idle_slots_compute_ahead_and_requested_jobs_take_their_place() {
    let mut scene = Scene::new();
    scene.join(1, 3);
    scene.submit(0..1);
    anticipate(&mut scene, 100..104);
    let given = scene.given();
    assert_eq!(jobs(&given), [0, 100, 101], "one slot each, none behind");
    assert_eq!(scene.core.idle_slots(), 2, "they do not count as busy");
    scene.submit(1..3);
    let cancelled: Vec<u64> = scene.cancelled.iter().map(|(_, own)| own.job.0).collect();
    assert_eq!(cancelled, [100, 101]);
    let requested = scene.given();
    assert_eq!(jobs(&requested), [1, 2]);
    // once they are done, what was taken away is computed after all
    scene.finish(1, requested[0].1);
    assert_eq!(scene.given().len(), 1);
}

#[test]
fn a_claimed_job_is_one_that_was_requested() {
    let mut scene = Scene::new();
    scene.join(1, 3);
    anticipate(&mut scene, 100..104);
    let given = scene.given();
    scene.now += Duration::from_millis(1);
    scene.finish(1, given[0].1);
    assert_eq!(useful_and_speculative(&scene).1, scene.wall_us);
    // one has a result, one is being computed, one waits
    let ids = [100, 101, 103].map(JobId);
    scene.tell(Input::Claim { jobs: ids.into() });
    let (useful, speculative) = useful_and_speculative(&scene);
    assert!(useful >= scene.wall_us && speculative == 0);
    scene.finish(1, given[1].1);
    let later = scene.given();
    assert!(jobs(&later).contains(&103), "{later:?}");
    scene.stored();
    let stored: Vec<u64> = scene
        .acknowledged
        .iter()
        .map(|(_, own)| own.job.0)
        .collect();
    assert_eq!(stored, [100, 101]);
}

#[test]
fn what_is_withdrawn_is_cancelled_and_its_late_result_forgotten() {
    let mut scene = Scene::new();
    scene.join(1, 2);
    anticipate(&mut scene, 100..103);
    let given = scene.given();
    scene.now += Duration::from_millis(1);
    scene.finish(1, given[0].1);
    let next = scene.given();
    let ids = [100, 101, 102].map(JobId);
    scene.tell(Input::Withdraw { jobs: ids.into() });
    assert_eq!(scene.acknowledged, [(WorkerId(1), given[0].1)]);
    let cancelled: Vec<Attempt> = scene.cancelled.iter().map(|(_, own)| *own).collect();
    assert_eq!(cancelled, [given[1].1, next[0].1]);
    let (useful, speculative) = useful_and_speculative(&scene);
    assert!(useful == 0 && speculative >= scene.wall_us);
    // sent before the cancellation arrived
    scene.finish(1, given[1].1);
    assert_eq!(scene.acknowledged.last(), Some(&(WorkerId(1), given[1].1)));
    assert_eq!(scene.core.unstored(), 0);
    scene.submit(0..2);
    assert_eq!(jobs(&scene.given()), [0, 1]);
}

#[test]
fn a_lost_worker_gives_requested_jobs_the_slots_of_anticipated_ones() {
    let mut scene = Scene::new();
    scene.join(1, 1);
    scene.submit(0..1);
    scene.join(2, 1);
    anticipate(&mut scene, 100..101);
    assert_eq!(jobs(&scene.given()), [0, 100]);
    scene.tell(Input::Disconnected {
        worker: WorkerId(1),
    });
    assert_eq!(jobs(&scene.given()), [0]);
    assert_eq!(scene.cancelled.len(), 1);
    // the loss of its worker queues an anticipated job again
    scene.join(3, 1);
    assert_eq!(jobs(&scene.given()), [100]);
    scene.tell(Input::Disconnected {
        worker: WorkerId(3),
    });
    scene.join(4, 1);
    assert_eq!(jobs(&scene.given()), [100]);
}

/// Checks that an anticipated job whose workers were lost keeps no worker free. Regression: it was never leased,
/// and a worker of eight slots got nothing until another one joined.
#[test]
fn an_anticipated_job_whose_workers_were_lost_keeps_no_worker_free() {
    let mut scene = Scene::new();
    anticipate(&mut scene, 100..101);
    for worker in 1..=2 {
        scene.join(worker, 1);
        assert_eq!(jobs(&scene.given()), [100]);
        scene.tell(Input::Disconnected {
            worker: WorkerId(worker),
        });
    }
    scene.join(3, 8);
    assert_eq!(scene.given(), [], "nobody asked for it");
    scene.submit(0..3);
    assert_eq!(scene.given().len(), 3);
    // once it is requested, it gets a worker of its own
    scene.tell(Input::Claim {
        jobs: vec![JobId(100)],
    });
    for lease in scene.core.members[&WorkerId(3)].leases.clone() {
        scene.finish(3, lease.attempt);
    }
    assert_eq!(jobs(&scene.given()), [100]);
}

#[test]
fn slow_jobs_are_copied_to_slots_that_compute_ahead() {
    let mut scene = Scene::new();
    scene.join(1, 1);
    scene.join(2, 1);
    for id in 0..40 {
        scene.submit(id..id + 1);
        let (worker, attempt) = scene.given()[0];
        scene.now += Duration::from_millis(20);
        scene.finish(worker, attempt);
        scene.stored();
    }
    scene.submit(50..51);
    let (holder, slow) = scene.given()[0];
    anticipate(&mut scene, 100..101);
    assert_eq!(jobs(&scene.given()), [100]);
    // shorter than the deadline of the anticipated job, whose end would free its slot
    scene.wait(5, &[1, 2]);
    let copied = scene.given();
    assert!(
        copied
            .iter()
            .any(|(to, own)| *to != holder && own.job == slow.job),
        "{copied:?}"
    );
}
