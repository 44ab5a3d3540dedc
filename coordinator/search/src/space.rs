//! The box of the unknowns that a search moves.
//!
//! A point is given by a *coordinate* per axis, 0 at the start. On a logarithmic axis it counts decades,
//! `value = start * 10^x`; on a linear one, halves of the interval to search,
//! `value = start + x * (upper - lower) / 2`, so that such an axis is about as long as the part of a
//! logarithmic one that matters, and the same steps suit both.
//!
//! Values are those of *all* unknowns of the case, in its order: what is fixed, switched off or tied has
//! no axis, and gets its value here and nowhere else. Nothing here knows what an unknown means.
use protocol::case::{BadUnknown, Scale, Unknown, check_unknowns};

/// Unknowns that cannot be searched.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SpaceError {
    /// The space has no axis.
    #[error("there is no unknown to search: each is fixed, tied or switched off")]
    Empty,
    /// One of them is stated in a way that makes no sense.
    #[error(transparent)]
    Unknown(#[from] BadUnknown),
    /// A search is to start from more or fewer values than there are unknowns.
    #[error("the start has {found} values, but there are {expected} unknowns")]
    Length {
        /// How many values there are.
        found: usize,
        /// How many unknowns.
        expected: usize,
    },
}

/// One unknown that is searched: its interval, and the part of it in which models usually survive.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The unknown, at coordinate 0 where it starts.
    pub unknown: Unknown,
    /// Its position among all unknowns.
    pub position: usize,
    /// Trust interval about the start, inside the bounds (coordinate).
    pub trust: Interval,
}

/// A closed interval of coordinates.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Interval {
    /// Lower end (coordinate).
    pub from: f64,
    /// Upper end (coordinate).
    pub to: f64,
}

impl Interval {
    /// Length (coordinate).
    pub fn length(self) -> f64 {
        self.to - self.from
    }

    /// The nearest point inside.
    pub fn clamp(self, x: f64) -> f64 {
        x.max(self.from).min(self.to)
    }

    /// The part that lies in both; a point if they do not meet.
    #[must_use]
    pub fn within(self, other: Self) -> Self {
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
        axis.trust = axis.trust.within(axis.interval());
        axis
    }

    /// The whole interval (coordinate).
    pub fn interval(&self) -> Interval {
        Interval {
            from: self.coordinate(self.unknown.lower),
            to: self.coordinate(self.unknown.upper),
        }
    }

    /// The value at a coordinate, never outside the bounds.
    pub fn value(&self, x: f64) -> f64 {
        let value = match self.unknown.scale {
            Scale::Logarithmic => self.unknown.start * libm::exp10(x),
            Scale::Linear => self.unknown.start + self.half() * x,
        };
        value.clamp(self.unknown.lower, self.unknown.upper)
    }

    /// How fast the value grows with the coordinate, inside the bounds [declared unit].
    fn rate(&self, x: f64) -> f64 {
        match self.unknown.scale {
            Scale::Logarithmic => std::f64::consts::LN_10 * self.value(x),
            Scale::Linear => self.half(),
        }
    }

    /// The coordinate of a value.
    pub fn coordinate(&self, value: f64) -> f64 {
        match self.unknown.scale {
            Scale::Logarithmic => libm::log10(value / self.unknown.start),
            Scale::Linear => (value - self.unknown.start) / self.half(),
        }
    }

    /// Half of the interval: the unit of a linear axis [declared unit].
    fn half(&self) -> f64 {
        0.5 * (self.unknown.upper - self.unknown.lower)
    }
}

/// The box of the unknowns that are searched; at least one.
#[derive(Clone, Debug, PartialEq)]
pub struct Space {
    axes: Vec<Axis>,
    /// What gives each unknown its value, in the case's order.
    givers: Vec<Giver>,
    /// Their names.
    names: Vec<String>,
    /// Where a search is to look first (coordinate), the best first.
    starts: Vec<Vec<f64>>,
}

/// What gives an unknown its value.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Giver {
    /// Nothing moves it.
    Held(f64),
    /// An axis, times a ratio: 1 for its own.
    Axis(usize, f64),
}

