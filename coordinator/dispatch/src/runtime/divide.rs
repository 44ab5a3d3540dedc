//! Division of jobs into parts for slots that would be idle.
//!
//! How a job is divided and the answers of its parts are joined is known to the caller ([`Divide`]). The journal has the
//! whole job alone.
//!
//! Slots that are still idle compute jobs that the run will probably submit, in parts as well. Once such a job
//! is submitted, what has been computed of it is used; the others are withdrawn.
#[cfg(test)]
pub(crate) mod by_columns;
#[cfg(test)]
mod tests;

use crate::scheduler::Completed;
use journal::event::Finished;
use journal::job_range::PARTS;
use protocol::{
    id::{ContentHash, JobId},
    job::{Failure, Job, Outcome},
    message::{Attempt, Cost},
};
use std::{
    collections::{BTreeMap, BTreeSet},
    fmt,
    sync::Arc,
};

/// Division of jobs by their content, which the dispatcher does not know.
pub trait Divide: fmt::Debug + Send + Sync {
    /// Returns the number of units of work that the parts of a job can share; 0 for a job that stays whole.
    fn units(&self, job: &Job) -> usize;

    /// Returns the parts of a job with at most `size` units each, in order.
    fn split(&self, job: Job, size: usize) -> Vec<Job>;

    /// Joins the outcome of the next part to that of the parts before it. That of all parts is, bit for bit, the outcome
    /// of the whole job.
    fn join(&self, joined: Outcome, next: Outcome) -> Outcome;

    /// Returns the smallest number of parts in which an anticipated job with a number of units is worth its slots.
    fn least_parts(&self, units: usize) -> usize;
}

/// Division that leaves every job whole.
#[derive(Clone, Copy, Debug)]
pub struct Undivided;

impl Divide for Undivided {
    fn units(&self, _: &Job) -> usize {
        0
    }

    fn split(&self, job: Job, _size: usize) -> Vec<Job> {
        vec![job]
    }

    fn join(&self, joined: Outcome, _next: Outcome) -> Outcome {
        joined
    }

    fn least_parts(&self, _units: usize) -> usize {
        1
    }
}

/// Divided jobs of a run without a stored result, and anticipated jobs.
#[derive(Debug)]
pub(crate) struct DividedJobs {
    divide: Arc<dyn Divide>,
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

/// Returns the number of parts into which each of `jobs` jobs with a number of units is divided on `idle` idle slots: as
/// many as leave no slot idle.
pub(crate) fn part_count(units: usize, jobs: usize, idle: usize) -> usize {
    (idle / jobs.max(1)).clamp(1, units.max(1))
}

/// Returns the numbers of parts in which jobs with the given numbers of units are computed ahead on `idle` slots, likeliest
/// first; jobs beyond the end of the list are not computed ahead. `least` returns the smallest number of parts in which a
/// job with a number of units is worth its slots.
pub(crate) fn anticipated_parts(
    units: &[usize],
    idle: usize,
    least: impl Fn(usize) -> usize,
) -> Vec<usize> {
    let (mut left, mut parts) = (idle, Vec::new());
    for least in units.iter().map(|units| least(*units)) {
        if least > left {
            break;
        }
        left -= least;
        parts.push(least);
    }
    for (parts, units) in parts.iter_mut().zip(units) {
        let more = units.saturating_sub(*parts);
        if more <= left {
            *parts += more;
            left -= more;
        }
    }
    parts
}

impl DividedJobs {
    /// Creates the state of a run without open jobs.
    pub(crate) const fn new(divide: Arc<dyn Divide>) -> Self {
        Self {
            divide,
            open: BTreeMap::new(),
            anticipated: Vec::new(),
            anticipated_count: 0,
            whole_of: BTreeMap::new(),
            joined: BTreeMap::new(),
        }
    }

    /// Returns the number of units of work that the parts of a job can share; 0 for a job that stays whole.
    pub(crate) fn units(&self, job: &Job) -> usize {
        self.divide.units(job)
    }

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
        let units: Vec<usize> = new.iter().map(|job| self.divide.units(job)).collect();
        let counts = anticipated_parts(&units, idle, |units| self.divide.least_parts(units));
        for (job, count) in new.into_iter().zip(counts) {
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
        let units = self.divide.units(&job);
        if units <= units.div_ceil(count.max(1)) {
            return vec![(id, job)];
        }
        self.open(id, job, count)
    }

    /// Registers a job as divided into about `count` parts, an indivisible one as a single part, and returns the
    /// parts with their ids.
    fn open(&mut self, id: JobId, job: Job, count: usize) -> Vec<(JobId, Job)> {
        let work = job.work_hash();
        let size = self.divide.units(&job).div_ceil(count.max(1));
        let parts = if size > 0 {
            self.divide.split(job, size)
        } else {
            vec![job]
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
        join(whole, divided, &*self.divide).map_or(PartResult::Discarded, |joined| {
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

    /// Returns whether a submitted job is being computed in several parts.
    #[cfg(test)]
    pub(crate) fn has_parts(&self) -> bool {
        let mut open = self.open.iter();
        open.any(|(id, own)| own.parts.len() > 1 && !self.anticipated.contains(id))
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

/// Joins the results of the parts of a job to the result of the job.
fn join(id: JobId, divided: DividedJob, by: &dyn Divide) -> Option<Finished> {
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
        whole.outcome = by.join(whole.outcome, part.outcome);
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
