//! The chain rule between what a simulation is differentiated by and what a search moves.
//!
//! A worker differentiates by an unknown of the case, or by a parameter of an effect, per decade or per
//! unit; a search counts coordinates. What is tied to an unknown changes with it.
use crate::space::Space;
use protocol::job::{Column, Derivative, Per};
use std::f64::consts::LN_10;

/// A column, and how much of it there is in the change by a coordinate.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// What is varied.
    pub column: Column,
    /// Its value [declared unit].
    pub value: f64,
    /// How fast that grows with the coordinate.
    pub rate: f64,
}

impl Term {
    /// What a derivative per so much is multiplied by.
    pub fn factor(&self, per: &Per) -> f64 {
        match per {
            Per::Decade => self.rate / (self.value * LN_10),
            Per::Unit(_) => self.rate,
        }
    }

    /// Adds its part to a change of a curve, which is the one of this place among the derivative's; nothing
    /// where that is not known.
    pub fn add(
        &self,
        by: &Derivative,
        (place, rows): (usize, Option<&[usize]>),
        sum: &mut [f64],
    ) -> Option<()> {
        match by {
            Derivative::Curves { per, curves } => {
                let own = curves.get(place)?;
                let count = rows.map_or(own.len(), <[usize]>::len);
                if count != sum.len() {
                    return None;
                }
                let factor = self.factor(per);
                for (k, sum) in sum.iter_mut().enumerate() {
                    let x = own.get(rows.map_or(k, |rows| rows[k]))?;
                    *sum += factor * f64::from(*x);
                }
                Some(())
            }
            Derivative::Nothing { .. } => Some(()),
            Derivative::Missing { .. } => None,
        }
    }
}

/// The terms of a change by an axis of a space at a point, where the unknowns have these values.
pub fn terms(space: &Space, axis: usize, x: &[f64], values: &[f64]) -> Vec<Term> {
    let moved = space.rates(axis, x[axis]);
    let term = |(position, name, rate): (usize, &str, f64)| Term {
        column: Column::of(name),
        value: values[position],
        rate,
    };
    moved.map(term).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::case::{Scale, Tie, Unknown};

    /// With derivatives of a function by its unknowns, per decade or per unit, terms make those by the
    /// coordinates.
    #[test]
    fn terms_make_derivatives_by_coordinates() {
        let mut unknowns = [
            Unknown::new("k", "N/m", Scale::Logarithmic, 2e8, [1e6, 1e10]),
            Unknown::new("offset", "mm", Scale::Linear, 1.0, [-3.0, 5.0]),
            Unknown::new("other", "N/m", Scale::Logarithmic, 6e8, [1e6, 1e11]),
        ];
        unknowns[2].tie = Some(Tie {
            to: "k".to_owned(),
            ratio: 3.0,
        });
        let space = Space::new(&unknowns).unwrap();
        let function = |v: &[f64]| v[0].ln() * v[1] + v[2].powf(0.3) + v[1].powi(2);
        let by = |name: &str, v: &[f64]| match name {
            "k" => (v[1] * LN_10, Per::Decade),
            "other" => (0.3 * v[2].powf(0.3) * LN_10, Per::Decade),
            _ => (v[0].ln() + 2.0 * v[1], Per::Unit("mm".to_owned())),
        };
        let x = [0.2, -0.3];
        let values = space.values(&x);
        for axis in 0..2 {
            let terms = terms(&space, axis, &x, &values);
            let exact: f64 = terms
                .iter()
                .map(|term| {
                    let (derivative, per) = by(&term.column.name, &values);
                    term.factor(&per) * derivative
                })
                .sum();
            let at = |step: f64| {
                let mut x = x;
                x[axis] += step;
                function(&space.values(&x))
            };
            let difference = (at(1e-6) - at(-1e-6)) / 2e-6;
            assert!(
                (exact / difference - 1.0).abs() < 1e-7,
                "{axis}: {exact} {difference}"
            );
        }
    }
}
