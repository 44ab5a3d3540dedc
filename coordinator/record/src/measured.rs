//! Measured records as the diagnosis takes them, cycle by cycle.
use crate::input_scatter::InputScatter;
use crate::nuisance::Nuisance;
use protocol::case::{Abscissa, Channel};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Curves of one cycle: channel by channel, in the channel's unit, on its abscissa.
pub type Curves = Vec<Vec<f64>>;

/// Channel of a measured record.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Recorded {
    /// Index of the simulated curve with which the channel is compared, among the channels of its condition.
    pub curve: usize,
    /// Indices of the simulated curve's values that the channel contains, ascending; `None` if it contains
    /// all. A channel of which a part is held out occurs twice in a record.
    pub rows: Option<Vec<usize>>,
    /// Whether the gap is counted on this channel. Other channels only help to tell causes apart; where no
    /// channel is marked, the gap is counted on all.
    pub scored: bool,
    /// Whether the channel is held out: it takes part in no fit or test and is compared at the end only.
    pub held_out: bool,
    /// Correlation of the channel's noise from one value to the next, averaged over the grid; `None` where it
    /// is not stated.
    pub correlation: Option<f64>,
    /// Standard deviation of the model error in the channel's unit, below which no model is accurate; it adds
    /// to the noise. `None` unless stated.
    pub model_error: Option<f64>,
    /// Names, unit, abscissa and noise of the channel. The measured values are in [`Record::cycles`].
    pub channel: Channel,
}

impl Recorded {
    /// Creates a channel of a record from a channel of a case; `curve` is its index among the channels of its
    /// condition. The gap is counted on channels for which the case has a measured record.
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

    /// Returns the channel restricted to the values at the indices `rows`, held out or not.
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

    /// Selects the channel's values from a curve; `None` for a curve that is too short.
    pub fn pick<T: Copy>(&self, curve: &[T]) -> Option<Vec<T>> {
        match &self.rows {
            None => Some(curve.to_vec()),
            Some(rows) => rows.iter().map(|&k| curve.get(k).copied()).collect(),
        }
    }
}

/// Measured record of one working condition.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Index of the condition in the case.
    pub condition: usize,
    /// Channels of the record, in the order of the curves of each cycle; held-out channels stand last.
    pub channels: Vec<Recorded>,
    /// Measured curves of the complete cycles, indexed by cycle, channel and sample.
    pub cycles: Vec<Curves>,
    /// Whether the whole record is held out: it takes part in no fit or test and is compared at the end only.
    pub held_out: bool,
    /// Statements of the data sheet about the measurement.
    pub stated: Stated,
}

/// Record divided into a fitted part and held-out parts.
#[derive(Clone, Debug, PartialEq)]
pub struct Split {
    /// Part of the record to which models are fitted.
    pub fitted: Record,
    /// Record of the held-out cycles, with the fitted channels.
    pub cycles: Record,
    /// Record of the held-out channels or parts of channels.
    pub channels: Record,
}

/// Statements of a data sheet about a measurement.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Stated {
    /// Errors of the input that differ from cycle to cycle.
    pub input_scatter: Vec<InputScatter>,
    /// Variance of one cycle about the mean by channel, where it was estimated from more cycles than the
    /// record holds; empty otherwise.
    pub cycle_variance: Vec<f64>,
    /// Small errors that are constant over the measurement.
    pub nuisances: Vec<Nuisance>,
}

impl Record {
    /// Returns start and end of the first channel's abscissa, in its unit.
    pub fn span(&self) -> [f64; 2] {
        let Some(abscissa) = self.channels.first().map(|own| &own.channel.abscissa) else {
            return [0.0; 2];
        };
        let ends = [abscissa.points.first(), abscissa.points.last()];
        let [first, last] = ends.map(|x| x.copied().unwrap_or_default());
        [first, abscissa.period.map_or(last, |period| first + period)]
    }

    /// Returns the standard deviation of the noise of one value of a channel, as the data sheet states it.
    pub fn noise(&self, channel: usize) -> Option<f64> {
        self.channels[channel].channel.noise
    }

