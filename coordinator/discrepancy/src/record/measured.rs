//! What was measured, cycle by cycle, as the diagnosis takes it.
use crate::record::input_scatter::InputScatter;
use crate::record::nuisance::Nuisance;
use protocol::case::{Abscissa, Channel};
use std::ops::Range;

/// Curves of one cycle: channel by channel, in the channel's unit, on its abscissa.
pub type Curves = Vec<Vec<f64>>;

/// A channel of a record.
#[derive(Clone, Debug, PartialEq)]
pub struct Recorded {
    /// Which curve of an observation it is compared with: its place among the channels of its
    /// condition.
    pub curve: usize,
    /// Which values of that curve it has, ascending; none where it has all. A channel of which a part is held out stands
    /// twice in a record.
    pub rows: Option<Vec<usize>>,
    /// Whether the gap is counted on it. The others help to tell causes apart; where none is
    /// counted on, all are.
    pub scored: bool,
    /// Whether it takes no part in any fit or test: it is compared at the end alone.
    pub held_out: bool,
    /// Correlation of its noise from one value to the next, over the grid; none where it is not stated.
    pub correlation: Option<f64>,
    /// What no law of the model is better than: a standard deviation in its unit that adds to the noise; none unless
    /// stated.
    pub model_error: Option<f64>,
    /// Its names, unit, abscissa and noise; what was measured of it are the record's cycles.
    pub channel: Channel,
}

impl Recorded {
    /// A channel of a case, by its place among those of its condition; the gap is counted on what
    /// scores compare.
    pub fn new(curve: usize, channel: &Channel) -> Self {
        Self {
            curve,
            rows: None,
            scored: channel.record.is_some(),
            held_out: false,
            correlation: None,
            model_error: None,
            channel: Channel {
                record: None,
                ..channel.clone()
            },
        }
    }

    /// The part of it at some of its values, by their places, to be held out or not.
    #[must_use]
    pub fn part(&self, rows: Vec<usize>, held_out: bool) -> Self {
        let own = &self.channel;
        let points = rows.iter().map(|&k| own.abscissa.points[k]).collect();
        let weights = rows.iter().filter_map(|&k| own.weights.get(k).copied());
        Self {
            held_out,
            channel: Channel {
                abscissa: Abscissa {
                    points,
                    ..own.abscissa.clone()
                },
                weights: weights.collect(),
                ..own.clone()
            },
            rows: Some(rows),
            ..self.clone()
        }
    }

    /// Its values of a curve; nothing of one that is too short.
    pub fn pick<T: Copy>(&self, curve: &[T]) -> Option<Vec<T>> {
        match &self.rows {
            None => Some(curve.to_vec()),
            Some(rows) => rows.iter().map(|&k| curve.get(k).copied()).collect(),
        }
    }
}

/// The record of one working condition.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// Index of the condition in the case.
    pub condition: usize,
    /// Its channels, in the order of all curves; those that are held out stand last.
    pub channels: Vec<Recorded>,
    /// Whole cycles; cycle, channel, grid.
    pub cycles: Vec<Curves>,
    /// Whether the whole of it takes no part in any fit or test: it is compared at the end alone.
    pub held_out: bool,
    /// What the data sheet says of the measurement.
    pub stated: Stated,
}

/// A record in parts.
#[derive(Clone, Debug, PartialEq)]
pub struct Split {
    /// What is fitted.
    pub fitted: Record,
    /// Cycles of the fitted channels that take no part.
    pub cycles: Record,
    /// Channels, or parts of them, that take no part.
    pub channels: Record,
}

/// What a data sheet says of a measurement.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stated {
    /// What the input may be wrong by from cycle to cycle.
    pub input_scatter: Vec<InputScatter>,
    /// Variance of one cycle about the mean by channel, where more cycles than these tell it.
    pub cycle_variance: Vec<f64>,
    /// What may be off by a little, constant over the measurement.
    pub nuisances: Vec<Nuisance>,
}

impl Record {
    /// Where the first channel's abscissa begins and ends, in its unit.
    pub fn span(&self) -> [f64; 2] {
        let Some(abscissa) = self.channels.first().map(|own| &own.channel.abscissa) else {
            return [0.0; 2];
        };
        let ends = [abscissa.points.first(), abscissa.points.last()];
        let [first, last] = ends.map(|x| x.copied().unwrap_or_default());
        [first, abscissa.period.map_or(last, |period| first + period)]
    }

    /// Standard deviation of a value of a channel, as stated.
    pub fn noise(&self, channel: usize) -> Option<f64> {
        self.channels[channel].channel.noise
    }

