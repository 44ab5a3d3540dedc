//! The box of genes.
//!
//! A point is given by a *coordinate* per gene, 0 at the recommended value. On a logarithmic axis it
//! counts decades, `value = recommended * 10^x`; on a linear one, halves of the interval to search,
//! `value = recommended + x * (upper - lower) / 2`, so that such an axis is about as long as the part
//! of a coefficient's that matters, and the same steps suit both. Nothing here knows what a gene means;
//! its unit only decides how far from the recommendation a first search may go.
use protocol::{
    case::{Coefficient, Gene, Quantity, Scale},
    unit::Unit,
};

/// A gene that cannot be searched.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SpaceError {
    /// The space has no axis.
    #[error("there is no gene to search")]
    Empty,
    /// Bounds and recommendation are not ordered, or not positive on a logarithmic axis.
    #[error("gene {name}: {rule} must hold, but they are {lower}, {recommended}, {upper}")]
    Bounds {
        /// Name of the gene.
        name: String,
        /// What must hold.
        rule: &'static str,
        /// Its lower bound, in its declared unit.
        lower: f64,
        /// Its recommended value.
        recommended: f64,
        /// Its upper bound.
        upper: f64,
    },
    /// A search is to start outside the bounds of a gene.
    #[error("gene {name}: the start, {start}, lies outside its bounds, {lower} to {upper}")]
    Start {
        /// Which.
        name: String,
        /// Where to start.
        start: f64,
        /// Its lower bound.
        lower: f64,
        /// Its upper bound.
        upper: f64,
    },
}

/// One gene: its interval, and the part of it in which models usually survive.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Which gene.
    pub quantity: Quantity,
    /// Value at coordinate 0, the recommended one unless the search starts elsewhere [declared unit].
    pub centre: f64,
    /// Smallest value [declared unit].
    pub lower: f64,
    /// Largest value [declared unit].
    pub upper: f64,
    /// Trust interval about the centre, inside the bounds (coordinate).
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
    /// The whole interval (coordinate).
    pub fn interval(&self) -> Interval {
        Interval {
            from: self.coordinate(self.lower),
            to: self.coordinate(self.upper),
        }
    }

    /// The value at a coordinate, never outside the bounds.
    pub fn value(&self, x: f64) -> f64 {
        let value = match self.quantity.scale() {
            Scale::Logarithmic => self.centre * libm::exp10(x),
            Scale::Linear => self.centre + self.half() * x,
        };
        value.clamp(self.lower, self.upper)
    }

    /// The coordinate of a value.
    pub fn coordinate(&self, value: f64) -> f64 {
        match self.quantity.scale() {
            Scale::Logarithmic => libm::log10(value / self.centre),
            Scale::Linear => (value - self.centre) / self.half(),
        }
    }

    /// Half of the interval: the unit of a linear axis [declared unit].
    fn half(&self) -> f64 {
        0.5 * (self.upper - self.lower)
    }
}

/// The box of all genes; at least one.
#[derive(Clone, Debug, PartialEq)]
pub struct Space {
    axes: Vec<Axis>,
}

impl Space {
    /// The space of a case's genes, in their order.
    ///
    /// # Errors
    /// If there is no gene, or bounds and recommendation of one are not ordered, or not positive on a
    /// logarithmic axis.
    pub fn new(genes: &[Gene]) -> Result<Self, SpaceError> {
        if genes.is_empty() {
            return Err(SpaceError::Empty);
        }
        let axes = genes.iter().map(axis).collect::<Result<_, _>>()?;
        Ok(Self { axes })
    }

    /// The space of a case's genes about other values than the recommended ones [declared units], in
    /// the order of the genes.
    ///
    /// # Errors
    /// As [`Space::new`]; if a value lies outside its gene's bounds.
    pub fn about(genes: &[Gene], centre: &[f64]) -> Result<Self, SpaceError> {
        let moved = genes.iter().zip(centre).map(|(gene, &start)| {
            if !(gene.lower..=gene.upper).contains(&start) {
                return Err(SpaceError::Start {
                    name: gene.label(),
                    start,
                    lower: gene.lower,
                    upper: gene.upper,
                });
            }
            Ok(Gene {
                recommended: start,
                ..gene.clone()
            })
        });
        Self::new(&moved.collect::<Result<Vec<_>, _>>()?)
    }

    /// One axis per gene.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// Position of a coefficient.
    pub fn position(&self, name: Coefficient) -> Option<usize> {
        self.axes.iter().position(|axis| axis.quantity.is(name))
    }

    /// Number of genes.
    pub fn dimension(&self) -> usize {
        self.axes.len()
    }

    /// Values [declared units] of a point; one per axis.
    pub fn values(&self, point: &[f64]) -> Vec<f64> {
        let pairs = self.axes.iter().zip(point);
        pairs.map(|(axis, &x)| axis.value(x)).collect()
    }

