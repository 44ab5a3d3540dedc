//! Search for the end of one side of a profile likelihood.
//!
//! The square root of the rise of a quadratic is linear in the distance, so the next point is where that line
//! would cross the wanted rise; a bracket is narrowed until the rise is close enough. No simulations are run
//! here.
use super::answer::IntervalEnd;

/// Rise of `-2 ln L` at the ends of a 95 % interval of one unknown.
pub(super) const RISE: f64 = 3.84;
/// Relative tolerance on the rise of a profile within which the end of its side counts as found.
pub(super) const NEAR: f64 = 0.3;
/// Maximum distance between successive points of a profile, outwards from the estimate (scaled coordinate).
const LONGEST: f64 = 1.0;
/// Maximum number of points computed on one side of a profile.
const MOST: usize = 12;

/// Point of a profile likelihood, at which one unknown is held and all other variables are refitted.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ProfilePoint {
    /// Value at which the unknown is held (scaled coordinate).
    pub(super) at: f64,
    /// Cost of the refit with the unknown held at that value.
    pub(super) cost: f64,
    /// Values of all variables of the fit at the profile point.
    pub(super) x: Vec<f64>,
}

/// Side of an unknown's profile likelihood, above or below the estimate.
#[derive(Clone, Debug)]
pub(super) struct Side {
    /// Index of the unknown whose profile this is.
    pub(super) unknown: usize,
    /// Direction of the side from the estimate: 1 for the upper side, -1 for the lower side.
    pub(super) sign: f64,
    /// Search bound of the unknown on this side (scaled coordinate).
    pub(super) bound: f64,
    /// Distance from the estimate at which the quadratic approximation predicts the end of the side.
    pub(super) predicted: f64,
    /// Computed points of the profile on this side.
    pub(super) marks: Vec<ProfilePoint>,
    /// Value of the unknown nearest to the estimate at which no simulation completes, if any.
    wall: Option<f64>,
    looks: usize,
}

/// Next step of the search for the end of a profile's side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum ProfileStep {
    /// Compute the profile at this value (scaled coordinate).
    Look(f64),
    /// The side has ended: type of the end, and the value of the unknown there (scaled coordinate).
    Over(IntervalEnd, f64),
}

impl Side {
    pub(super) const fn new(unknown: usize, sign: f64, bound: f64, predicted: f64) -> Self {
        Self {
            unknown,
            sign,
            bound,
            predicted,
            marks: Vec::new(),
            wall: None,
            looks: 0,
        }
    }

    /// Adds the result of a computed profile point to the side; `None` where no simulation completed.
    pub(super) fn add_result(&mut self, at: f64, found: Option<(f64, Vec<f64>)>) {
        self.looks += 1;
        if let Some((cost, x)) = found {
            self.marks.push(ProfilePoint { at, cost, x });
        } else if self.wall.is_none_or(|wall| self.sign * (at - wall) < 0.0) {
            self.wall = Some(at);
        }
    }

    /// Adds a profile point from another fit if it lies on this side and sufficiently far from the estimate.
    /// A fit in another local minimum with nearly the same value of the unknown gives no information on the
    /// profile.
    pub(super) fn add_known_point(&mut self, from: f64, cost: f64, x: &[f64]) {
        let at = x[self.unknown];
        if self.sign * (at - from) > 0.5 * self.predicted.min(LONGEST) {
            let x = x.to_vec();
            self.marks.push(ProfilePoint { at, cost, x });
        }
    }

