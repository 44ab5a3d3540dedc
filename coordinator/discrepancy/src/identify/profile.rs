//! Search for the end of one side of a profile likelihood.
//!
//! The square root of the rise of a quadratic is linear in the distance, so the next point is where that line
//! would cross the wanted rise; a bracket is narrowed until the rise is close enough. No simulations are run
//! here.
use super::answer::End;

/// The rise of `-2 ln L` at the ends of a 95 % interval of one unknown.
pub(super) const RISE: f64 = 3.84;
/// Relative tolerance on the wanted rise at which a side ends.
pub(super) const NEAR: f64 = 0.3;
/// Longest step outwards (scaled coordinate).
const LONGEST: f64 = 1.0;
/// Maximum number of points on a side.
const MOST: usize = 12;

/// A point of a profile.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mark {
    /// Value at which the unknown was held (scaled coordinate).
    pub(super) at: f64,
    /// Cost at that value, with all other variables refitted.
    pub(super) cost: f64,
    /// All variables at the point.
    pub(super) x: Vec<f64>,
}

/// One side of the profile of an unknown.
#[derive(Clone, Debug)]
pub(super) struct Side {
    /// Index of the unknown.
    pub(super) unknown: usize,
    /// 1 for the upper side, -1 for the lower side.
    pub(super) sign: f64,
    /// The bound of the search on this side (coordinate).
    pub(super) bound: f64,
    /// Distance of the end as predicted by the quadratic approximation.
    pub(super) predicted: f64,
    /// Points computed on this side.
    pub(super) marks: Vec<Mark>,
    /// Nearest value at which no simulation completes.
    wall: Option<f64>,
    looks: usize,
}

