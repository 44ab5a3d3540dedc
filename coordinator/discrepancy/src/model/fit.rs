//! A model that was fitted to a record, and what every test asks of it.
use crate::linear::evidence;
use crate::linear::tangent::Tangent;
use crate::model::unknowns::{Model, Point};
use crate::record::measured::Curves;
use nalgebra::DMatrix;
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

    /// How far it misfits: `max(1, chi^2 / n)`.
    pub fn misfit(&self) -> f64 {
        evidence::misfit(self.chi_squared(), self.entries())
    }

    /// The log evidence of the model (nats), up to a constant of the record.
    pub fn log_evidence(&self) -> f64 {
        evidence::log_evidence(self.search.best(), self.variables())
    }

    /// What its unknowns can absorb.
    pub fn tangent(&self) -> Tangent {
        Tangent::new(self.search.best(), self.variables())
    }

    /// Covariance of the unknowns, inflated by a misfit; nothing where one of them is left open.
    pub fn covariance(&self, misfit: f64) -> Option<DMatrix<f64>> {
        let jacobian = &self.search.best().jacobian;
        let mut curvature = jacobian.tr_mul(jacobian);
        for (k, v) in self.variables().iter().enumerate() {
            if let Some(prior) = v.prior {
                curvature[(k, k)] += 1.0 / (prior.deviation * prior.deviation);
            }
        }
        Some(curvature.cholesky()?.inverse() * (misfit * misfit))
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
