//! Numbers of the jobs of a study, within the ranges of [`journal::job_range`].
//!
//! Requests of `evaluate`, of a table and of a sweep come in any order, and equal ones are computed once:
//! their numbers are derived from the hashes of their content ([`JobNumbers`]). If the hashes of two jobs
//! begin alike, the second job takes another number; the journal stores the whole hash with each number,
//! which makes this unambiguous.
use journal::job_range::{COMPARISONS, CONTENT_BITS, IDENTIFIABILITY};
use protocol::{
    id::{ContentHash, JobId},
    job::Job,
};
use std::collections::BTreeMap;

/// Number of bits of a comparison's number within one condition.
const CONDITION_BITS: u32 = 17;

/// Returns the number of the first of the two jobs (score and curves) of a compared individual; each
/// condition has numbers for 65,536 individuals.
pub(super) fn of_comparison(condition: usize, position: usize) -> u64 {
    COMPARISONS + ((condition as u64) << CONDITION_BITS) + 2 * position as u64
}

/// Returns condition and position of the compared individual that a job scores or simulates; `None` for other jobs.
pub(super) fn compared_individual(JobId(number): JobId) -> Option<(usize, usize)> {
    let place = number.checked_sub(COMPARISONS)?;
    let position = usize::try_from((place % (1 << CONDITION_BITS)) / 2).ok()?;
    let condition = usize::try_from(place >> CONDITION_BITS).ok()?;
    (number < IDENTIFIABILITY).then_some((condition, position))
}

/// Returns the number of the proposal that a job of a search evaluates; `None` for other jobs.
pub(super) fn proposal_number(JobId(number): JobId) -> Option<u64> {
    (number < COMPARISONS).then_some(number)
}

/// Map between the contents of a run's jobs (by hash) and their numbers.
#[derive(Clone, Debug)]
pub struct JobNumbers {
    by_content: BTreeMap<ContentHash, JobId>,
    by_number: BTreeMap<JobId, ContentHash>,
    mask: u64,
}

impl Default for JobNumbers {
    fn default() -> Self {
        Self::with_bits(CONTENT_BITS)
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
