//! Model that was fitted to a record, with the quantities that the tests use.
use crate::linear::evidence;
use crate::linear::tangent::Tangent;
use crate::model::unknowns::{FittedModel, Point};
use crate::record::measured::Curves;
use protocol::announce::EffectDescriptor;
use search::least_squares::{LeastSquares, Variable};

/// Model with the final state of its fit.
#[derive(Clone, Debug)]
pub struct Fit {
    /// Model whose unknowns were fitted.
    pub model: FittedModel,
    /// Final state of the least-squares search: point, residual and Jacobian.
    pub search: LeastSquares,
    /// Simulated curves at the fitted point.
    pub curves: Curves,
}

impl Fit {
    /// Returns the fitted values of the unknowns.
    pub fn x(&self) -> &[f64] {
        &self.search.best().x
    }

    /// Returns the model's unknowns as variables of a search, starting at the fitted values.
    pub fn variables(&self) -> &[Variable] {
        self.search.variables()
    }

    /// Returns the model at the fitted values.
    pub fn point(&self) -> Point {
        self.at(self.x().to_vec())
    }

    /// Returns the model at the values `x` of its unknowns instead of the fitted ones.
    pub fn at(&self, x: Vec<f64>) -> Point {
        Point {
            model: self.model.clone(),
            x,
        }
    }

    /// Returns the model with one more effect, given by the scaled values of the effect's parameters.
    pub fn with(&self, effect: &EffectDescriptor, own: &[f64]) -> Point {
        self.point().with(effect, own)
    }

    /// Returns the squared length of the whitened residual.
    pub fn chi_squared(&self) -> f64 {
        self.search.best().residual.norm_squared()
    }

    /// Returns the number of entries of the whitened residual, which is also its expected squared length
    /// under noise alone.
    pub fn entries(&self) -> usize {
        self.search.best().residual.len()
    }

    /// Returns the residual's degrees of freedom: number of entries less number of unknowns, at least 1.
    pub fn freedom(&self) -> f64 {
        (self.entries() as f64 - self.tangent().parameters()).max(1.0)
    }

    /// Returns the variance of a residual entry in units of the noise variance, `max(1, chi^2 / (n - p))`:
    /// the dispersion by which differences of log likelihoods are divided (`McCullagh` & Nelder, *Generalized
    /// Linear Models*, 4.5).
    pub fn dispersion(&self) -> f64 {
        (self.chi_squared() / self.freedom()).max(1.0)
    }

    /// Returns the log evidence of the model (nats), up to a constant of the record.
    pub fn log_evidence(&self) -> f64 {
        evidence::log_evidence(self.search.best(), self.variables())
    }

    /// Returns the tangent space of the fitted model: the changes of the whitened residual that its unknowns
    /// can produce.
    pub fn tangent(&self) -> Tangent {
        Tangent::new(self.search.best(), self.variables())
    }

    /// Iterates over points for finite differences, each with the signed step of the unknown that was moved,
    /// in the order of the unknowns. A step that would cross the upper bound is taken downwards.
    pub fn neighbours(&self) -> impl Iterator<Item = (f64, Point)> {
        let unknowns = self.variables().iter().zip(self.x()).enumerate();
        unknowns.map(|(k, (v, at))| {
            let inside = at + v.step <= v.upper;
            let step = if inside { v.step } else { -v.step };
            let mut point = self.point();
            point.x[k] += step;
            (step, point)
        })
    }
}

/// Returns the fit with the smallest `chi^2`, ignoring failed fits.
pub(crate) fn closest(fits: Vec<Option<Fit>>) -> Option<Fit> {
    let left = |a: &Fit, b: &Fit| a.chi_squared().total_cmp(&b.chi_squared());
    fits.into_iter().flatten().min_by(left)
}
