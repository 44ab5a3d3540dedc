//! Division of jobs that ask for derivatives into parts for slots that would be idle.
//!
//! A simulation with derivatives takes several times as long as a plain one, and a descent waits for it. Each
//! part repeats the simulation with some of the columns. Results are pure functions of their jobs, and the
//! derivative by one column does not depend on the others: the joined answers are, bit for bit, the answer to
//! the whole job. The journal has the whole job alone.
//!
//! Slots that are still idle compute jobs that the run will probably submit, in parts as well. Once such a job
//! is submitted, what has been computed of it is used; the others are withdrawn.
#[cfg(test)]
mod tests;

use crate::scheduler::Completed;
use journal::event::Finished;
use journal::job_range::PARTS;
use protocol::{
    id::{ContentHash, JobId},
    job::{Answer, Column, Derivative, Failure, Job, Outcome, Reply},
    message::{Attempt, Cost},
};
use std::collections::{BTreeMap, BTreeSet};

/// Divided jobs of a run without a stored result, and anticipated jobs.
#[derive(Debug, Default)]
pub(crate) struct DividedJobs {
    open: BTreeMap<JobId, DividedJob>,
    /// Anticipated jobs under their provisional ids, likeliest first; they are divided jobs until they are
    /// claimed or withdrawn.
    anticipated: Vec<JobId>,
    /// Number of jobs anticipated so far, from which provisional ids are made.
    anticipated_count: u64,
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

/// Changes of the anticipated jobs of a run.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct AnticipationChange {
    /// Parts that are no longer anticipated.
    pub(crate) withdrawn: Vec<JobId>,
    /// Parts of newly anticipated jobs, with their ids, likeliest first.
    pub(crate) parts: Vec<(JobId, Job)>,
}

impl DividedJob {
    /// Returns the number of parts without a result.
    fn running(&self) -> usize {
        self.parts.len() - self.finished.len()
    }

    /// Returns whether the result of the job is known: all parts have one, or one of them is a failure.
    fn is_decided(&self) -> bool {
        let failed = |own: &Finished| matches!(own.outcome, Outcome::Failed(_));
        self.running() == 0 || self.finished.values().any(failed)
    }
}

/// Result of a part, as far as it concerns the whole job.
#[derive(Debug, PartialEq)]
pub(crate) enum PartResult {
    /// Other parts of the job are still being computed.
    Awaited,
    /// All parts are there: the result of the whole job.
    Joined(Box<Finished>),
    /// The job has its result already, or is unknown: the result of the part can be discarded.
    Discarded,
}

