//! Numbers of jobs that are looked up by their content.
//!
//! Requests of `evaluate`, of a table and of a sweep come in any order, and equal ones are computed once: a job's
//! number follows from the hash of its content, so that a run which is opened again finds its results. Two jobs whose
//! hashes begin alike would share a number; the journal keeps the whole hash beside each number, and the second job
//! takes another one.
use protocol::{
    id::{ContentHash, JobId},
    job::Job,
};
use std::collections::BTreeMap;

/// Bits of a hash that become a number: every table format holds integers of that size exactly.
const BITS: u32 = 48;

/// Numbers of the jobs of one run, each for one content.
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
    /// Numbers of so many bits (1 to 63), none of them taken.
    pub const fn with_bits(bits: u32) -> Self {
        Self {
            by_content: BTreeMap::new(),
            by_number: BTreeMap::new(),
            mask: (1 << bits) - 1,
        }
    }

    /// Takes note of the number that a job has in the journal; the first entry of a number or a content counts.
    pub fn note(&mut self, number: JobId, content: ContentHash) {
        if !self.by_number.contains_key(&number) && !self.by_content.contains_key(&content) {
            self.by_number.insert(number, content);
            self.by_content.insert(content, number);
        }
    }

    /// The number of a job: the one that it has, or the first free one from the start of its hash on.
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