    /// The point of values [declared units].
    pub fn point(&self, values: &[f64]) -> Vec<f64> {
        let pairs = self.axes.iter().zip(values);
        pairs.map(|(axis, &value)| axis.coordinate(value)).collect()
    }
}

fn axis(gene: &Gene) -> Result<Axis, SpaceError> {
    let inside = gene.lower <= gene.recommended
        && gene.recommended <= gene.upper
        && (gene.upper - gene.lower).is_finite();
    let (fits, rule) = match gene.scale() {
        Scale::Logarithmic => (gene.lower > 0.0, "0 < lower <= recommended <= upper"),
        Scale::Linear => (
            gene.lower < gene.upper,
            "lower <= recommended <= upper and lower < upper",
        ),
    };
    if !(inside && fits) {
        return Err(SpaceError::Bounds {
            name: gene.label(),
            rule,
            lower: gene.lower,
            recommended: gene.recommended,
            upper: gene.upper,
        });
    }
    let mut axis = Axis {
        quantity: gene.quantity.clone(),
        centre: gene.recommended,
        lower: gene.lower,
        upper: gene.upper,
        trust: match gene.quantity {
            Quantity::Coefficient { unit, .. } => trust(unit),
            // what a case says of an effect's parameter is searched whole
            Quantity::Effect { .. } => Interval {
                from: f64::NEG_INFINITY,
                to: f64::INFINITY,
            },
        },
    };
    axis.trust = axis.trust.within(axis.interval());
    Ok(axis)
}

/// Stiffness of a rope is known to a decade or so, its damping to several: a bushing's dashpot
/// stands for every loss of the machine. Contact numbers are conventions of a simulation program
/// rather than properties of the machine, and recommendations for them are mostly too soft.
fn trust(unit: Unit) -> Interval {
    match unit {
        Unit::NewtonPerMetre | Unit::NewtonMetrePerRadian | Unit::NewtonMetrePerDegree => {
            Interval {
                from: -1.0,
                to: 1.5,
            }
        }
        Unit::NewtonSecondPerMetre
        | Unit::NewtonMetreSecondPerRadian
        | Unit::NewtonMetreSecondPerDegree => Interval {
            from: -1.0,
            to: 4.0,
        },
        Unit::NewtonPerMetreToThreeHalves => Interval {
            from: -0.5,
            to: 3.5,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gene(lower: f64, recommended: f64, upper: f64) -> Gene {
        let unit = Unit::NewtonPerMetre;
        Gene::coefficient(Coefficient::Kb23, unit, recommended, [lower, upper])
    }

    fn linear(lower: f64, recommended: f64, upper: f64) -> Gene {
        Gene {
            quantity: Quantity::Effect {
                id: "gauge_drift".to_owned(),
                parameter: "drift_1".to_owned(),
                unit: "MPa/rev".to_owned(),
            },
            recommended,
            lower,
            upper,
        }
    }

    #[test]
    fn points_and_values_are_inverse_and_stay_in_the_box() {
        let space = Space::new(&[gene(3e4, 3e8, 3e12), gene(2.0, 5.0, 7.0)]).unwrap();
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
        for bad in [
            linear(1.0, 1.0, 1.0),
            linear(0.0, 2.0, 1.0),
            linear(f64::NEG_INFINITY, 0.0, 1.0),
            linear(-1.0, f64::NAN, 1.0),
        ] {
            let error = Space::new(&[bad]).unwrap_err().to_string();
            assert!(error.starts_with("gene gauge_drift.drift_1:"), "{error}");
        }
    }

    #[test]
    fn a_space_about_other_values_has_them_at_its_origin_and_keeps_its_bounds() {
        let genes = [gene(3e4, 3e8, 3e12), linear(-3.0, -1.0, 1.0)];
        let space = Space::about(&genes, &[6e9, 0.5]).unwrap();
        assert_eq!(space.values(&[0.0, 0.0]), [6e9, 0.5]);
        assert_eq!(space.values(&[9.0, -9.0]), [3e12, -3.0]);
        for (outside, name) in [
            ([2e4, 0.0], "kb23"),
            ([3e8, f64::NAN], "gauge_drift.drift_1"),
        ] {
            let error = Space::about(&genes, &outside).unwrap_err().to_string();
            let begins = format!("gene {name}: the start, ");
            assert!(error.starts_with(&begins), "{error}");
        }
    }

    #[test]
    fn trust_never_leaves_the_bounds() {
        let space = Space::new(&[gene(2.0, 5.0, 7.0)]).unwrap();
        let axis = &space.axes()[0];
        assert_eq!(axis.trust, axis.interval());
    }

    #[test]
    fn unordered_bounds_are_refused_by_name() {
        for bad in [
            gene(0.0, 1.0, 2.0),
            gene(2.0, 1.0, 3.0),
            gene(1.0, 4.0, 3.0),
        ] {
            let error = Space::new(&[bad]).unwrap_err();
            assert!(error.to_string().starts_with("gene kb23:"), "{error}");
        }
        assert_eq!(Space::new(&[]), Err(SpaceError::Empty));
    }
}