    /// Correlation of a channel's noise from one value to the next, over the grid; 0 where it is not stated.
    pub fn correlation(&self, channel: usize) -> f64 {
        self.channels[channel].correlation.unwrap_or(0.0)
    }

    /// Samples of a turn.
    pub fn samples(&self) -> usize {
        let first = self.cycles.first().and_then(|cycle| cycle.first());
        first.map_or(0, Vec::len)
    }

    /// Places of the channels on which the gap is counted: all where none is marked.
    pub fn scored(&self) -> Vec<usize> {
        let all = 0..self.channels.len();
        let marked: Vec<usize> = all.clone().filter(|&c| self.channels[c].scored).collect();
        if marked.is_empty() {
            all.collect()
        } else {
            marked
        }
    }

    /// Some of the cycles.
    #[must_use]
    pub fn part(&self, cycles: Range<usize>) -> Self {
        let end = cycles.end.min(self.cycles.len());
        let begin = cycles.start.min(end);
        Self {
            cycles: self.cycles[begin..end].to_vec(),
            ..self.clone()
        }
    }

    /// What is fitted and what takes no part in the fit: of the cycles a quarter, at least one, none of
    /// fewer than three; of the channels those that are marked so.
    pub fn split(&self) -> Split {
        let n = self.cycles.len();
        let held = if n < 3 { 0 } else { (n / 4).max(1) };
        let whole = Self {
            stated: Stated {
                cycle_variance: self.cycle_variance(),
                ..self.stated.clone()
            },
            ..self.clone()
        };
        let [free, marked] = [false, true].map(|held_out| whole.of_channels(held_out));
        Split {
            fitted: free.part(0..n - held),
            cycles: free.part(n - held..n),
            channels: marked,
        }
    }

    /// Whether anything of it may be fitted.
    pub fn is_fitted(&self) -> bool {
        let free = self.channels.iter().any(|own| !own.held_out);
        free && !self.held_out && !self.cycles.is_empty()
    }

    /// What may be fitted of it: all cycles of the channels that are not held out.
    #[must_use]
    pub fn free(&self) -> Self {
        self.of_channels(false)
    }

    /// The same with the channels that are held out behind the others, as a diagnosis numbers them.
    #[must_use]
    pub fn held_out_last(self) -> Self {
        if self.channels.iter().is_sorted_by_key(|own| own.held_out) {
            return self;
        }
        let [mut all, held] = [false, true].map(|held_out| self.of_channels(held_out));
        all.channels.extend(held.channels);
        for (cycle, held) in all.cycles.iter_mut().zip(held.cycles) {
            cycle.extend(held);
        }
        all.stated.cycle_variance.extend(held.stated.cycle_variance);
        all
    }

    /// Those of its channels that are held out, or those that are not.
    fn of_channels(&self, held_out: bool) -> Self {
        let all = 0..self.channels.len();
        let kept: Vec<usize> = all
            .filter(|&c| self.channels[c].held_out == held_out)
            .collect();
        let curves = |curves: &Curves| kept.iter().map(|&c| curves[c].clone()).collect();
        let variances = &self.stated.cycle_variance;
        Self {
            channels: kept.iter().map(|&c| self.channels[c].clone()).collect(),
            cycles: self.cycles.iter().map(curves).collect(),
            stated: Stated {
                cycle_variance: kept
                    .iter()
                    .filter_map(|&c| variances.get(c).copied())
                    .collect(),
                ..self.stated.clone()
            },
            ..self.clone()
        }
    }

    /// Variance of one cycle about the mean, by channel, as stated or as seen; zeros where nothing tells
    /// it.
    pub fn cycle_variance(&self) -> Vec<f64> {
        if self.stated.cycle_variance.is_empty() {
            self.scatter()
        } else {
            self.stated.cycle_variance.clone()
        }
    }

    /// Variance of these cycles about their mean, by channel; zeros for fewer than two.
    pub(crate) fn scatter(&self) -> Vec<f64> {
        if self.cycles.len() < 2 {
            return vec![0.0; self.channels.len()];
        }
        scatter(&self.cycles)
    }

    /// Mean over the cycles.
    pub fn mean(&self) -> Curves {
        mean_of(&self.cycles.iter().collect::<Vec<_>>())
    }
}

