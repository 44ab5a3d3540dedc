//! Initial designs: where to look first, before anything is known.
use super::{
    archive::{Archive, Evaluated},
    piece::{Batch, Draft, Piece},
    proposal::Purpose,
};
use crate::{
    random::{Phase, Streams},
    space::{Interval, Space},
};

/// A Latin hypercube: along every axis each of the `count` equal parts of its interval holds
/// exactly one point. Returns `count` points (coordinate); the same seed gives the same ones.
pub fn latin_hypercube(intervals: &[Interval], count: usize, seed: u64) -> Vec<Vec<f64>> {
    hypercube(intervals, count, Streams::new(seed, 0))
}

/// The same from streams of a run.
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

/// The start and these points; where a space has starts of its own they stand in their first places, none is
/// left out.
pub(super) fn led(space: &Space, others: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
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

/// Points as a piece of a strategy: one batch.
pub(super) struct Points {
    /// Those that have not been asked for.
    drafts: Vec<Draft>,
    /// How many are being evaluated.
    running: usize,
}

impl Points {
    /// Those of these coordinates.
    pub(super) fn new(space: &Space, points: &[Vec<f64>]) -> Self {
        let drafts = points.iter().map(|point| Draft {
            genes: space.values(point),
            purpose: Purpose::Initial,
        });
        Self {
            drafts: drafts.collect(),
            running: 0,
        }
    }
}

impl Piece for Points {
    fn plan(&mut self, _archive: &Archive) -> Option<Batch> {
        let drafts = std::mem::take(&mut self.drafts);
        self.running = drafts.len();
        (!drafts.is_empty()).then_some(Batch {
            generation: 0,
            drafts,
        })
    }

    fn absorb(&mut self, _results: &[Evaluated]) {
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
