//! A record with its metric, and the residuals of models under it: what every stage works on.
use crate::laboratory::{Laboratory, Stage, channels};
use crate::metric::Metric;
use crate::model::Model;
use crate::record::{Curves, Record};
use nalgebra::DVector;
use protocol::job::Refinement;
use search::least_squares::{Ended, LeastSquares, Settings, Variable};

/// A record under a metric.
#[derive(Clone, Debug)]
pub struct Bench {
    /// What was measured, calibration cycles only.
    pub record: Record,
    /// Its metric.
    pub metric: Metric,
    /// The whitened mean of the record.
    pub measured: DVector<f64>,
    /// How the model is discretised.
    pub refinement: Refinement,
}

/// A finished fit.
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
    /// The point.
    pub fn x(&self) -> &[f64] {
        &self.search.best().x
    }

    /// Squared length of the whitened residual.
    pub fn chi_squared(&self) -> f64 {
        self.search.best().residual.norm_squared()
    }

    /// The unknowns.
    pub fn variables(&self) -> &[Variable] {
        self.search.variables()
    }
}

impl Bench {
    /// Joins a record and a metric.
    pub fn new(record: Record, metric: Metric, refinement: Refinement) -> Self {
        let measured = metric.whiten(&record.mean());
        Self {
            record,
            metric,
            measured,
            refinement,
        }
    }

    /// Simulated curves of points, in their order; nothing for one that failed.
    ///
    /// # Errors
    /// Of the laboratory.
    pub async fn curves<L: Laboratory>(
        &self,
        lab: &mut L,
        stage: Stage,
        points: &[(&Model, &[f64])],
    ) -> Result<Vec<Option<Curves>>, L::Error> {
        let condition = self.record.condition;
        let batch = points
            .iter()
            .map(|(model, x)| model.experiment(x, condition, self.refinement))
            .collect();
        let observed = lab.observe(stage, batch).await?;
        let curves = |o: Option<protocol::job::Observation>| channels(&o?, &self.record.channels);
        Ok(observed.into_iter().map(curves).collect())
    }

    /// Residual of simulated curves: measured less simulated, whitened.
    pub fn residual(&self, curves: &Curves) -> DVector<f64> {
        &self.measured - self.metric.whiten(curves)
    }

    /// Runs several fits side by side, so that their points fill one batch. A start that cannot be
    /// simulated is tried once more, a little beside.
    ///
    /// # Errors
    /// Of the laboratory.
    pub async fn fit<L: Laboratory>(
        &self,
        lab: &mut L,
        stage: Stage,
        starts: Vec<(Model, Vec<f64>)>,
        settings: Settings,
    ) -> Result<Vec<Option<Fit>>, L::Error> {
        let mut fits: Vec<(Model, LeastSquares)> = starts
            .into_iter()
            .map(|(model, x)| {
                let search = LeastSquares::new(model.variables(&x), settings);
                (model, search)
            })
            .collect();
        let mut at_best: Vec<Option<Curves>> = vec![None; fits.len()];
        let mut nudged = vec![false; fits.len()];
        loop {
            for ((_, search), nudged) in fits.iter_mut().zip(&mut nudged) {
                if search.ended() == Some(Ended::StartFailed) && !*nudged {
                    *nudged = true;
                    *search = LeastSquares::new(beside(search.variables()), settings);
                }
            }
            let plans: Vec<Vec<Vec<f64>>> = fits.iter().map(|(_, search)| search.plan()).collect();
            let points: Vec<(&Model, &[f64])> = fits
                .iter()
                .zip(&plans)
                .flat_map(|((model, _), plan)| plan.iter().map(move |x| (model, x.as_slice())))
                .collect();
            if points.is_empty() {
                break;
            }
            let mut results = self.curves(lab, stage, &points).await?.into_iter();
            for (((_, search), best), plan) in fits.iter_mut().zip(&mut at_best).zip(&plans) {
                if plan.is_empty() {
                    continue;
                }
                let own: Vec<Option<Curves>> = results.by_ref().take(plan.len()).collect();
                let whitened = own.iter().map(|c| c.as_ref().map(|c| self.residual(c)));
                search.absorb(whitened.collect());
                let arrived = plan.iter().position(|x| *x == search.best().x);
                if let Some(curves) = arrived.and_then(|k| own.into_iter().nth(k)) {
                    *best = curves;
                }
            }
        }
        Ok(fits
            .into_iter()
            .zip(at_best)
            .map(|((model, search), curves)| {
                Some(Fit {
                    model,
                    search,
                    curves: curves?,
                })
            })
            .collect())
    }
}

/// The same unknowns, starting a tenth of a difference step beside, away from the nearer bound.
fn beside(variables: &[Variable]) -> Vec<Variable> {
    let moved = |v: &Variable| {
        let inwards = if v.upper - v.start > v.start - v.lower {
            1.0
        } else {
            -1.0
        };
        Variable {
            start: v.start + 0.1 * inwards * v.step,
            ..v.clone()
        }
    };
    variables.iter().map(moved).collect()
}
