//! The box of genes, on a logarithmic scale.
//!
//! A point is given in *decades* from the recommended value, gene by gene:
//! `value = recommended * 10^x`, so 0 is the recommended individual. Nothing here knows what a
//! gene means; its unit only decides how far from the recommendation a first search may go.
use protocol::{
    case::{Gene, GeneName},
    unit::Unit,
};

/// A gene that cannot be searched.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SpaceError {
    /// The space has no axis.
    #[error("there is no gene to search")]
    Empty,
    /// `0 < lower <= recommended <= upper` does not hold.
    #[error(
        "gene {name}: 0 < lower <= recommended <= upper must hold, \
         but they are {lower}, {recommended}, {upper}"
    )]
    Bounds {
        /// Name of the gene.
        name: String,
        /// Its lower bound, in its declared unit.
        lower: f64,
        /// Its recommended value.
        recommended: f64,
        /// Its upper bound.
        upper: f64,
    },
}

/// One gene: its interval, and the part of it in which models usually survive.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Which gene.
    pub name: GeneName,
    /// Recommended value [declared unit].
    pub recommended: f64,
    /// Smallest value [declared unit].
    pub lower: f64,
    /// Largest value [declared unit].
    pub upper: f64,
    /// Trust interval about the recommendation, inside the bounds (decades).
    pub trust: Interval,
}

/// A closed interval in decades from the recommended value.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Interval {
    /// Lower end (decades).
    pub from: f64,
    /// Upper end (decades).
    pub to: f64,
}

impl Interval {
    /// Length (decades).
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
    /// The whole interval (decades).
    pub fn interval(&self) -> Interval {
        Interval {
            from: libm::log10(self.lower / self.recommended),
            to: libm::log10(self.upper / self.recommended),
        }
    }

    /// The value at `x` decades, never outside the bounds.
    pub fn value(&self, x: f64) -> f64 {
        (self.recommended * libm::exp10(x)).clamp(self.lower, self.upper)
    }

    /// How many decades a value lies from the recommended one.
    pub fn decades(&self, value: f64) -> f64 {
        libm::log10(value / self.recommended)
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
    /// If there is no gene, or bounds and recommendation of one are not positive and ordered.
    pub fn new(genes: &[Gene]) -> Result<Self, SpaceError> {
        if genes.is_empty() {
            return Err(SpaceError::Empty);
        }
        let axes = genes.iter().map(axis).collect::<Result<_, _>>()?;
        Ok(Self { axes })
    }

    /// One axis per gene.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// Position of a gene.
    pub fn position(&self, name: GeneName) -> Option<usize> {
        self.axes.iter().position(|axis| axis.name == name)
    }

    /// Number of genes.
    pub fn dimension(&self) -> usize {
        self.axes.len()
    }

    /// Values [declared units] of a point (decades); one per axis.
    pub fn values(&self, point: &[f64]) -> Vec<f64> {
        let pairs = self.axes.iter().zip(point);
        pairs.map(|(axis, &x)| axis.value(x)).collect()
    }

    /// The point (decades) of values [declared units].
    pub fn decades(&self, values: &[f64]) -> Vec<f64> {
        let pairs = self.axes.iter().zip(values);
        pairs.map(|(axis, &value)| axis.decades(value)).collect()
    }
}

fn axis(gene: &Gene) -> Result<Axis, SpaceError> {
    let ordered = gene.lower > 0.0
        && gene.lower <= gene.recommended
        && gene.recommended <= gene.upper
        && gene.upper.is_finite();
    if !ordered {
        return Err(SpaceError::Bounds {
            name: gene.name.as_str().to_owned(),
            lower: gene.lower,
            recommended: gene.recommended,
            upper: gene.upper,
        });
    }
    let mut axis = Axis {
        name: gene.name,
        recommended: gene.recommended,
        lower: gene.lower,
        upper: gene.upper,
        trust: trust(gene.unit),
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
        Gene {
            name: GeneName::Kb23,
            unit: Unit::NewtonPerMetre,
            recommended,
            lower,
            upper,
        }
    }

    #[test]
    fn decades_and_values_are_inverse_and_stay_in_the_box() {
        let space = Space::new(&[gene(3e4, 3e8, 3e12), gene(2.0, 5.0, 7.0)]).unwrap();
        assert_eq!(space.values(&[0.0, 0.0]), [3e8, 5.0]);
        let values = space.values(&[1.25, 0.1]);
        for (back, x) in space.decades(&values).into_iter().zip([1.25, 0.1]) {
            assert!((back - x).abs() < 1e-12);
        }
        assert_eq!(space.values(&[9.0, -9.0]), [3e12, 2.0]);
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
