//! Tests of divided and anticipated jobs: parts, their ids, and the joined results.
use super::by_columns::{ByColumns, halves};
use super::*;
use journal::job_range::is_part;
use protocol::{
    id::{AttemptId, WorkerId},
    job::{
        Answer, Column, Counters, Derivative, Evaluation, Individual, Per, Reply, SimulateSpec,
        Verdict,
    },
};

fn job(columns: usize) -> Job {
    let reply = Reply::Score {
        with_residual: true,
        whole: true,
    };
    let columns = (0..columns).map(|k| Column::new(format!("x{k}")));
    Job::Simulate(SimulateSpec {
        columns: columns.collect(),
        ..SimulateSpec::new(Individual::new(0, vec![1.0]), reply)
    })
}

/// Returns the answer to a job, whose derivatives are the numbers of their columns.
fn evaluated(job: &Job) -> Outcome {
    let Job::Simulate(spec) = job else {
        panic!("a simulation");
    };
    let column = |column: &Column| Derivative::Curves {
        per: Per::Decade,
        curves: vec![vec![
            column.name.trim_start_matches('x').parse::<f32>().unwrap(),
        ]],
    };
    Outcome::Done(Answer::Scored(Evaluation {
        verdict: Verdict::Complete,
        fitness: 2.0,
        channels: Vec::new(),
        residual: vec![1.0],
        columns: spec.columns.iter().map(column).collect(),
        counters: Counters::default(),
    }))
}

fn finished((id, job): &(JobId, Job), outcome: Outcome) -> Finished {
    Finished {
        attempt: Attempt {
            job: *id,
            attempt: AttemptId(0),
        },
        work: job.work_hash(),
        worker: Some(WorkerId(4)),
        cost: Cost {
            wall_us: 10,
            cpu_us: 9,
        },
        outcome,
    }
}

#[test]
fn idle_slots_are_shared_by_the_jobs_and_no_part_is_empty() {
    assert_eq!(part_count(12, 4, 80), 12);
    assert_eq!(part_count(12, 10, 80), 8);
    assert_eq!(part_count(12, 10, 20), 2);
    assert_eq!(part_count(12, 10, 9), 1);
    assert_eq!(part_count(12, 1, 0), 1);
}

#[test]
fn joined_parts_are_the_answer_to_the_whole_job_in_any_order() {
    for count in [2, 3, 5, 12] {
        let mut divided = DividedJobs::new(Arc::new(ByColumns));
        let whole = job(12);
        let parts = divided.divide(JobId(7), whole.clone(), count);
        assert!(parts.iter().all(|(id, _)| is_part(*id)));
        assert_eq!(divided.submitted_id(parts[0].0), JobId(7));
        let mut results = Vec::new();
        for part in parts.iter().rev() {
            results.push(divided.finish(finished(part, evaluated(&part.1))));
        }
        let Some(PartResult::Joined(joined)) = results.pop() else {
            panic!("{results:?}");
        };
        assert!(results.iter().all(|result| *result == PartResult::Awaited));
        assert_eq!(joined.outcome, evaluated(&whole));
        assert_eq!(
            (joined.attempt.job, joined.work),
            (JobId(7), whole.work_hash())
        );
        assert_eq!(joined.cost.wall_us, 10 * parts.len() as u64);
        // a second result of a part changes nothing
        let again = divided.finish(finished(&parts[0], evaluated(&parts[0].1)));
        assert_eq!(again, PartResult::Discarded);
        let stored = divided.stored(vec![JobId(7)]);
        assert_eq!(stored.len(), parts.len() + 1);
    }
}

#[test]
fn a_failed_part_fails_the_job_at_once() {
    let lost = || Outcome::Failed(Failure::deadline(5));
    let mut divided = DividedJobs::new(Arc::new(ByColumns));
    let parts = divided.divide(JobId(7), job(4), 4);
    let first = divided.finish(finished(&parts[0], evaluated(&parts[0].1)));
    assert_eq!(first, PartResult::Awaited);
    let PartResult::Joined(joined) = divided.finish(finished(&parts[2], lost())) else {
        panic!("failed");
    };
    assert_eq!(joined.outcome, lost());
    let late = divided.finish(finished(&parts[1], evaluated(&parts[1].1)));
    assert_eq!(late, PartResult::Discarded);
    // one that is not stored
    let parts = divided.divide(JobId(8), job(4), 2);
    let failed = Completed {
        id: parts[1].0,
        cost: Cost::default(),
        outcome: Outcome::Failed(Failure::misconfigured("field", "problem")),
        replayed: false,
    };
    assert_eq!(divided.fail(&failed).unwrap().id, JobId(8));
    assert_eq!(divided.fail(&failed), None);
}

/// Returns a job with a gene value that tells it apart.
fn other_job(columns: usize, gene: f64) -> Job {
    let Job::Simulate(mut spec) = job(columns) else {
        panic!("a simulation");
    };
    spec.individual.genes = vec![gene];
    Job::Simulate(spec)
}