/// Next step on a side of a profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Next {
    /// Compute the profile at this value (scaled coordinate).
    Look(f64),
    /// The side ends in this way, at this value (scaled coordinate).
    Over(End, f64),
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

    /// Adds the result of a computed point; `None` where no simulation completed.
    pub(super) fn absorb(&mut self, at: f64, found: Option<(f64, Vec<f64>)>) {
        self.looks += 1;
        if let Some((cost, x)) = found {
            self.marks.push(Mark { at, cost, x });
        } else if self.wall.is_none_or(|wall| self.sign * (at - wall) < 0.0) {
            self.wall = Some(at);
        }
    }

    /// Adds a point from another fit if it lies on this side and sufficiently far from the estimate. A fit in
    /// another valley with nearly the same value of the unknown gives no information on the profile.
    pub(super) fn know(&mut self, from: f64, cost: f64, x: &[f64]) {
        let at = x[self.unknown];
        if self.sign * (at - from) > 0.5 * self.predicted.min(LONGEST) {
            let x = x.to_vec();
            self.marks.push(Mark { at, cost, x });
        }
    }

    /// Returns the next step, from an estimate at `from` with cost `best`; `rise` is the rise of the cost
    /// that ends a side.
    pub(super) fn next(&self, from: f64, best: f64, rise: f64) -> Next {
        let there = |distance: f64| from + self.sign * distance;
        let away = |at: f64| self.sign * (at - from);
        let span = away(self.bound);
        if span <= 1e-9 {
            return Next::Over(End::Bound, self.bound);
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
                Next::Over(End::Rises, there(inside.0 + share * width))
            } else {
                Next::Look(there(inside.0 + share.clamp(0.15, 0.85) * width))
            };
        }
        if inside.1 >= (1.0 - NEAR) * rise {
            // straight on to where it would cross
            let crossing = inside.0 * (rise / inside.1).sqrt();
            if crossing < span {
                return Next::Over(End::Rises, there(crossing));
            }
        }
        if inside.0 >= span * (1.0 - 1e-9) {
            return Next::Over(End::Bound, self.bound);
        }
        let wall = self.wall.map(away).filter(|wall| *wall > inside.0);
        if self.looks >= MOST {
            let end = if wall.is_some() {
                End::Fails
            } else {
                End::GivenUp
            };
            return Next::Over(end, there(inside.0));
        }
        if let Some(wall) = wall {
            return if wall - inside.0 <= 0.1 * wall.max(0.1) {
                Next::Over(End::Fails, there(inside.0))
            } else {
                Next::Look(there(f64::midpoint(inside.0, wall)))
            };
        }
        let growth = 1.05 * (rise / inside.1.max(1e-3 * rise)).sqrt();
        let mut distance = inside.0 * growth.clamp(1.3, 3.0);
        if inside.0 < 0.5 * self.predicted {
            distance = distance.max(self.predicted);
        }
        Next::Look(there(distance.min(inside.0 + LONGEST).min(span)))
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
    ) -> (End, f64, usize) {
        let mut side = Side::new(0, 1.0, bound, predicted);
        for looks in 0..50 {
            match side.next(0.0, 10.0, RISE) {
                Next::Over(end, at) => return (end, at, looks),
                Next::Look(at) => {
                    let found = profile(at).map(|rise| (10.0 + rise, Vec::new()));
                    side.absorb(at, found);
                }
            }
        }
        panic!("it does not end");
    }

    #[test]
    fn a_quadratic_ends_where_it_was_predicted() {
        let half = 0.3;
        let (end, at, looks) = follow(4.0, half, |d| Some(RISE * (d / half).powi(2)));
        assert_eq!((end, looks), (End::Rises, 1));
        assert!((at - half).abs() < 1e-12, "{at}");
    }

    /// Checks that the crossing is found within the tolerance and few points, however wrong the prediction
    /// is.
    #[test]
    fn a_wrong_prediction_costs_a_few_looks() {
        for (predicted, half) in [(0.001, 0.3), (0.9, 0.004), (2.0, 3.3)] {
            let profile = |d: f64| Some(RISE * (d / half).powi(2) * (1.0 + 0.3 * d));
            let (end, at, looks) = follow(4.0, predicted, profile);
            assert_eq!(end, End::Rises);
            let rise = profile(at).expect("finite") / RISE;
            assert!((rise - 1.0).abs() < 0.1, "{rise} at {at}");
            assert!(looks <= 8, "{looks}");
        }
    }

    #[test]
    fn what_never_rises_ends_at_the_bound_and_what_fails_at_a_wall() {
        let (end, at, _) = follow(4.0, 50.0, |d| Some(0.1 * d));
        assert_eq!((end, at), (End::Bound, 4.0));
        let (end, at, _) = follow(4.0, 50.0, |d| (d < 1.7).then_some(0.2 * d));
        assert_eq!(end, End::Fails);
        assert!((1.4..1.7).contains(&at), "{at}");
        // at its bound already
        assert_eq!(follow(0.0, 0.1, |_| None), (End::Bound, 0.0, 0));
        // nothing completes anywhere
        assert_eq!(follow(4.0, 0.5, |_| None).0, End::Fails);
    }

    /// Checks that a fit in another valley with nearly the same value of the unknown does not end the side,
    /// and that one with a distant value is used as a point of the profile.
    #[test]
    fn another_valley_counts_where_it_is_another_value() {
        let mut side = Side::new(0, 1.0, 4.0, 50.0);
        side.know(0.0, 10.0 + 0.9 * RISE, &[1e-6]);
        assert_eq!(side.next(0.0, 10.0, RISE), Next::Look(LONGEST));
        side.absorb(0.3, Some((10.0 + 2.0 * RISE, vec![0.3])));
        side.know(0.0, 10.0 + 0.4 * RISE, &[2.5]);
        let next = side.next(0.0, 10.0, RISE);
        assert!(matches!(next, Next::Look(at) if at > 2.5), "{next:?}");
    }

    /// Checks that the end of a profile that is flat up to a step is bracketed.
    #[test]
    fn a_cliff_is_bracketed() {
        let (end, at, _) = follow(4.0, 50.0, |d| Some(if d < 2.6 { 0.5 } else { 400.0 }));
        assert_eq!(end, End::Rises);
        assert!((2.2..3.0).contains(&at), "{at}");
    }
}
