//! Channels: simulated and measured curves, each with a name, a unit and an abscissa. Independent of the
//! machine.
use super::objective::Offset;
use serde::{Deserialize, Serialize};

/// Signal of a simulation under one condition, with its measured record if there is one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Channel {
    /// Short name of the channel, unique within its condition, e.g. `force`.
    pub name: String,
    /// Description of the channel in words, e.g. `force at the support`.
    pub title: String,
    /// Unit of the values, as text; no conversion is made.
    pub unit: String,
    /// Index in the case of the condition under which the channel is simulated.
    pub condition: usize,
    /// Abscissa of the channel's values, e.g. time.
    pub abscissa: Abscissa,
    /// Standard deviation of the measurement noise of one value, in [`Self::unit`]; `None` if not stated.
    pub noise: Option<f64>,
    /// Exponent of the rounding step: the worker rounds the curve to whole multiples of two to this power,
    /// far below the noise, which reduces its encoded size to a fifth (`crate::curve`). `None` leaves the
    /// curve exact.
    pub step: Option<i32>,
    /// Weights of the values: each difference is multiplied by its weight before further use, so a value of
    /// weight 2 counts four times and its noise is half of [`Self::noise`]. Positive; empty where all weights
    /// are 1.
    #[serde(with = "crate::curve")]
    pub weights: Vec<f64>,
    /// Whether the channel's values have an absolute zero, so that a constant difference counts as an error.
    pub offset: Offset,
    /// Side on which the record limits the channel; `None` where the record is to be met.
    pub limit: Option<ChannelLimit>,
    /// Measured record of the channel used for scoring; `None` if it was not measured.
    pub record: Option<ChannelRecord>,
}

impl Channel {
    /// Returns whether the values have an absolute zero, so that a constant difference counts as an error.
    pub fn is_absolute(&self) -> bool {
        self.offset == Offset::Fixed
    }

    /// Multiplies the differences between two curves of the channel by the weights of the channel's values.
    pub fn weigh(&self, differences: &mut [f64]) {
        for (difference, weight) in differences.iter_mut().zip(&self.weights) {
            *difference *= weight;
        }
    }
}

/// Side on which a record limits a channel: only values beyond the limit count as errors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ChannelLimit {
    /// The record is the greatest value that the channel may have.
    AtMost,
    /// The record is the least value that the channel may have.
    AtLeast,
}

impl ChannelLimit {
    /// Returns whether a difference, measured minus simulated, keeps the limit.
    pub fn holds(self, difference: f64) -> bool {
        match self {
            Self::AtMost => difference >= 0.0,
            Self::AtLeast => difference <= 0.0,
        }
    }
}

/// Abscissa along which a curve is given.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Abscissa {
    /// Name of the abscissa quantity, e.g. `time`.
    pub name: String,
    /// Unit of the abscissa, as text.
    pub unit: String,
    /// Positions of the channel's values along the abscissa, ascending.
    #[serde(with = "crate::curve")]
    pub points: Vec<f64>,
    /// Period after which the curve repeats; `None` for a curve that is not periodic.
    pub period: Option<f64>,
}

/// Measured record of a channel, averaged over repeated cycles and sampled on the channel's abscissa.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ChannelRecord {
    /// Number of measured cycles that were averaged.
    pub cycles: usize,
    /// Mean curve over the measured cycles, in the channel's unit.
    #[serde(with = "crate::curve")]
    pub mean: Vec<f64>,
    /// Standard deviation between the cycles, in the channel's unit; zeros if there is only one cycle.
    #[serde(with = "crate::curve")]
    pub spread: Vec<f64>,
}
