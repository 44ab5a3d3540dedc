//! Pairs of a request and its result.
use crate::event::{Asked, Event, Finished};
use protocol::id::JobId;
use std::collections::{BTreeMap, BTreeSet};

/// Fold that pairs each request of a journal with the first result of its job, whichever of them is read first: where
/// the request was lost to damage, it is written again when the run is resumed.
#[derive(Clone, Debug, Default)]
pub struct Answers {
    asked: BTreeMap<JobId, Asked>,
    finished: BTreeMap<JobId, Finished>,
    paired: BTreeSet<JobId>,
}

impl Answers {
    /// Adds the next event of the journal; returns the pair that it completes.
    pub fn pair(&mut self, event: Event) -> Option<(Asked, Finished)> {
        let (asked, finished) = match event {
            Event::Asked(asked) if !self.paired.contains(&asked.job) => {
                let Some(finished) = self.finished.remove(&asked.job) else {
                    self.asked.insert(asked.job, *asked);
                    return None;
                };
                (*asked, finished)
            }
            Event::Finished(finished) if !self.paired.contains(&finished.job()) => {
                let Some(asked) = self.asked.remove(&finished.job()) else {
                    self.finished.entry(finished.job()).or_insert(*finished);
                    return None;
                };
                (asked, *finished)
            }
            Event::Asked(_)
            | Event::Finished(_)
            | Event::Begun { .. }
            | Event::Opened { .. }
            | Event::Joined { .. }
            | Event::Left { .. }
            | Event::Closed
            | Event::Proved { .. }
            | Event::Accounted(_)
            | Event::Found { .. } => return None,
        };
        self.paired.insert(asked.job);
        Some((asked, finished))
    }

    /// Returns the number of requests without a result.
    pub fn unanswered(&self) -> usize {
        self.asked.len()
    }

    /// Returns the number of results without a request.
    pub fn unknown(&self) -> usize {
        self.finished.len()
    }

    /// Returns the number of jobs with a result.
    pub fn results(&self) -> usize {
        self.paired.len() + self.finished.len()
    }
}
