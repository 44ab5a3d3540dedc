//! Errors of a measurement that are small and constant while it lasts: gains of instruments, marks that are
//! slightly off, friction that is known to be present. Their standard deviations are known beforehand, so
//! each is a nuisance parameter with a prior in every fit, test and interval, and no discovery while it stays
//! within its tolerance.
use serde::{Deserialize, Serialize};

/// Constant error of a measurement with a known standard deviation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Nuisance {
    /// Identifier of the library's effect that models the error, or name of the channel gain.
    pub id: String,
    /// Name of the effect's size parameter that the error sets.
    pub parameter: String,
    /// Unit of the error's standard deviation.
    pub unit: String,
    /// Way in which the error acts on the compared curves.
    pub acts: Acts,
    /// Standard deviation of the error about its absent value.
    pub deviation: f64,
    /// Whether the error is never negative: its prior is half a normal distribution.
    pub never_negative: bool,
    /// Whether the error's standard deviation is a usual value for such instruments, not stated in the data
    /// sheet.
    pub assumed: bool,
}

impl Nuisance {
    /// Returns the standard deviation of the error with its unit, as `0.5 %` or `0.02 deg`.
    pub fn tolerance(&self) -> String {
        // the shortest decimal number of three digits
        let short = |value: f64| format!("{value:.2e}").parse().unwrap_or(value);
        match self.unit.as_str() {
            "" | "1" => format!("{} %", short(100.0 * self.deviation)),
            unit => format!("{} {unit}", short(self.deviation)),
        }
    }
}

/// Way in which a nuisance parameter acts on the compared curves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Acts {
    /// Acts as the library effect with the same identifier; ignored where the library lacks that effect.
    Effect,
    /// Acts as the gain of a channel, which then reads `(1 + x) y`.
    Gain {
        /// Index of the channel's curve among those of its condition.
        curve: usize,
    },
}
