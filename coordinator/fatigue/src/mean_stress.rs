//! Correction of a stress cycle for its mean stress: the range of a fully reversed cycle that does the same damage.

/// Rule by which the mean stress of a cycle counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MeanStress {
    /// It does not count: as-welded steel, whose residual stress is at yield wherever the mean lies.
    Ignored,
    /// Goodman: the amplitude is divided by `1 - mean / strength`.
    Goodman {
        /// Tensile strength \[MPa\].
        strength: f64,
    },
    /// Gerber: the amplitude is divided by `1 - (mean / strength)^2`; a compressive mean does not count.
    Gerber {
        /// Tensile strength \[MPa\].
        strength: f64,
    },
    /// Walker: `maximum^(1 - exponent) amplitude^exponent`; 0.5 is the rule of Smith, Watson and Topper. A cycle without
    /// tension does no damage.
    Walker {
        /// Exponent, 0 to 1 \[1\]; 1 ignores the mean.
        exponent: f64,
    },
}

impl MeanStress {
    /// Returns the range of the fully reversed cycle that does the damage of a cycle with a range and a mean \[MPa\];
    /// infinite where the mean reaches the strength.
    pub fn reversed(self, range: f64, mean: f64) -> f64 {
        match self {
            Self::Ignored => range,
            Self::Goodman { strength } => divided(range, 1.0 - mean / strength),
            Self::Gerber { strength } => {
                let share = mean.max(0.0) / strength;
                divided(range, 1.0 - share * share)
            }
            Self::Walker { exponent } => {
                let (amplitude, maximum) = (0.5 * range, mean + 0.5 * range);
                if maximum <= 0.0 {
                    return 0.0;
                }
                2.0 * libm::pow(maximum, 1.0 - exponent) * libm::pow(amplitude, exponent)
            }
        }
    }
}

fn divided(range: f64, by: f64) -> f64 {
    if by > 0.0 { range / by } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(is: f64, expected: f64) {
        assert!((is - expected).abs() < 1e-9, "{is} {expected}");
    }

    #[test]
    fn rules_agree_with_a_calculation_by_hand() {
        let strength = 500.0;
        let reversed = |rule: MeanStress, range, mean| rule.reversed(range, mean);
        // amplitude 50, mean 100: 50 / 0.8, 50 / 0.96, sqrt(150 * 50)
        near(reversed(MeanStress::Ignored, 100.0, 100.0), 100.0);
        near(
            reversed(MeanStress::Goodman { strength }, 100.0, 100.0),
            125.0,
        );
        let gerber = reversed(MeanStress::Gerber { strength }, 100.0, 100.0);
        assert!((gerber - 100.0 / 0.96).abs() < 1e-12);
        let swt = MeanStress::Walker { exponent: 0.5 };
        assert!((reversed(swt, 100.0, 100.0) - 2.0 * 7500_f64.sqrt()).abs() < 1e-9);
        // a fully reversed cycle is itself, compression helps or does not count
        for rule in [
            MeanStress::Goodman { strength },
            MeanStress::Gerber { strength },
            swt,
        ] {
            assert!((reversed(rule, 80.0, 0.0) - 80.0).abs() < 1e-9);
            assert!(reversed(rule, 80.0, -50.0) <= 80.0);
        }
        near(reversed(swt, 80.0, -50.0), 0.0);
        assert!(reversed(MeanStress::Goodman { strength }, 10.0, 500.0).is_infinite());
        let whole = MeanStress::Walker { exponent: 1.0 };
        assert!((reversed(whole, 80.0, 30.0) - 80.0).abs() < 1e-9);
    }
}
