//! Tests of draining workers.
use super::*;
use crate::scheduler::{WorkerPhase, WorkerReport};

fn drain(scene: &mut Scene, worker: u64, now: bool, end: bool) {
    let worker = WorkerId(worker);
    let how = Drain { now, end };
    scene.tell(Input::Drain { worker, how });
}

fn reports(scene: &Scene) -> Vec<(WorkerId, WorkerReport)> {
    let named = |_, _: &str, _| (String::new(), false);
    scene.core.worker_reports(scene.now, named)
}

/// Returns whether a worker was ordered to end since the last call.
fn told_to_end(scene: &mut Scene, worker: u64) -> bool {
    let is = |command: &Command| matches!(command, Command::Send { to, message: ToWorker::Refused { .. } } if to.0 == worker);
    mem::take(&mut scene.other).iter().any(is)
}

#[test]
fn a_drained_worker_finishes_what_it_holds_and_gets_no_more() {
    let mut scene = Scene::new();
    scene.join(1, 1);
    scene.submit(0..5);
    let given = scene.given();
    drain(&mut scene, 1, false, false);
    for (_, attempt) in &given {
        scene.finish(1, *attempt);
    }
    assert_eq!(scene.given(), []);
    assert_eq!(scene.cancelled, []);
    let (_, worker) = &reports(&scene)[0];
    assert_eq!(worker.state, WorkerPhase::Drained);
    assert!(worker.jobs.is_empty());
    assert_eq!(worker.done, given.len() as u64);
    // also when it comes again
    scene.tell(Input::Disconnected {
        worker: WorkerId(1),
    });
    scene.join(1, 1);
    assert_eq!(scene.given(), []);
    // what is left is for others
    scene.join(2, 4);
    assert_eq!(scene.given().len(), 5 - given.len());
}

#[test]
fn what_a_worker_hands_back_is_given_to_others_at_once_and_held_against_nobody() {
    let mut scene = Scene::new();
    scene.join(1, 2);
    scene.submit(0..3);
    let held = scene.given();
    scene.join(2, 4);
    drain(&mut scene, 1, true, false);
    let cancelled: Vec<Attempt> = scene
        .cancelled
        .iter()
        .map(|(_, attempt)| *attempt)
        .collect();
    assert_eq!(cancelled.len(), held.len());
    let given = scene.given();
    assert!(given.iter().all(|(to, _)| *to == 2), "{given:?}");
    assert_eq!(given.len(), 3);
    // a result that was on its way counts all the same
    scene.finish(1, held[0].1);
    assert_eq!(scene.delivered.len(), 1);
    assert_eq!(scene.core.snapshot(scene.now).lost, 0);
}

#[test]
fn a_worker_that_is_to_end_is_told_so_once_it_holds_nothing_and_whenever_it_comes_again() {
    let mut scene = Scene::new();
    scene.join(1, 1);
    scene.submit(0..1);
    let (_, attempt) = scene.given()[0];
    drain(&mut scene, 1, false, true);
    assert!(!told_to_end(&mut scene, 1), "it holds a job");
    scene.finish(1, attempt);
    assert!(told_to_end(&mut scene, 1));
    assert!(reports(&scene).is_empty());
    // it did not hear
    scene.announce(1, 1, "m");
    assert!(told_to_end(&mut scene, 1));
    assert!(reports(&scene).is_empty());
}
