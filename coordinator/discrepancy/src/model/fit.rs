//! Model that was fitted to a record, with the quantities that the tests use.
use crate::linear::discrepancy::{Discrepancy, SmoothBasis};
use crate::linear::evidence::{self, log_mean};
use crate::linear::score::NullModel;
use crate::linear::tangent::Tangent;
use crate::model::unknowns::{FittedModel, Point};
use nalgebra::DMatrix;
use protocol::announce::EffectDescriptor;
use record::Curves;
use search::least_squares::{LeastSquares, Variable};
use serde::{Deserialize, Serialize};
use std::sync::{Arc, OnceLock};

/// Model with the final state of its fit.
#[derive(Clone, Debug)]
pub struct Fit {
    /// Model whose unknowns were fitted.
    pub model: FittedModel,
    /// Final state of the least-squares search: point, residual and Jacobian.
    pub search: LeastSquares,
    /// Simulated curves at the fitted point.
    pub curves: Curves,
    /// Waves of the smooth discrepancy with which the model competes, if it does.
    pub(crate) smooth: Option<Arc<SmoothBasis>>,
    /// Likeliest discrepancy beside the model with the log evidence that it gains, computed when it is first
    /// asked for.
    likeliest: OnceLock<Option<(Discrepancy, f64)>>,
}

/// Fitted model as a diagnosis reports it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FitSummary {
    /// Values of all unknowns of the case, in the units that the case declares.
    pub genes: Vec<f64>,
    /// Fitted values of the searched unknowns, as coordinates of the search space.
    pub coordinates: Vec<f64>,
    /// Identifiers of the effects that the model has in addition to those of the case.
    pub added: Vec<String>,
    /// Squared length of the whitened residual.
    pub chi_squared: f64,
    /// Number of entries of the whitened residual, which is also its expected squared length under noise alone.
    pub entries: usize,
    /// Share of the squared residual by which one more step is predicted to lower it.
    pub predicted_decrease: f64,
    /// Simulated curves at the fitted point.
    pub curves: Curves,
}

impl Fit {
    /// Returns what reports read of the fit.
    pub fn summary(&self) -> FitSummary {
        let x = self.x();
        FitSummary {
            genes: self.model.genes(x),
            coordinates: x[..self.model.space.dimension()].to_vec(),
            added: self.model.added.iter().map(|own| own.id.clone()).collect(),
            chi_squared: self.chi_squared(),
            entries: self.entries(),
            predicted_decrease: self.search.predicted_decrease(),
            curves: self.curves.clone(),
        }
    }

    /// Creates a fit from the final state of its search and the curves there. `smooth` are the waves of the
    /// smooth discrepancy with which it competes, if it does.
    pub fn new(
        model: FittedModel,
        (search, curves): (LeastSquares, Curves),
        smooth: Option<Arc<SmoothBasis>>,
    ) -> Self {
        Self {
            model,
            search,
            curves,
            smooth,
            likeliest: OnceLock::new(),
        }
    }

    /// Returns the same fit in competition with a smooth discrepancy.
    pub(crate) fn competing(self, smooth: Option<Arc<SmoothBasis>>) -> Self {
        Self::new(self.model, (self.search, self.curves), smooth)
    }

    /// Returns the smooth discrepancy that the model needs beside it; `None` if it is likeliest without one.
    pub fn discrepancy(&self) -> Option<&Discrepancy> {
        self.likeliest().map(|(own, _)| own)
    }

    fn likeliest(&self) -> Option<&(Discrepancy, f64)> {
        let smooth = self.smooth.as_ref()?;
        let found = self
            .likeliest
            .get_or_init(|| smooth.likeliest(self.search.best(), self.variables()));
        found.as_ref()
    }

    /// Returns the whitened waves of the discrepancy that the model needs, each times the standard deviation of
    /// its coefficient; no column if it needs none.
    pub(crate) fn waves(&self) -> DMatrix<f64> {
        self.waves_of(self.discrepancy())
    }

