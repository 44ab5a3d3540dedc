//! Net torque at the crank as a function of the counterweight, and the counterweight that lowers it most.
//!
//! The crank's motion is prescribed, so that the torque is that of everything else plus that of the counterweight: with
//! moment `M`, phase `tau`, pin angle `p` and sense of rotation `s`, `T = T_0 + s M cos(p + s tau)`. It is linear in `M cos
//! tau` and `M sin tau`.
use std::{f64::consts::TAU, ops::RangeInclusive};

/// Moment and phase of a counterweight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Counterweight {
    pub(super) moment_n_m: f64,
    /// Angle by which the counterweight leads the crank pin \[deg\].
    pub(super) phase_deg: f64,
}

/// What the counterweight is to lower.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Goal {
    /// Root mean square of the torque over the time of operation: the heat of the motor's windings.
    RootMeanSquare,
    /// Largest magnitude of the torque: the load of the gears.
    Peak,
}

/// Counterweights among which the best is sought.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Bounds {
    pub(super) moment_n_m: RangeInclusive<f64>,
    pub(super) phase_deg: RangeInclusive<f64>,
    /// Moment of one position of the weights more [N m]; `None` where they can be anywhere.
    pub(super) step_n_m: Option<f64>,
}

impl Bounds {
    /// Returns whether a moment is one of the ends of those that are possible.
    pub(super) fn ends_at(&self, moment_n_m: f64) -> bool {
        let (low, high) = (*self.moment_n_m.start(), *self.moment_n_m.end());
        let near = |end: f64| (moment_n_m - end).abs() <= 1e-6 * high;
        near(low) || near(high)
    }
}

/// Torque over one revolution under one condition.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Revolution {
    /// Share of the time of operation.
    share: f64,
    /// Torque without the counterweight [N m].
    rest_n_m: Vec<f64>,
    /// Torque of a moment of 1 N m at phase 0, and at 90 deg.
    per_moment: Vec<[f64; 2]>,
    /// Angle of the pin that each sample stands for: half of those to its neighbours \[rad\].
    spans_rad: Vec<f64>,
}

impl Revolution {
    /// Separates a torque [N m] at angles of the crank pin \[rad\] into that of the counterweight with which it was simulated
    /// and the rest.
    pub(super) fn new(
        (pin_rad, torque_n_m): (&[f64], &[f64]),
        sense: f64,
        present: Counterweight,
        share: f64,
    ) -> Self {
        let per_moment: Vec<[f64; 2]> = pin_rad
            .iter()
            .map(|angle| [sense * libm::cos(*angle), -libm::sin(*angle)])
            .collect();
        let count = pin_rad.len();
        let ahead = |k: usize| match k + 1 {
            next if next < count => sense * (pin_rad[next] - pin_rad[k]),
            _ => TAU - sense * (pin_rad[k] - pin_rad[0]),
        };
        let spans = (0..count).map(|k| 0.5 * (ahead(k) + ahead((k + count - 1) % count)));
        let [along, across] = components(present);
        let both = torque_n_m.iter().zip(&per_moment);
        Self {
            share,
            rest_n_m: both
                .map(|(torque, [a, b])| torque - along * a - across * b)
                .collect(),
            per_moment,
            spans_rad: spans.collect(),
        }
    }

    /// Returns the work of a torque over the revolution \[J\], by the trapezoidal rule. The ledger of the simulation has the
    /// same to 0.2 %, but scatters with the steps of the integration too much for a derivative.
    pub(super) fn work_j(&self, torque_n_m: &[f64]) -> f64 {
        let both = torque_n_m.iter().zip(&self.spans_rad);
        both.map(|(torque, span)| torque * span).sum()
    }

    /// Returns the net torque with a counterweight [N m].
    pub(super) fn with(&self, weight: Counterweight) -> Vec<f64> {
        let [along, across] = components(weight);
        let both = self.rest_n_m.iter().zip(&self.per_moment);
        both.map(|(rest, [a, b])| rest + along * a + across * b)
            .collect()
    }

    /// Returns the torque of a counterweight alone [N m].
    pub(super) fn of_weight(&self, weight: Counterweight) -> Vec<f64> {
        let [along, across] = components(weight);
        let each = self.per_moment.iter();
        each.map(|[a, b]| along * a + across * b).collect()
    }
}

/// Returns the moment of a counterweight along the pin's direction and 90 deg ahead of it.
fn components(weight: Counterweight) -> [f64; 2] {
    let phase = weight.phase_deg.to_radians();
    [
        weight.moment_n_m * libm::cos(phase),
        weight.moment_n_m * libm::sin(phase),
    ]
}

