//! Simulations for one record: curves of points and their derivatives, and fits of models to the record.
use crate::laboratory::{Laboratory, Stage, channels};
use crate::linear::whitened::WhitenedRecord;
use crate::model::derivative::DerivativeRequest;
use crate::model::fit::Fit;
use crate::model::unknowns::{FittedModel, Point};
use protocol::job::{Column, Derivative, Observation, SimulateSpec};
use record::{Curves, Record, Recorded, difference};
use search::derivative::DerivativeTerm;
use search::least_squares::{
    EvaluatedPoint, LeastSquares, LeastSquaresSettings, Termination, Variable,
};
use search::strategy::Residual;

/// Context for running simulations: the laboratory, the record with which simulations are compared, and the
/// stage of the diagnosis whose budget they use.
#[derive(Debug)]
pub struct Experiments<'a, L> {
    /// Laboratory that runs the simulations.
    pub lab: &'a mut L,
    /// Record with which simulations are compared.
    pub on: &'a WhitenedRecord,
    /// Stage of the diagnosis to whose budget the simulations are charged.
    pub stage: Stage,
}

impl<L: Laboratory> Experiments<'_, L> {
    /// Returns this context for simulations that are compared with another record.
    pub fn for_record<'b>(&'b mut self, on: &'b WhitenedRecord) -> Experiments<'b, L> {
        let (lab, stage) = (&mut *self.lab, self.stage);
        Experiments { lab, on, stage }
    }

    /// Returns this context for simulations that are charged to the budget of another stage.
    pub fn for_stage(&mut self, stage: Stage) -> Experiments<'_, L> {
        let (lab, on) = (&mut *self.lab, self.on);
        Experiments { lab, on, stage }
    }

    /// Simulates the curves of points, in their order; `None` for a point that failed.
    ///
    /// # Errors
    /// Those of the laboratory.
    pub async fn curves(&mut self, points: &[Point]) -> Result<Vec<Option<Curves>>, L::Error> {
        let wanted = points
            .iter()
            .map(|point| DerivativeRequest::new(point.clone(), false));
        let seen = self.simulate(&self.on.record, wanted.collect()).await?;
        Ok(seen.into_iter().map(|seen| Some(seen?.curves)).collect())
    }

    /// Computes the residuals of points, with their derivatives by the case's unknowns where these are
    /// requested and the laboratory provides them; `None` for a point that failed.
    ///
    /// # Errors
    /// Those of the laboratory.
    pub(crate) async fn residuals(
        &mut self,
        points: &[(Point, bool)],
    ) -> Result<Vec<Option<Residual>>, L::Error> {
        let (on, exact) = (self.on, self.lab.differentiates());
        let columns = |point: &Point, wanted: bool| {
            let space = &point.model.space;
            let axes = 0..if wanted && exact {
                space.dimension()
            } else {
                0
            };
            let moved = axes.flat_map(|axis| space.rates(axis, point.x[axis]));
            let columns = moved.map(|(_, name, _)| Column::new(name));
            columns.collect::<Vec<Column>>()
        };
        let experiment = |(point, wanted): &(Point, bool)| SimulateSpec {
            columns: columns(point, *wanted),
            ..point.experiment(on.record.condition, &on.numerics)
        };
        let batch = points.iter().map(experiment).collect();
        let observed = self.lab.observe(self.stage, batch).await?;
        let residual = |((point, wanted), seen): (&(Point, bool), Option<Observation>)| {
            let seen = seen?;
            let mut curves = channels(&seen, &on.record)?;
            point.apply_gains(&on.record, &mut curves);
            let columns = columns(point, *wanted).into_iter().zip(seen.columns);
            let by = columns.map(|(column, by)| (column.name, whitened(&by, on, point)));
            Some(Residual {
                values: on.residual(&curves).as_slice().to_vec(),
                derivatives: by.collect(),
            })
        };
        Ok(points.iter().zip(observed).map(residual).collect())
    }

    /// Simulates points under the condition of a record, with the requested derivatives; `None` for a point
    /// that failed.
    async fn simulate(
        &mut self,
        record: &Record,
        wanted: Vec<DerivativeRequest>,
    ) -> Result<Vec<Option<Linearization>>, L::Error> {
        let numerics = &self.on.numerics;
        let experiment = |wanted: &DerivativeRequest| SimulateSpec {
            columns: wanted.columns(),
            ..wanted.point.experiment(record.condition, numerics)
        };
        let batch = wanted.iter().map(experiment).collect();
        let observed = self.lab.observe(self.stage, batch).await?;
        let seen = |(wanted, seen): (DerivativeRequest, Option<Observation>)| {
            let seen = seen?;
            let mut curves = channels(&seen, record)?;
            let changes = wanted.changes(&seen.columns, (record, &curves));
            wanted.point.apply_gains(record, &mut curves);
            Some(Linearization { curves, changes })
        };
        Ok(wanted.into_iter().zip(observed).map(seen).collect())
    }

    /// Computes first-order changes of a fit's simulated curves, each by one chain-rule term; `None` where
    /// there is no term or the laboratory does not compute derivatives.
    pub(crate) async fn changes(
        &mut self,
        fit: &Fit,
        terms: Vec<Option<DerivativeTerm>>,
    ) -> Result<Vec<Option<Curves>>, L::Error> {
        /// Maximum number of derivative terms per simulation. A larger number lowers the cost per term; a
        /// smaller one spreads the terms over more worker slots.
        const TOGETHER: usize = 80;
        let mut changes = vec![None; terms.len()];
        if !self.lab.differentiates() {
            return Ok(changes);
        }
        let there = terms.into_iter().enumerate();
        let (places, terms): (Vec<usize>, Vec<DerivativeTerm>) = there
            .filter_map(|(place, term)| Some((place, term?)))
            .unzip();
        let together = |terms: &[DerivativeTerm]| DerivativeRequest::with_terms(fit.point(), terms);
        let wanted: Vec<DerivativeRequest> = terms.chunks(TOGETHER).map(together).collect();
        let seen = self.simulate(&self.on.record, wanted).await?;
        for (places, seen) in places.chunks(TOGETHER).zip(seen) {
            for (place, change) in places.iter().zip(seen.into_iter().flat_map(|s| s.changes)) {
                changes[*place] = change;
            }
        }
        Ok(changes)
    }

    /// Computes the curves of a fit on a record and their derivatives by each of its unknowns, from the
    /// laboratory's derivatives or else by finite differences. Returns `None` where the point itself fails;
    /// the derivative by an unknown whose difference fails is `None`.
    pub(crate) async fn linearized(
        &mut self,
        fit: &Fit,
        record: &Record,
    ) -> Result<Option<Linearization>, L::Error> {
        let neighbours: Vec<(f64, Point)> = fit.neighbours().collect();
        let exact = self.lab.differentiates();
        let mut wanted = vec![DerivativeRequest::new(fit.point(), exact)];
        let beside = |point: &Point| DerivativeRequest::new(point.clone(), false);
        if !exact {
            wanted.extend(neighbours.iter().map(|(_, point)| beside(point)));
        }
        let mut seen = self.simulate(record, wanted).await?.into_iter();
        let Some(mut own) = seen.next().flatten() else {
            return Ok(None);
        };
        own.changes.resize(neighbours.len(), None);
        let open: Vec<usize> = (0..neighbours.len())
            .filter(|k| own.changes[*k].is_none())
            .collect();
        let rest = if exact {
            let wanted = open.iter().map(|k| beside(&neighbours[*k].1));
            self.simulate(record, wanted.collect()).await?
        } else {
            seen.collect()
        };
        for (k, there) in open.into_iter().zip(rest) {
            let change =
                |there: Linearization| difference(&there.curves, &own.curves, neighbours[k].0);
            own.changes[k] = there.map(change);
        }
        Ok(Some(own))
    }

    /// Runs several fits side by side, so that their points fill one batch. A fit whose start cannot be
    /// simulated is started once more at a slightly shifted point.
    ///
    /// # Errors
    /// Those of the laboratory.
    pub async fn fits(
        &mut self,
        starts: Vec<Point>,
        how: LeastSquaresSettings,
    ) -> Result<Vec<Option<Fit>>, L::Error> {
        let how = LeastSquaresSettings {
            exact: self.lab.differentiates(),
            ..how
        };
        let search = |start: Point| {
            let search = LeastSquares::new(start.model.variables(&start.x), how);
            (start.model, search)
        };
        let mut fits: Vec<(FittedModel, LeastSquares)> = starts.into_iter().map(search).collect();
        let mut at_best: Vec<Option<Curves>> = vec![None; fits.len()];
        let mut nudged = vec![false; fits.len()];
        loop {
            for ((_, search), nudged) in fits.iter_mut().zip(&mut nudged) {
                if search.ended() == Some(Termination::StartFailed) && !*nudged {
                    *nudged = true;
                    *search = LeastSquares::new(shifted_start(search.variables()), how);
                }
            }
            let plans: Vec<Vec<Vec<f64>>> = fits.iter().map(|(_, search)| search.plan()).collect();
            let planned = fits.iter().zip(&plans);
            let wanted = planned.flat_map(|((model, search), plan)| {
                let point = |x: &Vec<f64>| Point {
                    model: model.clone(),
                    x: x.clone(),
                };
                let exact = search.wants_columns();
                plan.iter()
                    .map(move |x| DerivativeRequest::new(point(x), exact))
            });
            let wanted: Vec<DerivativeRequest> = wanted.collect();
            if wanted.is_empty() {
                break;
            }
            let mut results = self.simulate(&self.on.record, wanted).await?.into_iter();
            for (((_, search), best), plan) in fits.iter_mut().zip(&mut at_best).zip(&plans) {
                if plan.is_empty() {
                    continue;
                }
                let own: Vec<Option<Linearization>> = results.by_ref().take(plan.len()).collect();
                let whitened = own
                    .iter()
                    .map(|seen| Some(seen.as_ref()?.whitened(self.on)));
                search.absorb(whitened.collect::<Vec<Option<EvaluatedPoint>>>());
                let arrived = plan.iter().position(|x| *x == search.best().x);
                // an evaluation for the derivatives that is lost loses no curves
                if let Some(seen) = arrived.and_then(|k| own.into_iter().nth(k)?) {
                    *best = Some(seen.curves);
                }
            }
        }
        let finished =
            |((model, search), curves): ((FittedModel, LeastSquares), Option<Curves>)| {
                let curves = curves?;
                Some(Fit::new(model, (search, curves), self.on.smooth.clone()))
            };
        Ok(fits.into_iter().zip(at_best).map(finished).collect())
    }

    /// Fits a model to the record from a start point; `None` if the fit failed.
    ///
    /// # Errors
    /// Those of the laboratory.
    pub async fn fit(
        &mut self,
        start: Point,
        how: LeastSquaresSettings,
    ) -> Result<Option<Fit>, L::Error> {
        let fits = self.fits(vec![start], how).await?;
        Ok(fits.into_iter().next().flatten())
    }
}

