//! What was measured, cycle by cycle, as the diagnosis takes it.
use crate::record::tolerance::Tolerance;
use protocol::case::Channel;
use std::ops::Range;

/// Curves of one cycle: channel by channel, in the channel's unit, on its abscissa.
pub type Curves = Vec<Vec<f64>>;

/// A channel of a record.
#[derive(Clone, Debug, PartialEq)]
pub struct Recorded {
    /// Which curve of an observation it is compared with: its place among the channels of its
    /// condition.
    pub curve: usize,
    /// Whether the gap is counted on it. The others help to tell causes apart; where none is
    /// counted on, all are.
    pub scored: bool,
    /// Its names, unit, abscissa and noise; what was measured of it are the record's cycles.
    pub channel: Channel,
}

impl Recorded {
    /// A channel of a case, by its place among those of its condition; the gap is counted on what
    /// scores compare.
    pub fn new(curve: usize, channel: &Channel) -> Self {
        Self {
            curve,
            scored: channel.record.is_some(),
            channel: Channel {
                record: None,
                ..channel.clone()
            },
        }
    }
}

/// The record of one working condition.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// Index of the condition in the case.
    pub condition: usize,
    /// Its channels, in the order of all curves.
    pub channels: Vec<Recorded>,
    /// Whole cycles; cycle, channel, grid.
    pub cycles: Vec<Curves>,
    /// What the data sheet says of the measurement.
    pub stated: Stated,
}

/// What a data sheet says of a measurement.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stated {
    /// Standard deviation of the load from cycle to cycle, over its value.
    pub load_scatter: f64,
    /// Tolerance of the crank angle (deg).
    pub angle_tolerance_deg: f64,
    /// Correlation of the noise from sample to sample, over the grid.
    pub noise_correlation: f64,
    /// Variance of one cycle about the mean by channel, where more cycles than these tell it.
    pub cycle_variance: Vec<f64>,
    /// How good the instruments are.
    pub tolerance: Tolerance,
}

impl Record {
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

    /// The cycles that are fitted and those that take no part in the fit: a quarter, at least one;
    /// none of fewer than three.
    pub fn split(&self) -> (Self, Self) {
        let n = self.cycles.len();
        let held = if n < 3 { 0 } else { (n / 4).max(1) };
        let whole = Self {
            stated: Stated {
                cycle_variance: self.cycle_variance(),
                ..self.stated.clone()
            },
            ..self.clone()
        };
        (whole.part(0..n - held), whole.part(n - held..n))
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
        let n = self.cycles.len();
        if n < 2 {
            return vec![0.0; self.channels.len()];
        }
        let whole = self.mean();
        let scatter = |cycle: &Curves, c: usize| {
            let d: Vec<f64> = cycle[c].iter().zip(&whole[c]).map(|(y, m)| y - m).collect();
            variance(&d)
        };
        let of = |c: usize| {
            let sum: f64 = self.cycles.iter().map(|cycle| scatter(cycle, c)).sum();
            sum / (n - 1) as f64
        };
        (0..self.channels.len()).map(of).collect()
    }

    /// Mean over the cycles.
    pub fn mean(&self) -> Curves {
        mean_of(&self.cycles.iter().collect::<Vec<_>>())
    }
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
    use protocol::case::Abscissa;

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
            record: None,
        };
        Recorded {
            curve,
            scored: true,
            channel,
        }
    }

    #[test]
    fn the_gap_is_counted_on_what_is_marked_and_else_on_everything() {
        let mut record = Record {
            condition: 0,
            channels: vec![recorded(4), recorded(0), recorded(2)],
            cycles: Vec::new(),
            stated: Stated::default(),
        };
        record.channels[1].scored = false;
        assert_eq!(record.scored(), [0, 2]);
        for channel in &mut record.channels {
            channel.scored = false;
        }
        assert_eq!(record.scored(), [0, 1, 2]);
    }
}
