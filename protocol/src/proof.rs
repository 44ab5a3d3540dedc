//! Result of a case's reference individual on a worker, and the comparison of two machines' results.
use crate::id::ContentHash;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Largest number of values in [`ReferenceResult::Values`].
pub const MAX_SAMPLES: usize = 64;

/// Result of a case's reference individual on one machine, by which machines are compared.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum ReferenceResult {
    /// Hash of the encoded result, for a model that is reproducible bit by bit.
    Bits(ContentHash),
    /// Selected values of the result, for a model that is not reproducible bit by bit; at most
    /// [`MAX_SAMPLES`].
    Values(Vec<Sample>),
    /// The reference individual failed in a model that is not reproducible bit by bit.
    Failed,
}

/// Selected value of the reference individual's result, with the scale for its comparison.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// Value of one channel at one abscissa, in the channel's unit.
    pub value: f64,
    /// Root mean square of all values of the same channel, to which permitted differences are relative, in
    /// the channel's unit.
    pub scale: f64,
}

impl ReferenceResult {
    /// Compares the reference results of this and another machine: hashes must be equal; values may differ by
    /// at most `tolerance` times the larger of their scales.
    ///
    /// # Errors
    /// Description of the difference, in words.
    pub fn compare(&self, other: &Self, tolerance: f64) -> Result<(), String> {
        match (self, other) {
            (Self::Bits(own), Self::Bits(others)) if own == others => Ok(()),
            (Self::Values(own), Self::Values(others)) if own.len() == others.len() => {
                let mut pairs = own.iter().zip(others);
                match pairs.find(|(a, b)| !a.is_near(b, tolerance)) {
                    None => Ok(()),
                    Some((a, b)) => Err(format!(
                        "{} where this run's is {}; the difference exceeds {tolerance} times the channel's root mean square",
                        b.value, a.value
                    )),
                }
            }
            _ => Err(format!("{other}, where this run's is {self}")),
        }
    }
}

impl Sample {
    fn is_near(&self, other: &Self, tolerance: f64) -> bool {
        // what is no number is near to nothing
        (self.value - other.value).abs() <= tolerance * self.scale.max(other.scale)
    }
}

impl fmt::Display for ReferenceResult {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bits(hash) => write!(to, "{hash}"),
            Self::Values(samples) => write!(to, "{} values", samples.len()),
            Self::Failed => write!(to, "a failure"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_may_differ_by_a_share_of_their_channel_s_size() {
        let values = |values: [f64; 2]| {
            let sample = |value| Sample { value, scale: 10.0 };
            ReferenceResult::Values(values.map(sample).to_vec())
        };
        let own = values([1.0, -9.0]);
        assert_eq!(own.compare(&values([1.0005, -9.0005]), 1e-4), Ok(()));
        let told = own.compare(&values([1.0, -9.002]), 1e-4).unwrap_err();
        assert!(told.contains("-9.002 where this run's is -9"), "{told}");
        for other in [
            values([f64::NAN, -9.0]),
            ReferenceResult::Values(Vec::new()),
            ReferenceResult::Failed,
            ReferenceResult::Bits(ContentHash([1; 32])),
        ] {
            assert!(own.compare(&other, 1.0).is_err(), "{other:?}");
        }
        let bits = |byte| ReferenceResult::Bits(ContentHash([byte; 32]));
        assert_eq!(bits(1).compare(&bits(1), 0.0), Ok(()));
        assert!(bits(1).compare(&bits(2), 1.0).is_err());
    }
}