    /// Returns the whitened waves of a discrepancy, each times the standard deviation of its coefficient.
    pub(crate) fn waves_of(&self, discrepancy: Option<&Discrepancy>) -> DMatrix<f64> {
        let own = self.smooth.as_ref().zip(discrepancy);
        own.map_or_else(
            || DMatrix::zeros(self.entries(), 0),
            |(smooth, own)| smooth.scaled(own),
        )
    }

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

    /// Returns the variance of a residual entry in units of the noise variance, `max(1, chi^2 / (n - p))`.
    pub fn misfit(&self) -> f64 {
        (self.chi_squared() / self.freedom()).max(1.0)
    }

    /// Returns the dispersion by which differences of log likelihoods are divided (`McCullagh` & Nelder,
    /// *Generalized Linear Models*, 4.5): the misfit, or 1 where a smooth discrepancy stands for it.
    pub fn dispersion(&self) -> f64 {
        if self.discrepancy().is_some() {
            1.0
        } else {
            self.misfit()
        }
    }

    /// Returns the log evidence of the model with the smooth discrepancy that it needs (nats), up to a constant
    /// of the record.
    pub fn log_evidence(&self) -> f64 {
        let gained = self.likeliest().map_or(0.0, |(_, gained)| *gained);
        self.log_evidence_of_noise() + gained
    }

    /// Returns the log evidence of the model if all that it leaves were noise (nats), up to a constant of the
    /// record.
    pub(crate) fn log_evidence_of_noise(&self) -> f64 {
        evidence::log_evidence(self.search.best(), self.variables())
    }

    /// Returns the log evidence of the model with each of several discrepancies, or none (nats), up to a
    /// constant of the record; `NaN` where the information is singular.
    pub(crate) fn log_evidence_with(&self, among: &[Option<Discrepancy>]) -> Vec<f64> {
        let noise = self.log_evidence_of_noise();
        let gain = |own: &Discrepancy| {
            let smooth = self.smooth.as_ref()?;
            smooth.gain(self.search.best(), self.variables(), own)
        };
        let gain = |own: &Option<Discrepancy>| {
            let gained = own.as_ref().map(|own| gain(own).unwrap_or(f64::NAN));
            noise + gained.unwrap_or(0.0)
        };
        among.iter().map(gain).collect()
    }

    /// Returns the log evidence of the model averaged over several discrepancies (nats), up to a constant of the
    /// record.
    pub(crate) fn log_evidence_among(&self, among: &[Option<Discrepancy>]) -> f64 {
        log_mean(&self.log_evidence_with(among))
    }

    /// Returns the gain of log evidence over another model of the same record, averaged over the discrepancies
    /// that either needs and divided by the dispersion (nats).
    pub(crate) fn gain_over(&self, other: &Self) -> f64 {
        let among = self.discrepancies(other);
        let gained = self.log_evidence_among(&among) - other.log_evidence_among(&among);
        gained / self.dispersion().min(other.dispersion())
    }

    /// Returns the discrepancies over which the comparison of two models averages: none, and those that either
    /// needs. Up to three points stand for the distribution of amplitudes and length: the likeliest alone would
    /// claim a certainty that no record gives.
    pub(crate) fn discrepancies(&self, other: &Self) -> Vec<Option<Discrepancy>> {
        let needed = [self, other].map(|own| own.discrepancy().cloned());
        let mut among = vec![None];
        among.extend(needed.into_iter().flatten().map(Some));
        among
    }

    /// Returns the tangent space of the fitted model: the changes of the whitened residual that its unknowns
    /// can produce.
    pub fn tangent(&self) -> Tangent {
        Tangent::new(self.search.best(), self.variables())
    }

    /// Returns the fitted model as the null hypothesis of score tests.
    pub fn null_model(&self) -> NullModel {
        NullModel::new(self.search.best(), self.variables())
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