#[test]
fn the_likeliest_jobs_take_the_idle_slots() {
    assert_eq!(
        anticipated_parts(&[12; 5], 75, halves),
        [12, 12, 12, 12, 12]
    );
    assert_eq!(
        anticipated_parts(&[12; 10], 70, halves),
        [12, 6, 6, 6, 6, 6, 6, 6, 6, 6]
    );
    assert_eq!(anticipated_parts(&[12; 4], 20, halves), [6, 6, 6]);
    assert_eq!(anticipated_parts(&[12; 4], 5, halves), [0; 0]);
    assert_eq!(anticipated_parts(&[0, 0, 12, 0], 8, halves), [1, 1, 6]);
    assert_eq!(anticipated_parts(&[], 9, halves), [0; 0]);
}

#[test]
fn an_anticipated_job_that_is_submitted_keeps_its_results_and_the_others_are_withdrawn() {
    for finished_before in 0..=4 {
        let mut divided = DividedJobs::new(Arc::new(ByColumns));
        let (wanted, wrong) = (other_job(4, 1.0), other_job(4, 2.0));
        let change = divided.anticipate(vec![wrong.clone(), wanted.clone()], 8);
        assert_eq!((change.parts.len(), change.withdrawn.len()), (8, 0));
        let (wrong_parts, parts) = change.parts.split_at(4);
        let result = |part: &(JobId, Job)| finished(part, evaluated(&part.1));
        for part in &parts[..finished_before] {
            assert_eq!(divided.finish(result(part)), PartResult::Awaited);
        }
        // what is anticipated again is not begun again
        let again = divided.anticipate(vec![wanted.clone(), wrong.clone()], 8);
        assert_eq!(again, AnticipationChange::default());
        let ids: Vec<JobId> = parts.iter().map(|(id, _)| *id).collect();
        assert_eq!(divided.claim(JobId(7), &wanted), Some(ids.clone()));
        assert_eq!(divided.claim(JobId(8), &wanted), None);
        let mut joined = divided.join_finished(JobId(7));
        for part in &parts[finished_before..] {
            assert_eq!(joined, PartResult::Awaited);
            joined = divided.finish(result(part));
        }
        let PartResult::Joined(whole) = joined else {
            panic!("{joined:?}");
        };
        assert_eq!(whole.outcome, evaluated(&wanted));
        assert_eq!((whole.job(), whole.work), (JobId(7), wanted.work_hash()));
        assert_eq!(divided.stored(vec![JobId(7)]).len(), 5);
        let withdrawn = divided.anticipate(Vec::new(), 8).withdrawn;
        assert!(withdrawn.iter().eq(wrong_parts.iter().map(|(id, _)| id)));
        assert_eq!(
            divided.finish(result(&wrong_parts[0])),
            PartResult::Discarded
        );
        // a job that is anticipated again later has other ids, as the first are used up
        let later = divided.anticipate(vec![wrong], 8).parts;
        assert!(later.iter().all(|(id, _)| !withdrawn.contains(id)));
    }
}

#[test]
fn a_job_that_is_anticipated_twice_is_computed_once() {
    let mut divided = DividedJobs::new(Arc::new(ByColumns));
    let job = other_job(2, 1.0);
    let parts = divided.anticipate(vec![job.clone(), job.clone()], 9).parts;
    assert_eq!(parts.len(), 2);
    let again = divided.anticipate(vec![job.clone(), job], 9);
    assert_eq!(again, AnticipationChange::default());
    assert_eq!(divided.anticipate(Vec::new(), 9).withdrawn.len(), 2);
}

#[test]
fn fewer_idle_slots_withdraw_what_is_least_likely() {
    let mut divided = DividedJobs::new(Arc::new(ByColumns));
    let jobs: Vec<Job> = (0..3).map(|k| other_job(4, f64::from(k))).collect();
    let parts = divided.anticipate(jobs.clone(), 12).parts;
    assert_eq!(parts.len(), 12);
    let withdrawn = divided.anticipate(jobs.clone(), 9).withdrawn;
    assert!(withdrawn.iter().eq(parts[8..].iter().map(|(id, _)| id)));
    // a failure that is no result of the run ends the anticipation alone
    let failed = Completed {
        id: parts[0].0,
        cost: Cost::default(),
        outcome: Outcome::Failed(Failure::misconfigured("field", "problem")),
        replayed: false,
    };
    assert_eq!(divided.fail(&failed), None);
    assert_eq!(divided.claim(JobId(1), &jobs[0]), None);
    assert!(divided.claim(JobId(2), &jobs[1]).is_some());
}

#[test]
fn parts_are_named_by_their_content() {
    let ids = |whole: u64, count: usize| {
        let mut divided = DividedJobs::new(Arc::new(ByColumns));
        let parts = divided.divide(JobId(whole), job(6), count);
        parts.into_iter().map(|(id, _)| id).collect::<Vec<_>>()
    };
    assert_eq!(ids(1, 3), ids(1, 3));
    for other in [ids(2, 3), ids(1, 2)] {
        assert!(ids(1, 3).iter().all(|id| !other.contains(id)));
    }
}
