//! Set of job ids stored as contiguous ranges: ids are assigned consecutively, so a million ids take only a
//! handful of ranges.
use protocol::id::JobId;
use std::collections::BTreeMap;

/// Set of job ids, stored as disjoint ranges.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct JobSet {
    /// Ranges of job ids, first to last, which neither overlap nor touch.
    ranges: BTreeMap<u64, u64>,
    count: usize,
}

impl JobSet {
    /// Returns whether the set contains a job.
    pub fn contains(&self, job: JobId) -> bool {
        self.at_or_before(job.0).is_some_and(|(_, to)| job.0 <= to)
    }

    /// Adds a job id to the set; no effect if the set contains it already.
    pub fn insert(&mut self, job: JobId) {
        let id = job.0;
        let before = self.at_or_before(id);
        if before.is_some_and(|(_, to)| id <= to) {
            return;
        }
        self.count += 1;
        let from = match before {
            Some((from, to)) if to.checked_add(1) == Some(id) => from,
            Some(_) | None => id,
        };
        let to = id
            .checked_add(1)
            .and_then(|next| self.ranges.remove(&next))
            .unwrap_or(id);
        self.ranges.insert(from, to);
    }

    /// Returns the number of jobs in the set.
    pub const fn len(&self) -> usize {
        self.count
    }

    /// Returns whether the set is empty.
    pub const fn is_empty(&self) -> bool {
        self.count == 0
    }

    fn at_or_before(&self, id: u64) -> Option<(u64, u64)> {
        let range = self.ranges.range(..=id).next_back();
        range.map(|(from, to)| (*from, *to))
    }
}

impl FromIterator<JobId> for JobSet {
    fn from_iter<I: IntoIterator<Item = JobId>>(jobs: I) -> Self {
        let mut set = Self::default();
        for job in jobs {
            set.insert(job);
        }
        set
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    proptest! {
        #[test]
        fn it_is_a_set(ids in proptest::collection::vec(0_u64..60, 0..120)) {
            let set: JobSet = ids.iter().copied().map(JobId).collect();
            let expected: BTreeSet<u64> = ids.into_iter().collect();
            prop_assert_eq!(set.len(), expected.len());
            for id in 0..62 {
                prop_assert_eq!(set.contains(JobId(id)), expected.contains(&id), "{}", id);
            }
        }
    }

    #[test]
    fn a_million_in_disorder_become_one_range() {
        let set: JobSet = (0..1_000_000)
            .map(|n| JobId(n * 7919 % 1_000_000))
            .collect();
        assert_eq!((set.len(), set.ranges.len()), (1_000_000, 1));
        let ends: JobSet = [JobId(u64::MAX), JobId(0)].into_iter().collect();
        assert!(ends.contains(JobId(u64::MAX)) && !ends.contains(JobId(1)));
    }
}
