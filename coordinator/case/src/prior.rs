//! Priors of the unknowns in the forms in which a case may state them.
//!
//! Priors are used where there is a noise model: in a diagnosis and an identification, never in the mean
//! squared errors of a calibration.
use super::{
    document::{Document, DocumentStep},
    error::CaseError,
};
use protocol::case::{Prior, Scale, Unknown};
use serde::Deserialize;

/// Half width of a 95 % interval of the normal distribution, in standard deviations.
const NORMAL: f64 = 1.96;

/// Prior of an unknown, in one of the forms that a case file allows.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(
    untagged,
    expecting = "an interval [low, high], or { value = .., factor = .. } of what is searched on a logarithmic \
                 scale, or { value = .., deviation = .. } in decades or halves of the interval"
)]
pub enum PriorEntry {
    /// Interval `[low, high]` that contains the value with 95 % probability.
    Interval([f64; 2]),
    /// Value known to a factor: 95 % lies between `value / factor` and `value * factor`.
    Factor(PriorFactor),
    /// Value of the unknown with its standard deviation in the search coordinate.
    Deviation(Deviation),
}

/// Central value of a prior, with the factor by which its 95 % interval extends either way.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PriorFactor {
    value: f64,
    factor: f64,
}

/// Central value of a prior, with its standard deviation.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Deviation {
    value: f64,
    deviation: f64,
}

impl PriorEntry {
    /// Converts the entry to the prior of an unknown; `keys` is its location in the file, for error messages.
    ///
    /// # Errors
    /// Returns an error if the numbers are not a valid prior on the scale of the unknown.
    pub fn of(
        self,
        unknown: &Unknown,
        document: &Document,
        keys: &[DocumentStep<'_>],
    ) -> Result<Prior, CaseError> {
        let logarithmic = unknown.scale == Scale::Logarithmic;
        let refused = |found: String, allowed: &str| {
            let remedy = "correct it, or leave it out: then only the bounds are known";
            Err(document.field(keys, found, allowed, remedy))
        };
        match self {
            Self::Interval([low, high]) => {
                let positive = !logarithmic || low > 0.0;
                if !(low < high && (high - low).is_finite() && positive) {
                    let found = format!("[{low}, {high}]");
                    return if logarithmic {
                        refused(found, "[low, high], positive and ascending")
                    } else {
                        refused(found, "[low, high], finite and ascending")
                    };
                }
                Ok(interval(unknown, [low, high]))
            }
            Self::Factor(PriorFactor { value, factor }) => {
                let good = value > 0.0 && value.is_finite() && factor > 1.0 && factor.is_finite();
                if !(logarithmic && good) {
                    let found = format!("{{ value = {value}, factor = {factor} }}");
                    let allowed = "a positive value and a factor above 1, of an unknown on a logarithmic scale";
                    return refused(found, allowed);
                }
                Ok(Prior {
                    value,
                    deviation: libm::log10(factor) / NORMAL,
                })
            }
            // what makes no sense in it is refused with all else that is known of an unknown
            Self::Deviation(Deviation { value, deviation }) => Ok(Prior { value, deviation }),
        }
    }
}

/// Returns the prior with 95 % of its probability in an interval, on the scale of the unknown. The interval
/// must be finite and ascending, and positive on a logarithmic scale.
pub(super) fn interval(unknown: &Unknown, [low, high]: [f64; 2]) -> Prior {
    match unknown.scale {
        Scale::Logarithmic => Prior {
            value: (low * high).sqrt(),
            deviation: 0.5 * libm::log10(high / low) / NORMAL,
        },
        Scale::Linear => Prior {
            value: f64::midpoint(low, high),
            // halves of the interval that is searched are its coordinate
            deviation: (high - low) / (unknown.upper - unknown.lower) / NORMAL,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_is_the_same_on_either_scale() {
        let linear = Unknown::new("a", "N", Scale::Linear, 0.0, [-10.0, 10.0]);
        let prior = interval(&linear, [1.0, 5.0]);
        // coordinates are 10 N long
        assert!((prior.value - 3.0).abs() < 1e-12);
        assert!((prior.value + 10.0 * NORMAL * prior.deviation - 5.0).abs() < 1e-12);
        let factor = Unknown::new("b", "N/m", Scale::Logarithmic, 1.0, [1e-3, 1e3]);
        let prior = interval(&factor, [2.0, 32.0]);
        assert!((prior.value - 8.0).abs() < 1e-12);
        let end = prior.value * libm::exp10(NORMAL * prior.deviation);
        assert!((end - 32.0).abs() < 1e-9, "{end}");
    }
}