/// Returns whether a job can be divided: a simulation that returns the derivatives by several columns.
pub(crate) fn is_divisible(job: &Job) -> bool {
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

/// Returns the smallest number of parts in which an anticipated job is worth its slots: parts of two columns,
/// which end before the same job would if it was begun, in parts of one column, after the simulations that are
/// running now (1.9 plain simulations against 1 + 1.4).
const fn least_parts(columns: usize) -> usize {
    if columns == 0 { 1 } else { columns.div_ceil(2) }
}

/// Returns the numbers of parts in which jobs with the given numbers of columns are computed ahead on `idle`
/// slots, likeliest first; jobs beyond the end of the list are not computed ahead.
pub(crate) fn anticipated_parts(columns: &[usize], idle: usize) -> Vec<usize> {
    let (mut left, mut parts) = (idle, Vec::new());
    for least in columns.iter().map(|columns| least_parts(*columns)) {
        if least > left {
            break;
        }
        left -= least;
        parts.push(least);
    }
    for (parts, columns) in parts.iter_mut().zip(columns) {
        let more = columns.saturating_sub(*parts);
        if more <= left {
            *parts += more;
            left -= more;
        }
    }
    parts
}

/// Returns the number of derivative columns that a job asks for.
fn column_count(job: &Job) -> usize {
    match job {
        Job::Simulate(spec) if is_divisible(job) => spec.columns.len(),
        Job::Simulate(_) | Job::Own { .. } | Job::Describe | Job::Nothing { .. } => 0,
    }
}

impl DividedJobs {
    /// Replaces the anticipated jobs by `jobs`, likeliest first: those that are anticipated already stay, as
    /// far as `idle` slots suffice, and slots that are left take new ones.
    pub(crate) fn anticipate(&mut self, jobs: Vec<Job>, mut idle: usize) -> AnticipationChange {
        let before: BTreeMap<ContentHash, JobId> = std::mem::take(&mut self.anticipated)
            .into_iter()
            .filter_map(|id| Some((self.open.get(&id)?.work, id)))
            .collect();
        let mut new = Vec::new();
        let mut seen = BTreeSet::new();
        for job in jobs {
            let work = job.work_hash();
            if !seen.insert(work) {
                continue;
            }
            let Some(id) = before.get(&work) else {
                new.push(job);
                continue;
            };
            let running = self.open.get(id).map_or(0, DividedJob::running);
            if running <= idle {
                idle -= running;
                self.anticipated.push(*id);
            }
        }
        let mut change = AnticipationChange::default();
        for id in before.into_values() {
            if !self.anticipated.contains(&id)
                && let Some(divided) = self.open.remove(&id)
            {
                change.withdrawn.extend(divided.parts);
            }
        }
        for part in &change.withdrawn {
            self.whole_of.remove(part);
        }
        let columns: Vec<usize> = new.iter().map(column_count).collect();
        for (job, count) in new.into_iter().zip(anticipated_parts(&columns, idle)) {
            self.anticipated_count += 1;
            let id = JobId(PARTS | self.anticipated_count);
            self.anticipated.push(id);
            change.parts.extend(self.open(id, job, count));
        }
        change
    }

    /// Makes the anticipated job with the same content as `job` the submitted job `id`, and returns its parts;
    /// `None` if there is no such job.
    pub(crate) fn claim(&mut self, id: JobId, job: &Job) -> Option<Vec<JobId>> {
        if self.anticipated.is_empty() {
            return None;
        }
        let work = job.work_hash();
        let is_same = |own: &JobId| self.open.get(own).is_some_and(|own| own.work == work);
        let at = self.anticipated.iter().position(is_same)?;
        let divided = self.open.remove(&self.anticipated.remove(at))?;
        let parts = divided.parts.clone();
        self.whole_of.extend(parts.iter().map(|part| (*part, id)));
        self.open.insert(id, divided);
        Some(parts)
    }

    /// Divides a job into about `count` parts and returns these with their ids; an indivisible job, or one that
    /// is to have one part, stays whole.
    pub(crate) fn divide(&mut self, id: JobId, job: Job, count: usize) -> Vec<(JobId, Job)> {
        let columns = column_count(&job);
        if columns <= columns.div_ceil(count.max(1)) {
            return vec![(id, job)];
        }
        self.open(id, job, count)
    }

    /// Registers a job as divided into about `count` parts, an indivisible one as a single part, and returns the
    /// parts with their ids.
    fn open(&mut self, id: JobId, job: Job, count: usize) -> Vec<(JobId, Job)> {
        let work = job.work_hash();
        let size = column_count(&job).div_ceil(count.max(1));
        let parts: Vec<Job> = match job {
            Job::Simulate(spec) if size > 0 => {
                let part = |columns: &[Column]| {
                    let mut part = spec.clone();
                    part.columns = columns.to_vec();
                    Job::Simulate(part)
                };
                spec.columns.chunks(size).map(part).collect()
            }
            whole @ (Job::Simulate(_) | Job::Own { .. } | Job::Describe | Job::Nothing { .. }) => {
                vec![whole]
            }
        };
        let parts: Vec<(JobId, Job)> = parts
            .into_iter()
            .map(|part| (part_id(id, &part), part))
            .collect();
        let ids: Vec<JobId> = parts.iter().map(|(part, _)| *part).collect();
        self.whole_of.extend(ids.iter().map(|part| (*part, id)));
        let divided = DividedJob {
            work,
            parts: ids,
            finished: BTreeMap::new(),
        };
        self.open.insert(id, divided);
        parts
    }

    /// Takes the result of a part.
    pub(crate) fn finish(&mut self, result: Finished) -> PartResult {
        let part = result.attempt.job;
        let Some(whole) = self.whole_of.get(&part).copied() else {
            return PartResult::Discarded;
        };
        let Some(divided) = self.open.get_mut(&whole) else {
            return PartResult::Discarded;
        };
        divided.finished.insert(part, result);
        if self.anticipated.contains(&whole) {
            return PartResult::Awaited;
        }
        self.join_finished(whole)
    }

    /// Joins the results of a job's parts if all are there, or one of them is a failure.
    pub(crate) fn join_finished(&mut self, whole: JobId) -> PartResult {
        if !self.open.get(&whole).is_some_and(DividedJob::is_decided) {
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
    /// whole job, unless that has a result already or was only anticipated.
    pub(crate) fn fail(&mut self, part: &Completed) -> Option<Completed> {
        let whole = *self.whole_of.get(&part.id)?;
        let divided = self.open.remove(&whole)?;
        for part in &divided.parts {
            self.whole_of.remove(part);
        }
        if let Some(at) = self.anticipated.iter().position(|id| *id == whole) {
            self.anticipated.remove(at);
            return None;
        }
        Some(Completed {
            id: whole,
            ..part.clone()
        })
    }

    /// Replaces jobs that are stored in the journal by their parts, whose results need not be kept any longer.
    pub(crate) fn stored(&mut self, jobs: Vec<JobId>) -> Vec<JobId> {
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
    pub(crate) fn submitted_id(&self, job: JobId) -> JobId {
        self.whole_of.get(&job).copied().unwrap_or(job)
    }
}

/// Returns whether a failure is no result of the run, since another build or another case may do better; the
/// scheduler delivers it without storing it.
pub(crate) const fn is_not_stored(failure: &Failure) -> bool {
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
    JobId(u64::from_le_bytes([a, b, c, d, e, f, g, h]) | PARTS)
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
