//! Numbers of the jobs of a run: a job keeps its number in the journal, so that a resumed run finds its
//! result.
//!
//! A search numbers its individuals from 0 in the order of its proposals; a diagnosis and an identification
//! number their experiments from [`EXPERIMENTS`] in the order of request. Comparisons and the identifiability
//! estimate after a calibration have separate higher ranges, so that numbers never collide.
//!
//! Requests of `evaluate`, of a table and of a sweep come in any order, and equal ones are computed once:
//! their numbers are derived from the hashes of their content ([`JobNumbers`]). If the hashes of two jobs
//! begin alike, the second job takes another number; the journal stores the whole hash with each number,
//! which makes this unambiguous.
use protocol::{
    id::{ContentHash, JobId},
    job::Job,
};
use std::collections::BTreeMap;

/// Number of the job that asks a worker for its effects.
pub(super) const LIBRARY: u64 = 0;
/// Number of the first experiment of a diagnosis or an identification.
pub(super) const EXPERIMENTS: u64 = LIBRARY + 1;
/// Number of the first experiment of the identifiability estimate after a calibration; above the numbers of
/// its individuals and comparisons.
pub(super) const IDENTIFIABILITY_JOBS: u64 = 1 << 50;
/// Number of the first comparison job, which scores or simulates a selected individual; above the job number
/// of any individual of a search.
const COMPARISONS: u64 = 1 << 40;

/// Returns the number of the first of the two jobs (score and curves) of a compared individual; each
/// condition has numbers for 256 individuals.
pub(super) fn of_comparison(condition: usize, position: usize) -> u64 {
    COMPARISONS + ((condition as u64) << 9) + 2 * position as u64
}

/// Returns condition and position of the compared individual that a job scores or simulates; `None` for other jobs.
pub(super) fn compared_individual(JobId(number): JobId) -> Option<(usize, usize)> {
    let place = number.checked_sub(COMPARISONS)?;
    let position = usize::try_from((place % 512) / 2).ok()?;
    (number < IDENTIFIABILITY_JOBS).then_some((usize::try_from(place >> 9).ok()?, position))
}

/// Returns the number of the proposal that a job of a search evaluates; `None` for other jobs.
pub(super) fn proposal_number(JobId(number): JobId) -> Option<u64> {
    (number < COMPARISONS).then_some(number)
}

/// Number of bits of a hash that form a job number; every table format represents integers of this size
/// exactly.
const BITS: u32 = 48;

/// Map between the contents of a run's jobs (by hash) and their numbers.
#[derive(Clone, Debug)]
pub struct JobNumbers {
    by_content: BTreeMap<ContentHash, JobId>,
    by_number: BTreeMap<JobId, ContentHash>,
    mask: u64,
}

impl Default for JobNumbers {
    fn default() -> Self {
        Self::with_bits(BITS)
    }
}

impl JobNumbers {
    /// Creates an empty map whose job numbers have the given number of bits (1 to 63).
    pub const fn with_bits(bits: u32) -> Self {
        Self {
            by_content: BTreeMap::new(),
            by_number: BTreeMap::new(),
            mask: (1 << bits) - 1,
        }
    }

    /// Records the number and content of a job read from the journal; if a number or a content occurs twice,
    /// the first entry counts.
    pub fn note(&mut self, number: JobId, content: ContentHash) {
        if !self.by_number.contains_key(&number) && !self.by_content.contains_key(&content) {
            self.by_number.insert(number, content);
            self.by_content.insert(content, number);
        }
    }

    /// Returns the number of a job: the recorded one, or the first free number counting upwards from the one
    /// given by its hash.
    pub(super) fn number(&mut self, job: &Job) -> JobId {
        let content = job.work_hash();
        if let Some(number) = self.by_content.get(&content) {
            return *number;
        }
        let [a, b, c, d, e, f, g, h, ..] = content.0;
        let mut number = u64::from_le_bytes([a, b, c, d, e, f, g, h]) & self.mask;
        while self.by_number.contains_key(&JobId(number)) {
            number = (number + 1) & self.mask;
        }
        self.note(JobId(number), content);
        JobId(number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn job(payload: u8) -> Job {
        Job::Nothing {
            payload: vec![payload],
            reply_bytes: 0,
            delay_ms: 0,
        }
    }

    #[test]
    fn jobs_with_like_hashes_have_numbers_of_their_own_and_keep_them() {
        // 200 jobs in 256 numbers: most of the later ones meet another
        let mut numbers = JobNumbers::with_bits(8);
        let first: Vec<JobId> = (0..200).map(|n| numbers.number(&job(n))).collect();
        let distinct: std::collections::BTreeSet<_> = first.iter().collect();
        assert_eq!(distinct.len(), 200);
        // a run that is opened again asks in another order
        let mut again = JobNumbers::with_bits(8);
        for n in 0..200 {
            again.note(first[usize::from(n)], job(n).work_hash());
        }
        for n in (0..200).rev() {
            assert_eq!(again.number(&job(n)), first[usize::from(n)]);
        }
        // where nothing collides a number is the start of the hash
        let whole = JobNumbers::default().number(&job(7)).0;
        assert_eq!(whole.to_le_bytes()[..6], job(7).work_hash().0[..6]);
    }
}
