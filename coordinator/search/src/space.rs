//! Search space: the box of the unknowns that a search varies.
//!
//! A point is given by a *coordinate* per axis, 0 at the start. On a logarithmic axis it counts decades,
//! `value = start * 10^x`; on a linear one, halves of the interval to search, `value = start + x * (upper -
//! lower) / 2`, so that a linear axis is about as long as the relevant part of a logarithmic one, and equal
//! steps suit both.
//!
//! Values are those of *all* unknowns of the case, in its order: an unknown that is fixed, switched off or
//! tied has no axis, and gets its value only here. This module does not know the meaning of an unknown.
use protocol::case::{BadUnknown, Scale, Unknown, check_unknowns};

/// Reason why a search space cannot be built from the unknowns.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SpaceError {
    /// The search space has no axis, because no unknown is searched.
    #[error("there is no unknown to search: each is fixed, tied or switched off")]
    Empty,
    /// An unknown has an invalid definition.
    #[error(transparent)]
    Unknown(#[from] BadUnknown),
    /// The number of starting values differs from the number of unknowns.
    #[error("the start has {found} values, but there are {expected} unknowns")]
    Length {
        /// Number of starting values given, one expected per unknown.
        found: usize,
        /// Number of unknowns of the case, and thus of the starting values expected.
        expected: usize,
    },
}

/// Axis of the search space: a searched unknown, and the part of its interval in which simulations usually
/// succeed.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Searched unknown; its start value has coordinate 0.
    pub unknown: Unknown,
    /// Index of the axis' unknown among all unknowns of the case.
    pub position: usize,
    /// Trust interval about the start, inside the bounds (coordinate): the part in which simulations usually
    /// succeed.
    pub trust: Interval,
}

/// Closed interval of coordinates on an axis of the search space.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Interval {
    /// Lower end of the interval (coordinate).
    pub from: f64,
    /// Upper end of the interval (coordinate).
    pub to: f64,
}

impl Interval {
    /// Returns the length of the interval (coordinate).
    pub fn length(self) -> f64 {
        self.to - self.from
    }

    /// Returns the coordinate nearest to `x` inside the interval.
    pub fn clamp(self, x: f64) -> f64 {
        x.max(self.from).min(self.to)
    }

    /// Returns the intersection with `other`; a single point if the intervals are disjoint.
    #[must_use]
    pub fn intersection(self, other: Self) -> Self {
        let from = other.clamp(self.from);
        Self {
            from,
            to: other.clamp(self.to).max(from),
        }
    }
}

impl Axis {
    fn new(unknown: &Unknown, position: usize) -> Self {
        let [from, to] = unknown.trust.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        let mut axis = Self {
            unknown: unknown.clone(),
            position,
            trust: Interval { from, to },
        };
        axis.trust = axis.trust.intersection(axis.interval());
        axis
    }

    /// Returns the interval of the axis between the bounds of its unknown (coordinate).
    pub fn interval(&self) -> Interval {
        Interval {
            from: self.coordinate(self.unknown.lower),
            to: self.coordinate(self.unknown.upper),
        }
    }

    /// Returns the unknown's value at a coordinate of the axis, clamped to the bounds.
    pub fn value(&self, x: f64) -> f64 {
        let value = match self.unknown.scale {
            Scale::Logarithmic => self.unknown.start * libm::exp10(x),
            Scale::Linear => self.unknown.start + self.half() * x,
        };
        value.clamp(self.unknown.lower, self.unknown.upper)
    }

    /// Returns the derivative of the unknown's value with respect to the coordinate, inside the bounds
    /// [declared unit].
    fn rate(&self, x: f64) -> f64 {
        match self.unknown.scale {
            Scale::Logarithmic => std::f64::consts::LN_10 * self.value(x),
            Scale::Linear => self.half(),
        }
    }

    /// Returns the coordinate on the axis for a value of its unknown.
    pub fn coordinate(&self, value: f64) -> f64 {
        match self.unknown.scale {
            Scale::Logarithmic => libm::log10(value / self.unknown.start),
            Scale::Linear => (value - self.unknown.start) / self.half(),
        }
    }

    /// Returns half the length of the unknown's interval, which is the unit of a linear axis [declared unit].
    fn half(&self) -> f64 {
        0.5 * (self.unknown.upper - self.unknown.lower)
    }
}

