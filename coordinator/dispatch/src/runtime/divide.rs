//! Division of jobs that ask for derivatives into parts for slots that would be idle.
//!
//! A simulation with derivatives takes several times as long as a plain one, and a descent waits for it. Each
//! part repeats the simulation with some of the columns. Results are pure functions of their jobs, and the
//! derivative by one column does not depend on the others: the joined answers are, bit for bit, the answer to
//! the whole job. The journal has the whole job alone.
use crate::scheduler::Completed;
use protocol::{
    event::Finished,
    id::{ContentHash, JobId},
    job::{Answer, Derivative, Failure, Job, Outcome, Reply},
    message::{Attempt, Cost},
};
use std::collections::BTreeMap;

/// Bit that the ids of parts have and ids of submitted jobs do not.
const PART: u64 = 1 << 63;

/// Divided jobs of a run without a stored result.
#[derive(Debug, Default)]
pub(super) struct DividedJobs {
    open: BTreeMap<JobId, DividedJob>,
    /// Divided jobs by the ids of their parts, until the results of the parts are stored.
    whole_of: BTreeMap<JobId, JobId>,
    /// Results of parts that have been joined and wait for the journal, by the divided job.
    joined: BTreeMap<JobId, Vec<JobId>>,
}

/// Job whose parts are being computed.
#[derive(Debug)]
struct DividedJob {
    work: ContentHash,
    parts: Vec<JobId>,
    finished: BTreeMap<JobId, Finished>,
}

/// Result of a part, as far as it concerns the whole job.
#[derive(Debug, PartialEq)]
pub(super) enum PartResult {
    /// Other parts of the job are still being computed.
    Awaited,
    /// All parts are there: the result of the whole job.
    Joined(Box<Finished>),
    /// The job has its result already, or is unknown: the result of the part can be discarded.
    Discarded,
}

/// Returns whether an id is that of a part.
pub(super) const fn is_part(id: JobId) -> bool {
    id.0 & PART != 0
}

/// Returns whether a job can be divided: a simulation that returns the derivatives by several columns.
pub(super) fn is_divisible(job: &Job) -> bool {
    match job {
        Job::Simulate(spec) => match spec.reply {
            Reply::Score { with_residual, .. } => with_residual && spec.columns.len() > 1,
            Reply::Channels => spec.columns.len() > 1,
            Reply::Curves { .. } => false,
        },
        Job::Own { .. } | Job::Describe | Job::Nothing { .. } => false,
    }
}

/// Returns the number of parts into which each of `jobs` jobs with `columns` columns is divided on `idle` idle
/// slots: as many as leave no slot idle. A part with `n` columns costs as much as `1 + 0.44 n` plain
/// simulations of the pumping unit (12 columns cost 6.3), so that even two parts halve the wait, at 1.16 times the
/// work, of slots that would do none.
pub(crate) fn part_count(columns: usize, jobs: usize, idle: usize) -> usize {
    (idle / jobs.max(1)).clamp(1, columns.max(1))
}

impl DividedJobs {
    /// Divides a job into `count` parts and returns these with their ids; an indivisible job has one part.
    pub(super) fn divide(&mut self, id: JobId, job: Job, count: usize) -> Vec<(JobId, Job)> {
        let Job::Simulate(spec) = &job else {
            return vec![(id, job)];
        };
        let size = spec.columns.len().div_ceil(count.max(1)).max(1);
        if size >= spec.columns.len() {
            return vec![(id, job)];
        }
        let parts: Vec<(JobId, Job)> = spec
            .columns
            .chunks(size)
            .map(|columns| {
                let mut part = spec.clone();
                part.columns = columns.to_vec();
                let part = Job::Simulate(part);
                (part_id(id, &part), part)
            })
            .collect();
        let ids: Vec<JobId> = parts.iter().map(|(part, _)| *part).collect();
        self.whole_of.extend(ids.iter().map(|part| (*part, id)));
        let divided = DividedJob {
            work: job.work_hash(),
            parts: ids,
            finished: BTreeMap::new(),
        };
        self.open.insert(id, divided);
        parts
    }

    /// Takes the result of a part.
    pub(super) fn finish(&mut self, result: Finished) -> PartResult {
        let part = result.attempt.job;
        let Some(whole) = self.whole_of.get(&part).copied() else {
            return PartResult::Discarded;
        };
        let Some(divided) = self.open.get_mut(&whole) else {
            return PartResult::Discarded;
        };
        let failed = matches!(result.outcome, Outcome::Failed(_));
        divided.finished.insert(part, result);
        if !failed && divided.finished.len() < divided.parts.len() {
            return PartResult::Awaited;
        }
        let Some(divided) = self.open.remove(&whole) else {
            return PartResult::Discarded;
        };
        self.joined.insert(whole, divided.parts.clone());
        join(whole, divided).map_or(PartResult::Discarded, |joined| {
            PartResult::Joined(Box::new(joined))
        })
    }

