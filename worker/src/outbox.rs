//! Outbox of a worker: results that the coordinator has not yet acknowledged.
use protocol::message::{Attempt, Done};
use std::{
    collections::{BTreeMap, VecDeque},
    time::Duration,
};

const FIRST: Duration = Duration::from_secs(1);
const LONGEST: Duration = Duration::from_secs(8);
/// Number of acknowledged attempts that are remembered, so that a late copy of a job is not computed again.
const REMEMBERED: usize = 4096;

/// Outbox that keeps each result until it is acknowledged, and schedules its retransmission.
#[derive(Debug, Default)]
pub struct Outbox {
    waiting: BTreeMap<Attempt, Waiting>,
    settled: VecDeque<Attempt>,
}

#[derive(Debug)]
struct Waiting {
    done: Done,
    again_at: Duration,
    pause: Duration,
}

impl Outbox {
    /// Adds a result that was just sent.
    pub fn put(&mut self, done: Done, now: Duration) {
        let waiting = Waiting {
            again_at: now + FIRST,
            pause: FIRST,
            done,
        };
        self.waiting.insert(waiting.done.attempt, waiting);
    }

    /// Removes acknowledged results and remembers their attempts.
    pub fn acknowledge(&mut self, attempts: &[Attempt]) {
        for attempt in attempts {
            if self.waiting.remove(attempt).is_some() {
                self.remember(*attempt);
            }
        }
    }

    /// Remembers an attempt as settled: no further result will be sent for it.
    pub fn remember(&mut self, attempt: Attempt) {
        if self.settled.len() == REMEMBERED {
            self.settled.pop_front();
        }
        self.settled.push_back(attempt);
    }

    /// Returns whether an attempt is settled (acknowledged or abandoned).
    pub fn is_settled(&self, attempt: Attempt) -> bool {
        self.settled.contains(&attempt)
    }

    /// Returns the unacknowledged result of an attempt, if there is one.
    pub fn get(&self, attempt: Attempt) -> Option<&Done> {
        self.waiting.get(&attempt).map(|waiting| &waiting.done)
    }

    /// Returns the attempts with unacknowledged results.
    pub fn attempts(&self) -> Vec<Attempt> {
        self.waiting.keys().copied().collect()
    }

    /// Returns the results to be sent again now. Intervals between transmissions are 1, 2, 4 and then always
    /// 8 s.
    pub fn due(&mut self, now: Duration) -> Vec<Done> {
        let mut due = Vec::new();
        for waiting in self.waiting.values_mut() {
            if waiting.again_at <= now {
                waiting.pause = (waiting.pause * 2).min(LONGEST);
                waiting.again_at = now + waiting.pause;
                due.push(waiting.done.clone());
            }
        }
        due
    }

    /// Makes all results due for retransmission, after a reconnection.
    pub fn make_all_due(&mut self) {
        for waiting in self.waiting.values_mut() {
            waiting.again_at = Duration::ZERO;
            waiting.pause = FIRST / 2;
        }
    }

    /// Clears the outbox, because the run that its results belong to is over.
    pub fn clear(&mut self) {
        *self = Self::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::{
        id::{AttemptId, ContentHash, JobId},
        job::{Answer, Outcome},
        message::Cost,
    };

    fn result(job: u64) -> Done {
        Done {
            attempt: Attempt {
                job: JobId(job),
                attempt: AttemptId(1),
            },
            work: ContentHash::of(b"work"),
            cost: Cost::default(),
            outcome: Outcome::Done(Answer::Nothing(vec![1])),
        }
    }

    #[test]
    fn a_result_is_repeated_ever_more_rarely_until_it_is_acknowledged() {
        let mut outbox = Outbox::default();
        outbox.put(result(3), Duration::from_secs(100));
        let mut times = Vec::new();
        for second in 100..140 {
            if !outbox.due(Duration::from_secs(second)).is_empty() {
                times.push(second);
            }
        }
        assert_eq!(times, [101, 103, 107, 115, 123, 131, 139]);
        outbox.make_all_due();
        assert_eq!(outbox.due(Duration::from_secs(140)), [result(3)]);
        outbox.acknowledge(&[result(4).attempt, result(3).attempt]);
        assert_eq!(outbox.due(Duration::from_secs(999)), []);
        assert!(outbox.is_settled(result(3).attempt));
        assert!(!outbox.is_settled(result(4).attempt));
    }
}