/// Converts a derivative of the curves into the derivative of the whitened residual, which is measured less
/// simulated.
fn whitened(by: &Derivative, on: &WhitenedRecord, point: &Point) -> Derivative {
    let Derivative::Curves { per, curves } = by else {
        return by.clone();
    };
    let own = |recorded: &Recorded| {
        let curve = recorded.pick(curves.get(recorded.curve)?)?;
        Some(curve.into_iter().map(f64::from).collect())
    };
    let own: Option<Curves> = on.record.channels.iter().map(own).collect();
    let Some(mut own) = own else {
        let reason = "the derivative lacks a channel of the record".to_owned();
        return Derivative::Missing { reason };
    };
    point.apply_gains(&on.record, &mut own);
    #[expect(
        clippy::cast_possible_truncation,
        reason = "derivatives travel in single precision"
    )]
    let single = on.metric.whiten(&own).iter().map(|x| -*x as f32).collect();
    Derivative::Curves {
        per: per.clone(),
        curves: vec![single],
    }
}

/// Curves at a point, with the requested derivatives.
pub(crate) struct Linearization {
    pub(crate) curves: Curves,
    pub(crate) changes: Vec<Option<Curves>>,
}

impl Linearization {
    /// Whitens the residual (measured less simulated) and its derivatives in the metric of a record.
    fn whitened(&self, on: &WhitenedRecord) -> EvaluatedPoint {
        let column = |change: &Option<Curves>| Some(-on.metric.whiten(change.as_ref()?));
        EvaluatedPoint {
            residual: on.residual(&self.curves),
            columns: self.changes.iter().map(column).collect(),
        }
    }
}

/// Returns the variables with each start shifted by a tenth of its difference step, away from the nearer
/// bound.
fn shifted_start(variables: &[Variable]) -> Vec<Variable> {
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