    /// Returns the correlation of a channel's noise from one value to the next, averaged over the grid; 0
    /// where it is not stated.
    pub fn correlation(&self, channel: usize) -> f64 {
        self.channels[channel].correlation.unwrap_or(0.0)
    }

    /// Returns the number of samples of the first channel in a cycle.
    pub fn samples(&self) -> usize {
        let first = self.cycles.first().and_then(|cycle| cycle.first());
        first.map_or(0, Vec::len)
    }

    /// Returns the indices of the channels on which the gap is counted: all where none is marked.
    pub fn scored(&self) -> Vec<usize> {
        let all = 0..self.channels.len();
        let marked: Vec<usize> = all.clone().filter(|&c| self.channels[c].scored).collect();
        if marked.is_empty() {
            all.collect()
        } else {
            marked
        }
    }

    /// Returns the record restricted to a range of cycles.
    #[must_use]
    pub fn part(&self, cycles: Range<usize>) -> Self {
        let end = cycles.end.min(self.cycles.len());
        let begin = cycles.start.min(end);
        Self {
            cycles: self.cycles[begin..end].to_vec(),
            ..self.clone()
        }
    }

    /// Divides the record into a fitted part and held-out parts: a quarter of the cycles, at least one, is
    /// held out (none of fewer than three), and the channels that are marked as held out.
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

    /// Returns whether any part of the record may be fitted.
    pub fn is_fitted(&self) -> bool {
        let free = self.channels.iter().any(|own| !own.held_out);
        free && !self.held_out && !self.cycles.is_empty()
    }

    /// Returns the part that may be fitted: all cycles of the channels that are not held out.
    #[must_use]
    pub fn free(&self) -> Self {
        self.of_channels(false)
    }

    /// Returns the record with the held-out channels moved behind the others, the order in which a diagnosis
    /// numbers them.
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

    /// Returns the variance of one cycle about the mean by channel, as stated or else from the cycles; zeros
    /// where neither is available.
    pub fn cycle_variance(&self) -> Vec<f64> {
        if self.stated.cycle_variance.is_empty() {
            self.scatter()
        } else {
            self.stated.cycle_variance.clone()
        }
    }

    /// Returns the variance of the cycles about their mean by channel; zeros for fewer than two cycles.
    pub fn scatter(&self) -> Vec<f64> {
        if self.cycles.len() < 2 {
            return vec![0.0; self.channels.len()];
        }
        scatter(&self.cycles)
    }

    /// Returns the curves of the mean over the record's cycles.
    pub fn mean(&self) -> Curves {
        mean_of(&self.cycles.iter().collect::<Vec<_>>())
    }
}

/// Returns the variance of cycles about their mean by channel; needs at least two cycles.
pub fn scatter(cycles: &[Curves]) -> Vec<f64> {
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

/// Returns the difference quotient of two sets of curves: `of` less `from`, divided by `per`.
pub fn difference(of: &Curves, from: &Curves, per: f64) -> Curves {
    let channels = of.iter().zip(from);
    channels
        .map(|(of, from)| of.iter().zip(from).map(|(a, b)| (a - b) / per).collect())
        .collect()
}

/// Returns the mean square of values about their mean.
pub fn variance(values: &[f64]) -> f64 {
    let n = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / n;
    values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / n
}

/// Returns the mean square of values, about their mean unless `absolute`. A single value is squared as it is,
/// since it has no mean to be taken about.
pub fn power(values: &[f64], absolute: bool) -> f64 {
    let about_zero = || values.iter().map(|x| x * x).sum::<f64>() / values.len().max(1) as f64;
    match values {
        [_] => about_zero(),
        _ if absolute => about_zero(),
        _ => variance(values),
    }
}

/// Returns the mean of equally shaped curves; empty for no curves.
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

/// Creates a channel on which the gap is counted; `curve` is its index among the curves of an
/// observation.
#[cfg(any(test, feature = "fixtures"))]
pub fn recorded(curve: usize) -> Recorded {
    use protocol::case::Offset;

    let channel = Channel {
        limit: None,
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

#[cfg(test)]
mod tests {
    use super::*;

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