/// Search space: the box of the searched unknowns, at least one.
#[derive(Clone, Debug, PartialEq)]
pub struct Space {
    axes: Vec<Axis>,
    /// Source of each unknown's value, in the order of the case.
    value_sources: Vec<ValueSource>,
    /// Names of all unknowns, in the order of the case.
    names: Vec<String>,
    /// Starting points of the search (coordinate), best first.
    starts: Vec<Vec<f64>>,
}

/// Source of an unknown's value.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ValueSource {
    /// Constant value of an unknown without an axis.
    Constant(f64),
    /// Index of the axis that determines the unknown, and the ratio of the unknown's value to that of the
    /// axis; the ratio is 1 for the axis' own unknown.
    Axis(usize, f64),
}

impl Space {
    /// Creates the search space of a case's unknowns.
    ///
    /// # Errors
    /// If an unknown has an invalid definition, or no unknown is to be searched.
    pub fn new(unknowns: &[Unknown]) -> Result<Self, SpaceError> {
        check_unknowns(unknowns)?;
        let mut axes: Vec<Axis> = Vec::new();
        for (position, unknown) in unknowns.iter().enumerate() {
            if unknown.tie.is_none() && !unknown.fixed && !unknown.is_off() {
                axes.push(Axis::new(unknown, position));
            }
        }
        let giver = |position: usize| {
            let (leader, ratio) = leader(unknowns, position);
            match axes.iter().position(|axis| axis.position == leader) {
                Some(axis) => ValueSource::Axis(axis, ratio),
                None => ValueSource::Constant(unknowns[position].start),
            }
        };
        let givers = (0..unknowns.len()).map(giver).collect();
        if axes.is_empty() {
            return Err(SpaceError::Empty);
        }
        let names = unknowns.iter().map(|unknown| unknown.name.clone());
        Ok(Self {
            axes,
            value_sources: givers,
            names: names.collect(),
            starts: Vec::new(),
        })
    }

    /// Creates the search space of a case's unknowns with `start` in place of the case's starting values
    /// [declared units], one per unknown.
    ///
    /// # Errors
    /// As [`Space::new`]; if a value lies outside its unknown's bounds. The value of a tied unknown is
    /// ignored.
    pub fn with_start(unknowns: &[Unknown], start: &[f64]) -> Result<Self, SpaceError> {
        if unknowns.len() != start.len() {
            return Err(SpaceError::Length {
                found: start.len(),
                expected: unknowns.len(),
            });
        }
        check_unknowns(unknowns)?;
        let moved = unknowns.iter().enumerate().map(|(position, unknown)| {
            let (leader, ratio) = leader(unknowns, position);
            Unknown {
                start: ratio * start[leader],
                ..unknown.clone()
            }
        });
        Self::new(&moved.collect::<Vec<_>>())
    }

    /// Returns the space with starting points at these individuals: values of all unknowns [declared units],
    /// best first.
    #[must_use]
    pub fn with_starting_points(self, individuals: &[Vec<f64>]) -> Self {
        let starts = individuals
            .iter()
            .map(|values| self.point(values))
            .collect();
        Self { starts, ..self }
    }

    /// Returns the starting points that an initial population contains first (coordinates), best first.
    pub fn starts(&self) -> &[Vec<f64>] {
        &self.starts
    }

    /// Returns the start of a single-point search (coordinate): the best starting point, or the start of the
    /// case.
    pub fn origin(&self) -> Vec<f64> {
        let best = self.starts.first().cloned();
        best.unwrap_or_else(|| vec![0.0; self.dimension()])
    }

    /// Returns the axes, one per searched unknown.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// Returns the index of the axis of the unknown with a name; `None` if that unknown is not searched.
    pub fn position(&self, name: &str) -> Option<usize> {
        self.axes.iter().position(|axis| axis.unknown.name == name)
    }

    /// Returns the number of axes.
    pub fn dimension(&self) -> usize {
        self.axes.len()
    }

    /// Returns the values of all unknowns [declared units] at a point, which has one coordinate per axis.
    pub fn values(&self, point: &[f64]) -> Vec<f64> {
        let axes = self.axes.iter().zip(point);
        let own: Vec<f64> = axes.map(|(axis, &x)| axis.value(x)).collect();
        self.expand(&own)
    }

    /// Returns the values of all unknowns, given those of the searched unknowns [declared units].
    pub fn expand(&self, own: &[f64]) -> Vec<f64> {
        let value = |giver: &ValueSource| match *giver {
            ValueSource::Constant(value) => value,
            ValueSource::Axis(axis, ratio) => ratio * own[axis],
        };
        self.value_sources.iter().map(value).collect()
    }