    /// Returns the next step, from an estimate at `from` with cost `best`; `rise` is the rise of the cost
    /// that ends a side.
    pub(super) fn next(&self, from: f64, best: f64, rise: f64) -> ProfileStep {
        let there = |distance: f64| from + self.sign * distance;
        let away = |at: f64| self.sign * (at - from);
        let span = away(self.bound);
        if span <= 1e-9 {
            return ProfileStep::Over(IntervalEnd::Bound, self.bound);
        }
        let mut seen: Vec<(f64, f64)> = self
            .marks
            .iter()
            .map(|mark| (away(mark.at), (mark.cost - best).max(0.0)))
            .filter(|(distance, _)| *distance > 0.0)
            .collect();
        seen.sort_by(|a, b| a.0.total_cmp(&b.0));
        // a profile with several valleys ends behind the last one
        let inside = seen.iter().rposition(|(_, own)| *own < rise);
        let outside = seen.get(inside.map_or(0, |k| k + 1)).copied();
        let inside = inside.map_or((0.0, 0.0), |k| seen[k]);
        if let Some(outside) = outside {
            let root = |own: f64| own.max(0.0).sqrt();
            let share = (root(rise) - root(inside.1)) / (root(outside.1) - root(inside.1));
            let width = outside.0 - inside.0;
            let near = outside.1 <= (1.0 + NEAR) * rise
                || inside.1 >= (1.0 - NEAR) * rise
                || width <= 0.1 * outside.0
                || self.looks >= MOST;
            return if near {
                ProfileStep::Over(IntervalEnd::Rises, there(inside.0 + share * width))
            } else {
                ProfileStep::Look(there(inside.0 + share.clamp(0.15, 0.85) * width))
            };
        }
        if inside.1 >= (1.0 - NEAR) * rise {
            // straight on to where it would cross
            let crossing = inside.0 * (rise / inside.1).sqrt();
            if crossing < span {
                return ProfileStep::Over(IntervalEnd::Rises, there(crossing));
            }
        }
        if inside.0 >= span * (1.0 - 1e-9) {
            return ProfileStep::Over(IntervalEnd::Bound, self.bound);
        }
        let wall = self.wall.map(away).filter(|wall| *wall > inside.0);
        if self.looks >= MOST {
            let end = if wall.is_some() {
                IntervalEnd::Fails
            } else {
                IntervalEnd::GivenUp
            };
            return ProfileStep::Over(end, there(inside.0));
        }
        if let Some(wall) = wall {
            return if wall - inside.0 <= 0.1 * wall.max(0.1) {
                ProfileStep::Over(IntervalEnd::Fails, there(inside.0))
            } else {
                ProfileStep::Look(there(f64::midpoint(inside.0, wall)))
            };
        }
        let growth = 1.05 * (rise / inside.1.max(1e-3 * rise)).sqrt();
        let mut distance = inside.0 * growth.clamp(1.3, 3.0);
        if inside.0 < 0.5 * self.predicted {
            distance = distance.max(self.predicted);
        }
        ProfileStep::Look(there(distance.min(inside.0 + LONGEST).min(span)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Follows a profile to its end; returns the type of end, its position and the number of computed points.
    fn follow(
        bound: f64,
        predicted: f64,
        profile: impl Fn(f64) -> Option<f64>,
    ) -> (IntervalEnd, f64, usize) {
        let mut side = Side::new(0, 1.0, bound, predicted);
        for looks in 0..50 {
            match side.next(0.0, 10.0, RISE) {
                ProfileStep::Over(end, at) => return (end, at, looks),
                ProfileStep::Look(at) => {
                    let found = profile(at).map(|rise| (10.0 + rise, Vec::new()));
                    side.add_result(at, found);
                }
            }
        }
        panic!("it does not end");
    }

    #[test]
    fn a_quadratic_ends_where_it_was_predicted() {
        let half = 0.3;
        let (end, at, looks) = follow(4.0, half, |d| Some(RISE * (d / half).powi(2)));
        assert_eq!((end, looks), (IntervalEnd::Rises, 1));
        assert!((at - half).abs() < 1e-12, "{at}");
    }

    /// Checks that the end of a side is found within the tolerance and few points, however wrong its
    /// predicted distance is.
    #[test]
    fn a_wrong_prediction_costs_a_few_looks() {
        for (predicted, half) in [(0.001, 0.3), (0.9, 0.004), (2.0, 3.3)] {
            let profile = |d: f64| Some(RISE * (d / half).powi(2) * (1.0 + 0.3 * d));
            let (end, at, looks) = follow(4.0, predicted, profile);
            assert_eq!(end, IntervalEnd::Rises);
            let rise = profile(at).expect("finite") / RISE;
            assert!((rise - 1.0).abs() < 0.1, "{rise} at {at}");
            assert!(looks <= 8, "{looks}");
        }
    }

    #[test]
    fn what_never_rises_ends_at_the_bound_and_what_fails_at_a_wall() {
        let (end, at, _) = follow(4.0, 50.0, |d| Some(0.1 * d));
        assert_eq!((end, at), (IntervalEnd::Bound, 4.0));
        let (end, at, _) = follow(4.0, 50.0, |d| (d < 1.7).then_some(0.2 * d));
        assert_eq!(end, IntervalEnd::Fails);
        assert!((1.4..1.7).contains(&at), "{at}");
        // at its bound already
        assert_eq!(follow(0.0, 0.1, |_| None), (IntervalEnd::Bound, 0.0, 0));
        // nothing completes anywhere
        assert_eq!(follow(4.0, 0.5, |_| None).0, IntervalEnd::Fails);
    }

    /// Checks that a fit in another local minimum with nearly the same value of the unknown does not end the
    /// side, and that one with a distant value is used as a point of the profile.
    #[test]
    fn another_valley_counts_where_it_is_another_value() {
        let mut side = Side::new(0, 1.0, 4.0, 50.0);
        side.add_known_point(0.0, 10.0 + 0.9 * RISE, &[1e-6]);
        assert_eq!(side.next(0.0, 10.0, RISE), ProfileStep::Look(LONGEST));
        side.add_result(0.3, Some((10.0 + 2.0 * RISE, vec![0.3])));
        side.add_known_point(0.0, 10.0 + 0.4 * RISE, &[2.5]);
        let next = side.next(0.0, 10.0, RISE);
        assert!(
            matches!(next, ProfileStep::Look(at) if at > 2.5),
            "{next:?}"
        );
    }

    /// Checks that the end of a profile that is flat up to a step is enclosed between two points.
    #[test]
    fn a_cliff_is_bracketed() {
        let (end, at, _) = follow(4.0, 50.0, |d| Some(if d < 2.6 { 0.5 } else { 400.0 }));
        assert_eq!(end, IntervalEnd::Rises);
        assert!((2.2..3.0).contains(&at), "{at}");
    }
}
