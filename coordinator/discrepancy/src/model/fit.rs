//! A model that was fitted to a record, and what every test asks of it.
use crate::linear::evidence;
use crate::linear::tangent::Tangent;
use crate::model::unknowns::{Model, Point};
use crate::record::measured::Curves;
use protocol::announce::EffectDescriptor;
use search::least_squares::{LeastSquares, Variable};

/// A model at the end of its fit.
#[derive(Clone, Debug)]
pub struct Fit {
    /// What was fitted.
    pub model: Model,
    /// The search at its end: point, residual, Jacobian.
    pub search: LeastSquares,
    /// Curves of the point.
    pub curves: Curves,
}

impl Fit {
    /// The unknowns' values.
    pub fn x(&self) -> &[f64] {
        &self.search.best().x
    }

    /// The unknowns.
    pub fn variables(&self) -> &[Variable] {
        self.search.variables()
    }

    /// The model at these values.
    pub fn point(&self) -> Point {
        self.at(self.x().to_vec())
    }

    /// The model at other values.
    pub fn at(&self, x: Vec<f64>) -> Point {
        Point {
            model: self.model.clone(),
            x,
        }
    }

    /// The model with one more effect at scaled values of its parameters.
    pub fn with(&self, effect: &EffectDescriptor, own: &[f64]) -> Point {
        self.point().with(effect, own)
    }

    /// Squared length of the whitened residual.
    pub fn chi_squared(&self) -> f64 {
        self.search.best().residual.norm_squared()
    }

    /// Length of the whitened residual; its squared length where noise alone is left.
    pub fn entries(&self) -> usize {
        self.search.best().residual.len()
    }

    /// Degrees of freedom of the residual: `n - p`, at least 1.
    pub fn freedom(&self) -> f64 {
        (self.entries() as f64 - self.tangent().parameters()).max(1.0)
    }

    /// Variance of an entry of the residual in units of the noise's, `max(1, chi^2 / (n - p))`: the dispersion by which
    /// differences of log likelihoods are divided (`McCullagh` & Nelder, *Generalized Linear Models*, 4.5).
    pub fn dispersion(&self) -> f64 {
        (self.chi_squared() / self.freedom()).max(1.0)
    }

    /// The log evidence of the model (nats), up to a constant of the record.
    pub fn log_evidence(&self) -> f64 {
        evidence::log_evidence(self.search.best(), self.variables())
    }

    /// What its unknowns can absorb.
    pub fn tangent(&self) -> Tangent {
        Tangent::new(self.search.best(), self.variables())
    }

    /// Points beside this one, each with the signed step of the unknown that was moved: in its order,
    /// away from a bound that lies within the step.
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

/// Of fits, some of which failed, the one that leaves least.
pub(crate) fn closest(fits: Vec<Option<Fit>>) -> Option<Fit> {
    let left = |a: &Fit, b: &Fit| a.chi_squared().total_cmp(&b.chi_squared());
    fits.into_iter().flatten().min_by(left)
}
