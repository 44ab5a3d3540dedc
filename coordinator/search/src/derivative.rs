//! Chain rule that converts derivatives computed by workers to derivatives with respect to search
//! coordinates. A worker differentiates with respect to an unknown of the case or a parameter of an effect,
//! per decade or per unit; a search varies coordinates (scaled values of the unknowns). Unknowns tied to a
//! searched unknown vary with it.
use crate::space::Space;
use protocol::job::{Column, Derivative, Per};
use std::f64::consts::LN_10;

/// Term of the chain rule: contribution of one derivative computed by a worker to the derivative with respect
/// to a search coordinate.
#[derive(Clone, Debug, PartialEq)]
pub struct DerivativeTerm {
    /// Unknown or effect parameter that the worker differentiates by.
    pub column: Column,
    /// Current value of the unknown or parameter that the worker differentiates by [declared unit].
    pub value: f64,
    /// Derivative of the unknown's or parameter's value with respect to the search coordinate [declared
    /// unit].
    pub rate: f64,
}

impl DerivativeTerm {
    /// Returns the factor that converts a worker's derivative, per decade or per unit, to the derivative with
    /// respect to the search coordinate.
    pub fn factor(&self, per: &Per) -> f64 {
        match per {
            Per::Decade => self.rate / (self.value * LN_10),
            Per::Unit(_) => self.rate,
        }
    }

    /// Adds this term's contribution for the curve with index `place` to `sum`, the derivative of that curve
    /// at all its points or only at the points with indices `rows`; returns `None` if the worker's derivative
    /// is missing or its length does not match.
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

/// Returns the chain-rule terms of the derivative with respect to one axis of a search space at the point
/// `x`, where the unknowns have the given `values`.
pub fn terms(space: &Space, axis: usize, x: &[f64], values: &[f64]) -> Vec<DerivativeTerm> {
    let moved = space.rates(axis, x[axis]);
    let term = |(position, name, rate): (usize, &str, f64)| DerivativeTerm {
        column: Column::new(name),
        value: values[position],
        rate,
    };
    moved.map(term).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::case::{Scale, Tie, Unknown};

    /// Checks that the chain-rule terms convert derivatives per decade and per unit into those by search
    /// coordinates, against finite differences.
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