impl Goal {
    /// Returns the name of the goal in results.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::RootMeanSquare => "root mean square",
            Self::Peak => "peak torque",
        }
    }

    /// Returns the value of the goal with a counterweight [N m].
    pub(super) fn value(self, revolutions: &[Revolution], weight: Counterweight) -> f64 {
        match self {
            Self::RootMeanSquare => {
                let squares = revolutions
                    .iter()
                    .map(|own| own.share * mean_square(&own.with(weight)));
                squares.sum::<f64>().sqrt()
            }
            Self::Peak => {
                let all = revolutions.iter().flat_map(|own| own.with(weight));
                all.fold(0.0, |most, torque| most.max(torque.abs()))
            }
        }
    }

    /// Returns the best moment at a phase, within bounds.
    fn moment_at(self, revolutions: &[Revolution], phase_deg: f64, bounds: &Bounds) -> f64 {
        let (low, high) = (*bounds.moment_n_m.start(), *bounds.moment_n_m.end());
        match self {
            Self::RootMeanSquare => {
                let unit = Counterweight {
                    moment_n_m: 1.0,
                    phase_deg,
                };
                let (mut across, mut along) = (0.0, 0.0);
                for own in revolutions {
                    let count = own.rest_n_m.len().max(1) as f64;
                    for (rest, weight) in own.rest_n_m.iter().zip(own.of_weight(unit)) {
                        across += own.share * rest * weight / count;
                        along += own.share * weight * weight / count;
                    }
                }
                (-across / along).clamp(low, high)
            }
            Self::Peak => minimum(low..=high, |moment_n_m| {
                let weight = Counterweight {
                    moment_n_m,
                    phase_deg,
                };
                self.value(revolutions, weight)
            }),
        }
    }

    /// Returns the counterweight with the least value of the goal within bounds: at each phase the moment is that of least
    /// squares, or the minimum of a convex function; the phase is searched.
    pub(super) fn best(self, revolutions: &[Revolution], bounds: &Bounds) -> Counterweight {
        let at = |phase_deg: f64| Counterweight {
            moment_n_m: self.moment_at(revolutions, phase_deg, bounds),
            phase_deg,
        };
        let value = |phase_deg: f64| self.value(revolutions, at(phase_deg));
        let (low, high) = (*bounds.phase_deg.start(), *bounds.phase_deg.end());
        let step = (high - low) / f64::from(PHASES);
        let phases = (0..=PHASES).map(|k| low + step * f64::from(k));
        let first = phases.min_by(|a, b| value(*a).total_cmp(&value(*b)));
        let first = first.unwrap_or(low);
        let around = (first - step).max(low)..=(first + step).min(high);
        self.stepped(revolutions, bounds, at(minimum(around, value)))
    }

    /// Returns the better of the two positions of the weights beside an optimum, counted from the least moment.
    fn stepped(
        self,
        revolutions: &[Revolution],
        bounds: &Bounds,
        best: Counterweight,
    ) -> Counterweight {
        let Some(step) = bounds.step_n_m else {
            return best;
        };
        let (low, high) = (*bounds.moment_n_m.start(), *bounds.moment_n_m.end());
        let below = ((best.moment_n_m - low) / step).floor();
        let beside = [below, below + 1.0].map(|count| Counterweight {
            moment_n_m: low + count * step,
            ..best
        });
        let inside = beside.into_iter().filter(|own| own.moment_n_m <= high);
        let value = |own: &Counterweight| self.value(revolutions, *own);
        inside
            .min_by(|a, b| value(a).total_cmp(&value(b)))
            .unwrap_or(best)
    }
}

/// Number of intervals into which the range of phases is divided before its best part is searched.
const PHASES: u32 = 72;

/// Returns the minimum of a function that has one in an interval, by golden section.
fn minimum(within: RangeInclusive<f64>, of: impl Fn(f64) -> f64) -> f64 {
    const RATIO: f64 = 0.618_033_988_749_894_8;
    let (mut low, mut high) = within.into_inner();
    let scale = low.abs().max(high.abs());
    let mut inner = [high - RATIO * (high - low), low + RATIO * (high - low)];
    let mut values = inner.map(&of);
    while high - low > 1e-9 * scale {
        if values[0] <= values[1] {
            high = inner[1];
            inner = [high - RATIO * (high - low), inner[0]];
            values = [of(inner[0]), values[0]];
        } else {
            low = inner[0];
            inner = [inner[1], low + RATIO * (high - low)];
            values = [values[1], of(inner[1])];
        }
    }
    0.5 * (low + high)
}