/// Variance of cycles about their mean, by channel; at least two.
pub(crate) fn scatter(cycles: &[Curves]) -> Vec<f64> {
    let whole = mean_of(&cycles.iter().collect::<Vec<_>>());
    let of_cycle = |cycle: &Curves, c: usize| {
        let d: Vec<f64> = cycle[c].iter().zip(&whole[c]).map(|(y, m)| y - m).collect();
        variance(&d)
    };
    let of = |c: usize| {
        let sum: f64 = cycles.iter().map(|cycle| of_cycle(cycle, c)).sum();
        sum / (cycles.len() - 1) as f64
    };
    (0..whole.len()).map(of).collect()
}

/// Curves less others, per so much of whatever has changed between them.
pub(crate) fn difference(of: &Curves, from: &Curves, per: f64) -> Curves {
    let channels = of.iter().zip(from);
    channels
        .map(|(of, from)| of.iter().zip(from).map(|(a, b)| (a - b) / per).collect())
        .collect()
}

/// Mean square about the mean.
pub(crate) fn variance(values: &[f64]) -> f64 {
    let n = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / n;
    values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / n
}

/// Mean square, about the mean where a constant does not count. What does not move has no mean to be counted from.
pub(crate) fn power(values: &[f64], absolute: bool) -> f64 {
    let about_zero = || values.iter().map(|x| x * x).sum::<f64>() / values.len().max(1) as f64;
    match values {
        [_] => about_zero(),
        _ if absolute => about_zero(),
        _ => variance(values),
    }
}

/// Mean of equally shaped curves; empty of none.
pub fn mean_of(cycles: &[&Curves]) -> Curves {
    let Some(first) = cycles.first() else {
        return Vec::new();
    };
    let n = cycles.len() as f64;
    let channel = |c: usize, length: usize| -> Vec<f64> {
        (0..length)
            .map(|i| cycles.iter().map(|cycle| cycle[c][i]).sum::<f64>() / n)
            .collect()
    };
    let shapes = first.iter().map(Vec::len).enumerate();
    shapes.map(|(c, length)| channel(c, length)).collect()
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use protocol::case::Offset;

    /// A channel on which the gap is counted, by its place among the curves of an observation.
    pub(crate) fn recorded(curve: usize) -> Recorded {
        let channel = Channel {
            name: format!("channel_{curve}"),
            title: format!("channel {curve}"),
            unit: "N".to_owned(),
            condition: 0,
            abscissa: Abscissa {
                name: "turn".to_owned(),
                unit: "deg".to_owned(),
                points: Vec::new(),
                period: Some(360.0),
            },
            noise: None,
            step: None,
            weights: Vec::new(),
            offset: Offset::Free,
            record: None,
        };
        Recorded {
            curve,
            rows: None,
            scored: true,
            held_out: false,
            correlation: None,
            model_error: None,
            channel,
        }
    }

    #[test]
    fn the_gap_is_counted_on_what_is_marked_and_else_on_everything() {
        let mut record = Record {
            condition: 0,
            channels: vec![recorded(4), recorded(0), recorded(2)],
            cycles: Vec::new(),
            held_out: false,
            stated: Stated::default(),
        };
        record.channels[1].scored = false;
        assert_eq!(record.scored(), [0, 2]);
        for channel in &mut record.channels {
            channel.scored = false;
        }
        assert_eq!(record.scored(), [0, 1, 2]);
    }

    #[test]
    fn a_quarter_of_the_cycles_and_the_marked_channels_take_no_part() {
        let cycle = |k: usize| {
            let curve = |c: usize| vec![(10 * c + k) as f64, 0.0];
            (0..3).map(curve).collect()
        };
        let mut record = Record {
            condition: 0,
            channels: vec![recorded(0), recorded(1), recorded(2)],
            cycles: (0..8).map(cycle).collect(),
            held_out: false,
            stated: Stated::default(),
        };
        record.channels[1].held_out = true;
        let whole = record.cycle_variance();
        let Split {
            fitted,
            cycles,
            channels,
        } = record.split();
        let names = |record: &Record| -> Vec<usize> {
            record.channels.iter().map(|own| own.curve).collect()
        };
        assert_eq!((names(&fitted), names(&cycles)), (vec![0, 2], vec![0, 2]));
        assert_eq!(names(&channels), [1]);
        let sizes = [&fitted, &cycles, &channels].map(|part| part.cycles.len());
        assert_eq!(sizes, [6, 2, 8]);
        assert_eq!(cycles.cycles[0], [vec![6.0, 0.0], vec![26.0, 0.0]]);
        // how much a cycle scatters is known from all of them
        assert_eq!(fitted.cycle_variance(), [whole[0], whole[2]]);
        assert_eq!(record.part(0..2).split().cycles.cycles.len(), 0);
    }
}
