//! Arithmetic of axes: a range of values, linear or logarithmic, and suitable ticks.

use crate::number::{fixed, range, superscript};

/// Tick on an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// Value at the tick.
    pub value: f64,
    /// Text of the label; empty for a minor tick.
    pub label: String,
}

/// Spacing of values along an axis: linear, logarithmic, or one turn in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Spacing {
    Linear { step: f64 },
    Logarithmic,
    Turn,
}

/// Range and spacing of one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisScale {
    low: f64,
    high: f64,
    spacing: Spacing,
}

/// Returns the step (1, 2 or 5 times a power of ten) that divides a span into about `parts`.
fn round_step(span: f64, parts: f64) -> f64 {
    let raw = span / parts;
    let power = 10_f64.powf(raw.log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|factor| factor * power)
        .find(|&step| step >= raw * 0.999)
        .unwrap_or(10.0 * power)
}

impl AxisScale {
    /// Creates the scale of one turn: 0 to 360 degrees, a label every 60, a tick every 30.
    pub const fn turn() -> Self {
        Self {
            low: 0.0,
            high: 360.0,
            spacing: Spacing::Turn,
        }
    }

    /// Creates a linear scale over all finite values with a small margin; `parts` is the desired number of
    /// steps. Without any finite value: 0 to 1.
    pub fn linear(values: impl IntoIterator<Item = f64>, parts: f64) -> Self {
        let (low, high) = range(values).unwrap_or((0.0, 1.0));
        // a constant curve still needs room around it
        let margin = if high - low > 1e-9 * high.abs().max(low.abs()).max(1e-9) {
            0.0
        } else {
            0.5 * high.abs().max(1.0)
        };
        let (low, high) = (low - margin, high + margin);
        let step = round_step(high - low, parts);
        let air = 0.05 * (high - low);
        Self {
            low: low - air,
            high: high + air,
            spacing: Spacing::Linear { step },
        }
    }

    /// Creates a linear scale symmetric about zero over all finite values, with a tick at zero and at least
    /// one on either side. Without any finite value: -1 to 1.
    pub fn symmetric(values: impl IntoIterator<Item = f64>) -> Self {
        let largest = range(values.into_iter().map(f64::abs)).map_or(1.0, |(_, high)| high);
        let largest = if largest > 0.0 { largest } else { 1.0 };
        // the roundest step that still fits between zero and the largest value
        let step = [5.0, 2.0, 1.0]
            .map(|factor| factor * 10_f64.powf(largest.log10().floor()))
            .into_iter()
            .find(|&step| step <= largest * 1.001)
            .unwrap_or(largest);
        Self {
            low: -1.05 * largest,
            high: 1.05 * largest,
            spacing: Spacing::Linear { step },
        }
    }

    /// Creates a linear scale between two given ends; `parts` is the desired number of steps.
    pub fn between(low: f64, high: f64, parts: f64) -> Self {
        Self {
            low,
            high,
            spacing: Spacing::Linear {
                step: round_step((high - low).abs().max(f64::MIN_POSITIVE), parts),
            },
        }
    }

    /// Creates a logarithmic scale over all positive finite values with a small margin; 1 to 10 without any.
    pub fn logarithmic(values: impl IntoIterator<Item = f64>) -> Self {
        let positive = values.into_iter().filter(|&value| value > 0.0);
        let (low, high) = range(positive).unwrap_or((1.0, 10.0));
        let air = 0.04 * (high / low).log10().max(0.5);
        Self {
            low: low / 10_f64.powf(air),
            high: high * 10_f64.powf(air),
            spacing: Spacing::Logarithmic,
        }
    }

    /// Creates a logarithmic scale between two given positive ends.
    pub const fn logarithmic_between(low: f64, high: f64) -> Self {
        Self {
            low,
            high,
            spacing: Spacing::Logarithmic,
        }
    }

    /// Returns the position of a value on the axis, 0 at the lower and 1 at the upper end, clamped so that
    /// curves stay in their frame. Not a number for values without a position on the scale.
    pub fn share(&self, value: f64) -> f64 {
        let share = match self.spacing {
            Spacing::Linear { .. } | Spacing::Turn => (value - self.low) / (self.high - self.low),
            Spacing::Logarithmic if value > 0.0 => {
                (value / self.low).ln() / (self.high / self.low).ln()
            }
            Spacing::Logarithmic => f64::NAN,
        };
        share.clamp(0.0, 1.0)
    }

    /// Returns the values at the lower and the upper end of the axis.
    pub const fn ends(&self) -> (f64, f64) {
        (self.low, self.high)
    }

    /// Returns the ticks from the lower to the upper end.
    pub fn ticks(&self) -> Vec<Tick> {
        match self.spacing {
            Spacing::Turn => (0..=12)
                .map(|index| Tick {
                    value: 30.0 * f64::from(index),
                    label: if index % 2 == 0 {
                        (30 * index).to_string()
                    } else {
                        String::new()
                    },
                })
                .collect(),
            Spacing::Linear { step } => self.linear_ticks(step),
            Spacing::Logarithmic => self.logarithmic_ticks(),
        }
    }