/// Returns the mean of the squares of values.
pub(super) fn mean_square(values: &[f64]) -> f64 {
    values.iter().map(|x| x * x).sum::<f64>() / values.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the angles of a pin that turns clockwise from 87 deg.
    fn pin_rad() -> Vec<f64> {
        let each = (0..720).map(|k| (87.0 - 0.5 * f64::from(k)).to_radians());
        each.collect()
    }

    /// Builds a revolution with harmonics that no counterweight balances, and a first one that the given one does.
    fn revolution(balanced_by: Counterweight, share: f64) -> Revolution {
        let turn: Vec<f64> = (0..720).map(|k| 0.5 * f64::from(k)).collect();
        let pin = pin_rad();
        let nothing = Counterweight {
            moment_n_m: 0.0,
            phase_deg: 0.0,
        };
        let weight = Revolution::new((&pin, &vec![0.0; 720]), -1.0, nothing, 1.0);
        let weight = weight.of_weight(balanced_by);
        let torque = turn.iter().zip(weight).map(|(turn, weight)| {
            let angle = turn.to_radians();
            14e3 + 9e3 * (2.0 * angle + 0.3).cos() + 4e3 * (3.0 * angle).sin() - weight
        });
        Revolution::new((&pin, &torque.collect::<Vec<_>>()), -1.0, nothing, share)
    }

    const FREE: Bounds = Bounds {
        moment_n_m: 0.0..=2e5,
        phase_deg: -20.0..=20.0,
        step_n_m: None,
    };

    #[test]
    fn the_least_root_mean_square_balances_the_first_harmonic() {
        let hidden = Counterweight {
            moment_n_m: 1.05e5,
            phase_deg: -3.7,
        };
        let found = Goal::RootMeanSquare.best(&[revolution(hidden, 1.0)], &FREE);
        assert!((found.moment_n_m - 1.05e5).abs() < 1.0, "{found:?}");
        assert!((found.phase_deg + 3.7).abs() < 1e-3, "{found:?}");
        // of a mix the weighted mean of what each condition needs
        let other = Counterweight {
            moment_n_m: 0.95e5,
            ..hidden
        };
        let mix = [revolution(hidden, 0.75), revolution(other, 0.25)];
        let found = Goal::RootMeanSquare.best(&mix, &FREE);
        assert!((found.moment_n_m - 1.025e5).abs() < 1.0, "{found:?}");
    }

    /// Checks both goals against a grid of all counterweights, with a fixed and a free phase, in and at the bounds.
    #[test]
    fn nothing_on_a_grid_is_better() {
        let hidden = Counterweight {
            moment_n_m: 1.05e5,
            phase_deg: -3.7,
        };
        let revolutions = [revolution(hidden, 1.0)];
        let fixed = Bounds {
            phase_deg: 0.0..=0.0,
            ..FREE
        };
        let narrow = Bounds {
            moment_n_m: 1.2e5..=1.5e5,
            phase_deg: 2.0..=8.0,
            ..FREE
        };
        for goal in [Goal::RootMeanSquare, Goal::Peak] {
            for bounds in [&FREE, &fixed, &narrow] {
                let best = goal.best(&revolutions, bounds);
                let found = goal.value(&revolutions, best);
                let grid = |within: &RangeInclusive<f64>, k: i32| {
                    within.start() + (within.end() - within.start()) * f64::from(k) / 100.0
                };
                for k in 0..=100 {
                    for i in 0..=100 {
                        let weight = Counterweight {
                            moment_n_m: grid(&bounds.moment_n_m, k),
                            phase_deg: grid(&bounds.phase_deg, i),
                        };
                        let other = goal.value(&revolutions, weight);
                        assert!(
                            found <= other * (1.0 + 1e-9),
                            "{goal:?} {best:?} {weight:?}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn weights_take_one_of_their_positions() {
        let hidden = Counterweight {
            moment_n_m: 1.05e5,
            phase_deg: 0.0,
        };
        let bounds = Bounds {
            step_n_m: Some(8e3),
            moment_n_m: 0.9e5..=1.3e5,
            phase_deg: 0.0..=0.0,
        };
        let found = Goal::RootMeanSquare.best(&[revolution(hidden, 1.0)], &bounds);
        assert!((found.moment_n_m - 1.06e5).abs() < 1e-6, "{found:?}");
    }

    #[test]
    fn a_counterweight_that_is_added_to_the_rest_gives_the_torque() {
        let weight = Counterweight {
            moment_n_m: 1.1e5,
            phase_deg: 4.0,
        };
        let own = revolution(weight, 1.0);
        let pin = pin_rad();
        let again = Revolution::new((&pin, &own.with(weight)), -1.0, weight, 1.0);
        for (a, b) in again.rest_n_m.iter().zip(&own.rest_n_m) {
            assert!((a - b).abs() < 1e-9);
        }
    }
}
