//! Errors of a measurement that are small and constant while it lasts: gains of instruments, marks that are
//! slightly off, friction that is known to be present. Their standard deviations are known beforehand, so
//! each is a nuisance parameter with a prior in every fit, test and interval, and no discovery while it stays
//! within its tolerance.

/// Constant error of a measurement with a known standard deviation.
#[derive(Clone, Debug, PartialEq)]
pub struct Nuisance {
    /// Identifier of the library's effect that the error is, or name of a channel's gain.
    pub id: String,
    /// Name of the effect's size parameter that the error sets.
    pub parameter: String,
    /// Unit of the error's standard deviation.
    pub unit: String,
    /// Way in which the error acts.
    pub acts: Acts,
    /// Standard deviation about the absent value.
    pub deviation: f64,
    /// Whether the value is never negative: its prior is half a normal distribution.
    pub never_negative: bool,
    /// Whether the standard deviation is a usual value for such instruments, not stated in the data sheet.
    pub assumed: bool,
}

/// Way in which a nuisance parameter acts on the compared curves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Acts {
    /// Effect of the library with the same identifier; ignored where the library lacks it.
    Effect,
    /// Gain of a channel, which reads `(1 + x) y`.
    Gain {
        /// Index of the channel's curve among those of its condition.
        curve: usize,
    },
}