impl Space {
    /// The space of a case's unknowns.
    ///
    /// # Errors
    /// If one is stated in a way that makes no sense, or none is to be searched.
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
                Some(axis) => Giver::Axis(axis, ratio),
                None => Giver::Held(unknowns[position].start),
            }
        };
        let givers = (0..unknowns.len()).map(giver).collect();
        if axes.is_empty() {
            return Err(SpaceError::Empty);
        }
        let names = unknowns.iter().map(|unknown| unknown.name.clone());
        Ok(Self {
            axes,
            givers,
            names: names.collect(),
            starts: Vec::new(),
        })
    }

    /// The space of a case's unknowns about other values than those that it states [declared units],
    /// one per unknown.
    ///
    /// # Errors
    /// As [`Space::new`]; if a value lies outside its unknown's bounds. That of a tied one is not
    /// looked at.
    pub fn about(unknowns: &[Unknown], start: &[f64]) -> Result<Self, SpaceError> {
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

    /// The same space, to be searched from these individuals: values of all unknowns [declared units], the
    /// best first.
    #[must_use]
    pub fn beginning_at(self, individuals: &[Vec<f64>]) -> Self {
        let starts = individuals
            .iter()
            .map(|values| self.point(values))
            .collect();
        Self { starts, ..self }
    }

    /// What a first population holds in its first places (coordinate), the best first.
    pub fn starts(&self) -> &[Vec<f64>] {
        &self.starts
    }

    /// Where a search of one point begins (coordinate): at the best start, or at the case's.
    pub fn origin(&self) -> Vec<f64> {
        let best = self.starts.first().cloned();
        best.unwrap_or_else(|| vec![0.0; self.dimension()])
    }

    /// The unknowns that are searched.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// Position of the axis of an unknown; none if that is not searched.
    pub fn position(&self, name: &str) -> Option<usize> {
        self.axes.iter().position(|axis| axis.unknown.name == name)
    }

    /// Number of axes.
    pub fn dimension(&self) -> usize {
        self.axes.len()
    }

    /// Values of all unknowns [declared units] at a point, which has one coordinate per axis.
    pub fn values(&self, point: &[f64]) -> Vec<f64> {
        let axes = self.axes.iter().zip(point);
        let own: Vec<f64> = axes.map(|(axis, &x)| axis.value(x)).collect();
        self.expand(&own)
    }

    /// Values of all unknowns where those that are searched have these [declared units].
    pub fn expand(&self, own: &[f64]) -> Vec<f64> {
        let value = |giver: &Giver| match *giver {
            Giver::Held(value) => value,
            Giver::Axis(axis, ratio) => ratio * own[axis],
        };
        self.givers.iter().map(value).collect()
    }

    /// The unknowns that an axis moves: their positions, their names, and how fast each of their values
    /// grows with its coordinate `x` [declared unit].
    pub fn rates(&self, axis: usize, x: f64) -> impl Iterator<Item = (usize, &str, f64)> {
        let own = self.axes[axis].rate(x);
        let givers = self.givers.iter().zip(&self.names).enumerate();
        givers.filter_map(move |(position, (giver, name))| match *giver {
            Giver::Axis(by, ratio) if by == axis => Some((position, &**name, ratio * own)),
            Giver::Axis(..) | Giver::Held(_) => None,
        })
    }

    /// The point of values of all unknowns [declared units].
    pub fn point(&self, values: &[f64]) -> Vec<f64> {
        let axes = self.axes.iter();
        axes.map(|axis| axis.coordinate(values[axis.position]))
            .collect()
    }
}

/// The unknown that one follows by way of its ties, itself where it has none, and the ratio to it. The
/// ties have been checked: they end.
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
        let space = Space::about(&unknowns, &[6e9, 0.5]).unwrap();
        assert_eq!(space.values(&[0.0, 0.0]), [6e9, 0.5]);
        assert_eq!(space.values(&[9.0, -9.0]), [3e12, -3.0]);
        for (outside, name) in [([2e4, 0.0], "mass"), ([3e8, f64::NAN], "offset")] {
            let error = Space::about(&unknowns, &outside).unwrap_err().to_string();
            let begins = format!("unknown {name} of ");
            assert!(error.starts_with(&begins), "{error}");
            assert!(error.contains("start = "), "{error}");
        }
        let short = Space::about(&unknowns, &[6e9]);
        let (found, expected) = (1, 2);
        assert_eq!(short, Err(SpaceError::Length { found, expected }));
    }

    /// A value grows as its rate says, and what is tied to it with it.
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

    /// Whatever has no axis still has a value, and the box does not know its place in the case.
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
        let about = Space::about(&unknowns, &[7.0, 3.5, 7.0, 6.0, 0.25]).unwrap();
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