    /// Takes the failure of a part that is no result of the run and is not stored; returns the same failure of the
    /// whole job, unless that has a result already.
    pub(super) fn fail(&mut self, part: &Completed) -> Option<Completed> {
        let whole = *self.whole_of.get(&part.id)?;
        let divided = self.open.remove(&whole)?;
        for part in &divided.parts {
            self.whole_of.remove(part);
        }
        Some(Completed {
            id: whole,
            ..part.clone()
        })
    }

    /// Replaces jobs that are stored in the journal by their parts, whose results need not be kept any longer.
    pub(super) fn stored(&mut self, jobs: Vec<JobId>) -> Vec<JobId> {
        let mut all = Vec::with_capacity(jobs.len());
        for job in jobs {
            for part in self.joined.remove(&job).into_iter().flatten() {
                self.whole_of.remove(&part);
                all.push(part);
            }
            all.push(job);
        }
        all
    }

    /// Returns the id under which a job was submitted: that of the whole job for a part.
    pub(super) fn submitted_id(&self, job: JobId) -> JobId {
        self.whole_of.get(&job).copied().unwrap_or(job)
    }
}

/// Returns whether a failure is no result of the run, since another build or another case may do better; the
/// scheduler delivers it without storing it.
pub(super) const fn is_not_stored(failure: &Failure) -> bool {
    matches!(
        failure,
        Failure::Refused { .. } | Failure::Misconfigured { .. }
    )
}

/// Returns the id of a part, which follows from the whole job's id and the part's content: a worker that returns
/// a result to a restarted coordinator cannot mean another part.
fn part_id(whole: JobId, part: &Job) -> JobId {
    let content = [&whole.0.to_le_bytes()[..], &part.work_hash().0].concat();
    let [a, b, c, d, e, f, g, h, ..] = ContentHash::of(&content).0;
    JobId(u64::from_le_bytes([a, b, c, d, e, f, g, h]) | PART)
}

/// Joins the results of the parts of a job to the result of the job; the first failure is that of the whole job.
fn join(id: JobId, divided: DividedJob) -> Option<Finished> {
    let DividedJob {
        work,
        parts,
        mut finished,
    } = divided;
    let mut ordered = parts.iter().filter_map(|part| finished.remove(part));
    let mut whole = ordered.next()?;
    for part in ordered {
        whole.cost = Cost {
            wall_us: whole.cost.wall_us + part.cost.wall_us,
            cpu_us: whole.cost.cpu_us + part.cost.cpu_us,
        };
        whole.outcome = match (whole.outcome, part.outcome) {
            (Outcome::Done(mut first), Outcome::Done(next)) => {
                if let (Some(columns), Some(more)) = (columns(&mut first), into_columns(next)) {
                    columns.extend(more);
                }
                Outcome::Done(first)
            }
            (failed @ Outcome::Failed(_), _) | (Outcome::Done(_), failed @ Outcome::Failed(_)) => {
                failed
            }
        };
    }
    Some(Finished {
        attempt: Attempt {
            job: id,
            ..whole.attempt
        },
        work,
        ..whole
    })
}

const fn columns(answer: &mut Answer) -> Option<&mut Vec<Derivative>> {
    match answer {
        Answer::Scored(evaluation) => Some(&mut evaluation.columns),
        Answer::Channels(observation) => Some(&mut observation.columns),
        Answer::Curves(_) | Answer::Own(_) | Answer::Described(_) | Answer::Nothing(_) => None,
    }
}

fn into_columns(mut answer: Answer) -> Option<Vec<Derivative>> {
    columns(&mut answer).map(std::mem::take)
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::{
        id::{AttemptId, WorkerId},
        job::{Column, Counters, Evaluation, Individual, Per, Reply, SimulateSpec, Verdict},
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
        assert!(is_divisible(&job(2)) && !is_divisible(&job(1)));
    }

    #[test]
    fn joined_parts_are_the_answer_to_the_whole_job_in_any_order() {
        for count in [2, 3, 5, 12] {
            let mut divided = DividedJobs::default();
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
        let mut divided = DividedJobs::default();
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

    #[test]
    fn parts_are_named_by_their_content() {
        let ids = |whole: u64, count: usize| {
            let mut divided = DividedJobs::default();
            let parts = divided.divide(JobId(whole), job(6), count);
            parts.into_iter().map(|(id, _)| id).collect::<Vec<_>>()
        };
        assert_eq!(ids(1, 3), ids(1, 3));
        for other in [ids(2, 3), ids(1, 2)] {
            assert!(ids(1, 3).iter().all(|id| !other.contains(id)));
        }
    }
}
