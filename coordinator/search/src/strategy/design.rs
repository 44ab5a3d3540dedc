//! Initial designs: the first points of a search, before any result.
use super::{
    archive::{Archive, EvaluatedIndividual},
    proposal::Purpose,
    stage::{Batch, ProposalDraft, SearchStage},
};
use crate::{
    random::{Phase, Streams},
    space::{Interval, Space},
};

/// Returns a Latin hypercube of `count` points (coordinate): along every axis each of the `count` equal parts
/// of its interval holds exactly one point. The same seed gives the same points.
pub fn latin_hypercube(intervals: &[Interval], count: usize, seed: u64) -> Vec<Vec<f64>> {
    hypercube(intervals, count, Streams::new(seed, 0))
}

pub(super) fn hypercube(intervals: &[Interval], count: usize, streams: Streams) -> Vec<Vec<f64>> {
    let mut points = vec![Vec::with_capacity(intervals.len()); count];
    for (axis, interval) in intervals.iter().enumerate() {
        let mut stream = streams.at(0, Phase::Initial, axis);
        let mut parts: Vec<usize> = (0..count).collect();
        stream.shuffle(&mut parts);
        for (point, part) in points.iter_mut().zip(parts) {
            let share = (part as f64 + stream.unit()) / count as f64;
            point.push(interval.from + share * interval.length());
        }
    }
    points
}

/// Returns the starting points of the space followed by the points `others`; for each starting point beyond
/// the first, one of `others` is dropped, so that the total count is kept.
pub(super) fn prepend_starts(space: &Space, others: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let starts = match space.starts() {
        [] => vec![space.origin()],
        starts => starts.to_vec(),
    };
    let replaced = starts.len() - 1;
    starts
        .into_iter()
        .chain(others.into_iter().skip(replaced))
        .collect()
}

/// Batch-wise part (stage) of a strategy that evaluates a fixed set of initial points in one batch.
pub(super) struct Points {
    drafts: Vec<ProposalDraft>,
    running: usize,
}

impl Points {
    /// Creates a stage that evaluates the given points (coordinate).
    pub(super) fn new(space: &Space, points: &[Vec<f64>]) -> Self {
        let drafts = points.iter().map(|point| ProposalDraft {
            genes: space.values(point),
            purpose: Purpose::Initial,
        });
        Self {
            drafts: drafts.collect(),
            running: 0,
        }
    }
}

impl SearchStage for Points {
    fn plan(&mut self, _archive: &Archive) -> Option<Batch> {
        let drafts = std::mem::take(&mut self.drafts);
        self.running = drafts.len();
        (!drafts.is_empty()).then_some(Batch {
            generation: 0,
            drafts,
        })
    }

    fn absorb(&mut self, _results: &[EvaluatedIndividual]) {
        self.running = 0;
    }

    fn generations(&self) -> u32 {
        0
    }

    fn remaining(&self) -> u64 {
        (self.drafts.len() + self.running) as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_of_every_axis_is_met_once() {
        let intervals = [
            Interval {
                from: -1.0,
                to: 1.5,
            },
            Interval { from: 0.0, to: 4.0 },
        ];
        let points = latin_hypercube(&intervals, 25, 3);
        for (axis, interval) in intervals.iter().enumerate() {
            let mut seen = [false; 25];
            for point in &points {
                let share = (point[axis] - interval.from) / interval.length();
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "a share of 0..25"
                )]
                let part = (share * 25.0) as usize;
                assert!(
                    !std::mem::replace(&mut seen[part], true),
                    "part {part} twice"
                );
            }
            assert!(seen.iter().all(|part| *part));
        }
    }
}
