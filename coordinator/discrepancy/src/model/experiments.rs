//! Experiments on one record: the curves of points, and fits of models to it.
use crate::laboratory::{Laboratory, Stage, curves};
use crate::model::fit::Fit;
use crate::model::unknowns::{Model, Point};
use crate::record::measured::Curves;
use crate::record::whitened::WhitenedRecord;
use search::least_squares::{Ended, LeastSquares, Settings, Variable};

/// A laboratory, the record that its experiments are compared with, and the stage that they count for.
#[derive(Debug)]
pub struct Experiments<'a, L> {
    /// Who simulates.
    pub lab: &'a mut L,
    /// What simulations are compared with.
    pub on: &'a WhitenedRecord,
    /// The part of the diagnosis that asks.
    pub stage: Stage,
}

impl<L: Laboratory> Experiments<'_, L> {
    /// The same for another record.
    pub fn with<'b>(&'b mut self, on: &'b WhitenedRecord) -> Experiments<'b, L> {
        let (lab, stage) = (&mut *self.lab, self.stage);
        Experiments { lab, on, stage }
    }

    /// The same for another stage.
    pub fn during(&mut self, stage: Stage) -> Experiments<'_, L> {
        let (lab, on) = (&mut *self.lab, self.on);
        Experiments { lab, on, stage }
    }

    /// Simulated curves of points, in their order; nothing for one that failed.
    ///
    /// # Errors
    /// Those of the laboratory.
    pub async fn curves(&mut self, points: &[Point]) -> Result<Vec<Option<Curves>>, L::Error> {
        let (record, numerics) = (&self.on.record, &self.on.numerics);
        let experiment = |point: &Point| point.experiment(record.condition, numerics);
        let batch = points.iter().map(experiment).collect();
        curves(self.lab, self.stage, record, batch).await
    }

    /// Runs several fits side by side, so that their points fill one batch. A start that cannot be
    /// simulated is tried once more, a little beside.
    ///
    /// # Errors
    /// Those of the laboratory.
    pub async fn fits(
        &mut self,
        starts: Vec<Point>,
        how: Settings,
    ) -> Result<Vec<Option<Fit>>, L::Error> {
        let search = |start: Point| {
            let search = LeastSquares::new(start.model.variables(&start.x), how);
            (start.model, search)
        };
        let mut fits: Vec<(Model, LeastSquares)> = starts.into_iter().map(search).collect();
        let mut at_best: Vec<Option<Curves>> = vec![None; fits.len()];
        let mut nudged = vec![false; fits.len()];
        loop {
            for ((_, search), nudged) in fits.iter_mut().zip(&mut nudged) {
                if search.ended() == Some(Ended::StartFailed) && !*nudged {
                    *nudged = true;
                    *search = LeastSquares::new(beside(search.variables()), how);
                }
            }
            let plans: Vec<Vec<Vec<f64>>> = fits.iter().map(|(_, search)| search.plan()).collect();
            let planned = fits.iter().zip(&plans);
            let planned =
                planned.flat_map(|((model, _), plan)| plan.iter().map(move |x| (model, x)));
            let points: Vec<Point> = planned
                .map(|(model, x)| Point {
                    model: model.clone(),
                    x: x.clone(),
                })
                .collect();
            if points.is_empty() {
                break;
            }
            let mut results = self.curves(&points).await?.into_iter();
            for (((_, search), best), plan) in fits.iter_mut().zip(&mut at_best).zip(&plans) {
                if plan.is_empty() {
                    continue;
                }
                let own: Vec<Option<Curves>> = results.by_ref().take(plan.len()).collect();
                let whitened = own.iter().map(|c| c.as_ref().map(|c| self.on.residual(c)));
                search.absorb(whitened.collect());
                let arrived = plan.iter().position(|x| *x == search.best().x);
                if let Some(curves) = arrived.and_then(|k| own.into_iter().nth(k)) {
                    *best = curves;
                }
            }
        }
        let finished = |((model, search), curves): ((Model, LeastSquares), Option<Curves>)| {
            let curves = curves?;
            Some(Fit {
                model,
                search,
                curves,
            })
        };
        Ok(fits.into_iter().zip(at_best).map(finished).collect())
    }

    /// Runs one fit.
    ///
    /// # Errors
    /// Those of the laboratory.
    pub async fn fit(&mut self, start: Point, how: Settings) -> Result<Option<Fit>, L::Error> {
        let fits = self.fits(vec![start], how).await?;
        Ok(fits.into_iter().next().flatten())
    }
}

/// The same unknowns, starting a tenth of a difference step beside, away from the nearer bound.
fn beside(variables: &[Variable]) -> Vec<Variable> {
    let moved = |v: &Variable| {
        let upwards = v.upper - v.start > v.start - v.lower;
        let inwards = if upwards { 1.0 } else { -1.0 };
        Variable {
            start: v.start + 0.1 * inwards * v.step,
            ..v.clone()
        }
    };
    variables.iter().map(moved).collect()
}