    /// Returns the unknowns whose values change along an axis: their positions in the case, their names, and
    /// the derivative of each value with respect to the axis' coordinate at `x` [declared unit].
    pub fn rates(&self, axis: usize, x: f64) -> impl Iterator<Item = (usize, &str, f64)> {
        let own = self.axes[axis].rate(x);
        let givers = self.value_sources.iter().zip(&self.names).enumerate();
        givers.filter_map(move |(position, (giver, name))| match *giver {
            ValueSource::Axis(by, ratio) if by == axis => Some((position, &**name, ratio * own)),
            ValueSource::Axis(..) | ValueSource::Constant(_) => None,
        })
    }

    /// Returns the point (coordinates) for the values of all unknowns [declared units].
    pub fn point(&self, values: &[f64]) -> Vec<f64> {
        let axes = self.axes.iter();
        axes.map(|axis| axis.coordinate(values[axis.position]))
            .collect()
    }
}

/// Follows an unknown's chain of ties; returns the index of the unknown at its end (the unknown itself
/// without a tie) and the ratio to that unknown's value. Requires checked ties: a cycle would not terminate.
fn leader(unknowns: &[Unknown], position: usize) -> (usize, f64) {
    let (mut at, mut ratio) = (position, 1.0);
    while let Some(tie) = &unknowns[at].tie
        && let Some(next) = unknowns.iter().position(|other| other.name == tie.to)
    {
        (at, ratio) = (next, ratio * tie.ratio);
    }
    (at, ratio)
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::case::Tie;

    fn logarithmic(lower: f64, start: f64, upper: f64) -> Unknown {
        let name = format!("mass of {start}");
        Unknown::new(name, "kg", Scale::Logarithmic, start, [lower, upper])
    }

    fn linear(lower: f64, start: f64, upper: f64) -> Unknown {
        let name = format!("offset of {start}");
        Unknown::new(name, "mm", Scale::Linear, start, [lower, upper])
    }

    #[test]
    fn points_and_values_are_inverse_and_stay_in_the_box() {
        let unknowns = [logarithmic(3e4, 3e8, 3e12), logarithmic(2.0, 5.0, 7.0)];
        let space = Space::new(&unknowns).unwrap();
        assert_eq!(space.values(&[0.0, 0.0]), [3e8, 5.0]);
        let values = space.values(&[1.25, 0.1]);
        for (back, x) in space.point(&values).into_iter().zip([1.25, 0.1]) {
            assert!((back - x).abs() < 1e-12);
        }
        assert_eq!(space.values(&[9.0, -9.0]), [3e12, 2.0]);
    }

    #[test]
    fn a_linear_axis_counts_halves_of_its_interval_and_may_be_negative() {
        let space = Space::new(&[linear(-3.0, -1.0, 1.0), linear(0.0, 0.0, 0.5)]).unwrap();
        assert_eq!(space.values(&[0.0, 0.0]), [-1.0, 0.0]);
        assert_eq!(space.values(&[0.25, 1.0]), [-0.5, 0.25]);
        assert_eq!(space.point(&[-0.5, 0.25]), [0.25, 1.0]);
        assert_eq!(space.values(&[-9.0, 9.0]), [-3.0, 0.5]);
        for (axis, [from, to]) in space.axes().iter().zip([[-1.0, 1.0], [0.0, 2.0]]) {
            assert_eq!(axis.interval(), Interval { from, to });
            assert_eq!(axis.trust, axis.interval());
        }
    }

    #[test]
    fn a_space_about_other_values_has_them_at_its_origin_and_keeps_its_bounds() {
        let unknowns = [logarithmic(3e4, 3e8, 3e12), linear(-3.0, -1.0, 1.0)];
        let space = Space::with_start(&unknowns, &[6e9, 0.5]).unwrap();
        assert_eq!(space.values(&[0.0, 0.0]), [6e9, 0.5]);
        assert_eq!(space.values(&[9.0, -9.0]), [3e12, -3.0]);
        for (outside, name) in [([2e4, 0.0], "mass"), ([3e8, f64::NAN], "offset")] {
            let error = Space::with_start(&unknowns, &outside)
                .unwrap_err()
                .to_string();
            let begins = format!("unknown {name} of ");
            assert!(error.starts_with(&begins), "{error}");
            assert!(error.contains("start = "), "{error}");
        }
        let short = Space::with_start(&unknowns, &[6e9]);
        let (found, expected) = (1, 2);
        assert_eq!(short, Err(SpaceError::Length { found, expected }));
    }

    /// Checks that the derivatives returned by `rates` agree with difference quotients of the values, also
    /// for a tied unknown.
    #[test]
    fn rates_are_those_of_the_values() {
        let mut unknowns = [
            logarithmic(1.0, 2.0, 4.0),
            linear(-3.0, -1.0, 1.0),
            logarithmic(1.0, 6.0, 9.0),
        ];
        unknowns[2].tie = Some(Tie {
            to: unknowns[0].name.clone(),
            ratio: 3.0,
        });
        let space = Space::new(&unknowns).unwrap();
        let at = [0.1, -0.2];
        for axis in 0..2 {
            let moved = |by: f64| {
                let mut x = at;
                x[axis] += by;
                space.values(&x)
            };
            let (up, down) = (moved(1e-6), moved(-1e-6));
            let mut rates = vec![0.0; 3];
            for (position, name, rate) in space.rates(axis, at[axis]) {
                assert_eq!(name, unknowns[position].name);
                rates[position] = rate;
            }
            for (k, rate) in rates.into_iter().enumerate() {
                assert!((rate - (up[k] - down[k]) / 2e-6).abs() < 1e-6, "{axis} {k}");
            }
        }
    }

    /// Checks that fixed, tied and switched-off unknowns have values but no axis.
    #[test]
    fn only_what_moves_has_an_axis_and_all_have_values() {
        let mut unknowns = [
            linear(-3.0, -1.0, 1.0),
            logarithmic(1.0, 2.0, 4.0),
            linear(0.0, 0.5, 1.0),
            logarithmic(1.0, 3.0, 9.0),
            linear(-1.0, 0.0, 1.0),
        ];
        let tie = |to: &Unknown, ratio| {
            Some(Tie {
                to: to.name.clone(),
                ratio,
            })
        };
        unknowns[0].tie = tie(&unknowns[2], -2.0);
        unknowns[1].fixed = true;
        unknowns[2].tie = tie(&unknowns[3], 0.5 / 3.0);
        unknowns[4].absent = Some(0.0);
        let space = Space::new(&unknowns).unwrap();
        assert_eq!(space.dimension(), 1);
        assert_eq!(space.axes()[0].position, 3);
        assert_eq!(space.position(&unknowns[3].name), Some(0));
        assert_eq!(space.position(&unknowns[1].name), None);
        let near = |values: Vec<f64>, expected: [f64; 5]| {
            let pairs = values.iter().zip(expected);
            assert!(
                pairs.clone().all(|(a, b)| (a - b).abs() < 1e-12),
                "{values:?}"
            );
        };
        near(space.values(&[0.0]), [-1.0, 2.0, 0.5, 3.0, 0.0]);
        near(space.values(&[9.0]), [-3.0, 2.0, 1.5, 9.0, 0.0]);
        assert_eq!(space.point(&[7.0, 7.0, 7.0, 3.0, 7.0]), [0.0]);
        // started elsewhere, the last is on, and the tied ones follow
        let about = Space::with_start(&unknowns, &[7.0, 3.5, 7.0, 6.0, 0.25]).unwrap();
        assert_eq!(about.dimension(), 2);
        near(about.values(&[0.0, 0.0]), [-2.0, 3.5, 1.0, 6.0, 0.25]);
    }

    #[test]
    fn trust_never_leaves_the_bounds() {
        let mut unknown = logarithmic(2.0, 5.0, 7.0);
        unknown.trust = Some([-1.0, 0.1]);
        let space = Space::new(&[unknown]).unwrap();
        let axis = &space.axes()[0];
        assert_eq!(axis.trust.from.to_bits(), axis.interval().from.to_bits());
        assert_eq!(axis.trust.to.to_bits(), 0.1_f64.to_bits());
    }

    #[test]
    fn what_cannot_be_searched_is_refused_by_name() {
        let error = Space::new(&[logarithmic(0.0, 1.0, 2.0)]).unwrap_err();
        assert!(
            error.to_string().starts_with("unknown mass of 1: lower"),
            "{error}"
        );
        assert_eq!(Space::new(&[]), Err(SpaceError::Empty));
        let mut fixed = linear(0.0, 1.0, 2.0);
        fixed.fixed = true;
        assert_eq!(Space::new(&[fixed]), Err(SpaceError::Empty));
    }
}
