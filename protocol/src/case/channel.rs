//! What a simulation shows and a record measures: curves, each with a name, a unit and the places
//! where its values stand. It knows nothing of the machine that they belong to.
use super::objective::Offset;
use serde::{Deserialize, Serialize};

/// One curve of a simulation under one condition, and what was measured of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Channel {
    /// Short name that no other channel of its condition has, as `force`.
    pub name: String,
    /// The name in words, as `force at the support`.
    pub title: String,
    /// Unit of its values, as written; nothing converts it.
    pub unit: String,
    /// Index of its condition in the case.
    pub condition: usize,
    /// Where its values stand.
    pub abscissa: Abscissa,
    /// Standard deviation of the noise of one value, in [`Self::unit`]; none where nobody states it.
    pub noise: Option<f64>,
    /// The worker rounds the curve to whole multiples of two to this power, far below the noise, so
    /// that it travels and is kept in a fifth of the bytes (`crate::curve`); none leaves it exact.
    pub step: Option<i32>,
    /// Factor of each value's difference before anything is done with it: a value of weight 2 counts four
    /// times, and its noise is half of [`Self::noise`]. Positive; empty where all count alike.
    #[serde(with = "crate::curve")]
    pub weights: Vec<f64>,
    /// Whether its values have a zero.
    pub offset: Offset,
    /// What was measured, as scores compare it; none where nothing is compared.
    pub record: Option<ChannelRecord>,
}

impl Channel {
    /// Whether its values have a zero, so that the constant of a difference counts.
    pub fn is_absolute(&self) -> bool {
        self.offset == Offset::Fixed
    }

    /// Multiplies a curve's differences by the weights of their values.
    pub fn weigh(&self, differences: &mut [f64]) {
        for (difference, weight) in differences.iter_mut().zip(&self.weights) {
            *difference *= weight;
        }
    }
}

/// The axis along which a curve is given.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Abscissa {
    /// What is counted along it, as `time`.
    pub name: String,
    /// Its unit, as written.
    pub unit: String,
    /// Where the values stand, ascending.
    #[serde(with = "crate::curve")]
    pub points: Vec<f64>,
    /// After how much the curve begins anew; none where it does not.
    pub period: Option<f64>,
}

/// What was measured of a channel, averaged over repeated cycles, on its abscissa.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ChannelRecord {
    /// Number of cycles that were averaged.
    pub cycles: usize,
    /// Mean over the cycles, in the channel's unit.
    #[serde(with = "crate::curve")]
    pub mean: Vec<f64>,
    /// Standard deviation between the cycles, in the channel's unit; zeros where there is one cycle
    /// only.
    #[serde(with = "crate::curve")]
    pub spread: Vec<f64>,
}