    fn linear_ticks(&self, step: f64) -> Vec<Tick> {
        let decimals = (0..6)
            .find(|&decimals: &usize| {
                let scaled = step * 10_f64.powi(i32::try_from(decimals).unwrap_or(0));
                (scaled - scaled.round()).abs() < 1e-6 * scaled
            })
            .unwrap_or(6);
        let first = (self.low / step - 1e-6).ceil();
        (0..64)
            .map(|index| (first + f64::from(index)) * step)
            .take_while(|&value| value <= self.high + 1e-6 * step)
            .map(|value| Tick {
                value,
                label: fixed(value, decimals),
            })
            .collect()
    }

    fn logarithmic_ticks(&self) -> Vec<Tick> {
        let decades = (self.high / self.low).log10();
        // few decades: label 2 and 5 too; many: leave decades out
        let every = if decades > 6.5 { 2 } else { 1 };
        #[expect(
            clippy::cast_possible_truncation,
            reason = "exponents of finite doubles are below 400"
        )]
        let (first, last) = (
            self.low.log10().floor() as i32,
            self.high.log10().ceil() as i32,
        );
        let mut ticks = Vec::new();
        for exponent in first..=last {
            for digit in 1..10 {
                let value = f64::from(digit) * 10_f64.powi(exponent);
                if value < self.low || value > self.high {
                    continue;
                }
                let labelled = match digit {
                    1 => exponent % every == 0,
                    2 | 5 => decades < 1.3,
                    _ => false,
                };
                if labelled {
                    ticks.push(Tick {
                        value,
                        label: power_label(digit, exponent),
                    });
                } else if decades < 4.5 || digit == 1 {
                    ticks.push(Tick {
                        value,
                        label: String::new(),
                    });
                }
            }
        }
        ticks
    }
}

/// Formats `digit * 10^exponent`: as a plain number near 1, as a power elsewhere.
fn power_label(digit: i32, exponent: i32) -> String {
    match exponent {
        0..=3 => fixed(f64::from(digit) * 10_f64.powi(exponent), 0),
        -2..0 => fixed(
            f64::from(digit) * 10_f64.powi(exponent),
            usize::try_from(-exponent).unwrap_or(0),
        ),
        _ if digit == 1 => format!("10{}", superscript(exponent)),
        _ => format!("{digit}·10{}", superscript(exponent)),
    }
}

#[cfg(test)]
mod tests {
    use super::AxisScale;

    fn labels(scale: AxisScale) -> Vec<String> {
        let ticks = scale.ticks().into_iter();
        ticks
            .map(|tick| tick.label)
            .filter(|label| !label.is_empty())
            .collect()
    }

    #[test]
    fn symmetric_scales_have_at_least_three_ticks() {
        assert_eq!(
            labels(AxisScale::symmetric([-0.9, 0.2])),
            ["\u{2212}0.5", "0.0", "0.5"]
        );
        assert_eq!(labels(AxisScale::symmetric([1.0])), ["\u{2212}1", "0", "1"]);
        assert_eq!(labels(AxisScale::symmetric([4.1])).len(), 5);
        assert_eq!(labels(AxisScale::symmetric([])).len(), 3);
    }

    #[test]
    fn linear_ticks_are_round_and_cover_the_values() {
        let scale = AxisScale::linear([-12.4, 37.0], 5.0);
        assert_eq!(labels(scale), ["−10", "0", "10", "20", "30"]);
        assert!(scale.share(-12.4) > 0.0 && scale.share(37.0) < 1.0);
    }

    #[test]
    fn degenerate_values_still_make_an_axis() {
        for values in [vec![], vec![3.0], vec![f64::NAN, 0.0], vec![-7.0, -7.0]] {
            let (low, high) = AxisScale::linear(values.clone(), 4.0).ends();
            assert!(low.is_finite() && low < high, "{values:?}");
            let (low, high) = AxisScale::logarithmic(values.clone()).ends();
            assert!(low > 0.0 && low < high, "{values:?}");
        }
    }

    #[test]
    fn logarithmic_ticks_are_decades() {
        assert_eq!(
            labels(AxisScale::logarithmic([0.6, 700.0])),
            ["1", "10", "100"]
        );
        assert_eq!(labels(AxisScale::logarithmic([3e7, 2e9])), ["10⁸", "10⁹"]);
        assert!(AxisScale::logarithmic([1.0, 10.0]).share(-1.0).is_nan());
    }

    #[test]
    fn a_turn_has_a_tick_every_30_and_a_label_every_60_degrees() {
        assert_eq!(AxisScale::turn().ticks().len(), 13);
        assert_eq!(
            labels(AxisScale::turn()),
            ["0", "60", "120", "180", "240", "300", "360"]
        );
    }
}
