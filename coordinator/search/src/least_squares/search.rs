//! Levenberg-Marquardt search as a sequence of batches: Jacobian columns, then a fan of damped steps.
use super::{
    differences::{self, Columns},
    problem::{EvaluatedPoint, LeastSquaresSettings, Linearized, Termination, Variable},
    step,
};
use nalgebra::{DMatrix, DVector};

/// Phase of the search, which determines the points planned next.
#[derive(Clone, Debug)]
enum Phase {
    Start,
    /// Evaluation of the best point again, this time with exact Jacobian columns.
    Exact,
    Columns(Columns),
    Fan(Vec<(f64, Vec<f64>)>),
    Over(Termination),
}

/// Levenberg-Marquardt search that plans batches of points and absorbs their residuals.
#[derive(Clone, Debug)]
pub struct LeastSquares {
    settings: LeastSquaresSettings,
    variables: Vec<Variable>,
    steps: Vec<f64>,
    at: Linearized,
    /// Whether the Jacobian was computed at the current best point.
    fresh: bool,
    cost: f64,
    damping: f64,
    iteration: u32,
    refused: u32,
    last_decrease: f64,
    failures: u64,
    evaluations: u64,
    phase: Phase,
}

/// Continuation of a search, as far as the results of its planned points are known.
#[derive(Clone, Debug)]
pub enum Anticipated {
    /// All results are there: the search with them absorbed.
    Certain(Box<LeastSquares>),
    /// Some results are awaited: points at which exact Jacobian columns may be requested next, likeliest first.
    Candidates(Vec<Vec<f64>>),
}

/// Returns the indices below `count` from both ends inwards, beginning with the last one. It is the order of
/// the steps of a fan by how often each was the best: in 58 fans of two `least-squares` searches of the shipped
/// case (seeds 1 and 2) the fifth 17, the first 17, the fourth 12, the second 7 and the third 5 times.
fn ends_first(count: usize) -> impl Iterator<Item = usize> {
    (0..count).map(move |rank| {
        if rank.is_multiple_of(2) {
            count - 1 - rank / 2
        } else {
            rank / 2
        }
    })
}

impl LeastSquares {
    /// Creates a search from the variables' starts, clamped into their boxes.
    pub fn new(variables: Vec<Variable>, settings: LeastSquaresSettings) -> Self {
        let x = variables
            .iter()
            .map(|v| v.start.clamp(v.lower, v.upper))
            .collect();
        Self {
            steps: variables.iter().map(|v| v.step).collect(),
            at: Linearized {
                x,
                residual: DVector::zeros(0),
                jacobian: DMatrix::zeros(0, variables.len()),
            },
            fresh: false,
            cost: f64::INFINITY,
            damping: 1e-2,
            iteration: 0,
            refused: 0,
            last_decrease: 1.0,
            failures: 0,
            evaluations: 0,
            phase: Phase::Start,
            settings,
            variables,
        }
    }

    /// Creates a search from a point whose residual is known already; only its Jacobian is missing.
    pub fn from_known(
        mut variables: Vec<Variable>,
        settings: LeastSquaresSettings,
        known: (&[f64], DVector<f64>),
    ) -> Self {
        for (variable, x) in variables.iter_mut().zip(known.0) {
            variable.start = *x;
        }
        let mut search = Self::new(variables, settings);
        search.accept_point(known.1);
        search
    }

    /// Returns the points to evaluate now, in the order in which [`Self::absorb`] takes their residuals;
    /// empty when the search is over.
    pub fn plan(&self) -> Vec<Vec<f64>> {
        match &self.phase {
            Phase::Start | Phase::Exact => vec![self.at.x.clone()],
            Phase::Columns(columns) => columns.points(&self.at.x),
            Phase::Fan(fan) => fan.iter().map(|(_, x)| x.clone()).collect(),
            Phase::Over(_) => Vec::new(),
        }
    }

    /// Returns whether the planned points are to be evaluated together with the derivatives of their
    /// residuals by all variables.
    pub const fn wants_columns(&self) -> bool {
        self.settings.exact && matches!(self.phase, Phase::Start | Phase::Exact)
    }

    /// Absorbs the results of the planned points; `None` for a point that could not be evaluated. All
    /// residuals of a search have the same length.
    pub fn absorb<E: Into<EvaluatedPoint>>(&mut self, found: Vec<Option<E>>) {
        let found: Vec<Option<EvaluatedPoint>> =
            found.into_iter().map(|e| e.map(Into::into)).collect();
        self.evaluations += found.len() as u64;
        self.failures += found.iter().filter(|e| e.is_none()).count() as u64;
        let (residuals, mut columns): (Vec<_>, Vec<_>) = found
            .into_iter()
            .map(|e| e.map_or((None, Vec::new()), |e| (Some(e.residual), e.columns)))
            .unzip();
        let known = columns.pop().filter(|_| self.wants_columns());
        match std::mem::replace(&mut self.phase, Phase::Over(Termination::StartFailed)) {
            Phase::Start => {
                if let Some(residual) = residuals.into_iter().next().flatten() {
                    self.place(residual);
                    self.plan_columns(known.unwrap_or_default());
                }
            }
            Phase::Exact => self.plan_columns(known.unwrap_or_default()),
            Phase::Columns(columns) => self.columns(columns, residuals),
            Phase::Fan(fan) => self.fan(fan, residuals),
            Phase::Over(ended) => self.phase = Phase::Over(ended),
        }
    }

    /// Returns the search as it will be after the planned points, if their results are all there; otherwise
    /// the points at which its next Jacobian may be computed, likeliest first. `found` holds the results of
    /// the planned points in their order; `None` for those still awaited.
    pub fn anticipate(&self, found: Vec<Option<Option<EvaluatedPoint>>>) -> Anticipated {
        let awaited: Vec<bool> = found.iter().map(Option::is_none).collect();
        if !awaited.contains(&true) {
            let mut next = self.clone();
            next.absorb(found.into_iter().flatten().collect());
            return Anticipated::Certain(Box::new(next));
        }
        let (Phase::Fan(fan), true) = (&self.phase, self.settings.exact) else {
            return Anticipated::Candidates(Vec::new());
        };
        let mut best: Option<(f64, &[f64])> = None;
        for ((_, x), found) in fan.iter().zip(found) {
            let Some(point) = found.flatten() else {
                continue;
            };
            let cost = point.residual.norm_squared() + step::prior_cost(x, &self.variables);
            if cost < best.map_or(self.cost, |(least, _)| least) {
                best = Some((cost, x));
            }
        }
        let ends_first = ends_first(fan.len()).filter(|index| awaited[*index]);
        let candidates = best.map(|(_, x)| x).into_iter();
        let candidates = candidates.chain(ends_first.map(|index| &fan[index].1[..]));
        Anticipated::Candidates(candidates.map(<[f64]>::to_vec).collect())
    }

    /// Returns why the search ended; `None` while it is running.
    pub const fn ended(&self) -> Option<Termination> {
        match self.phase {
            Phase::Over(ended) => Some(ended),
            Phase::Start | Phase::Exact | Phase::Columns(_) | Phase::Fan(_) => None,
        }
    }

    /// Returns the best point with its residual and Jacobian. When the search is over, the Jacobian is that
    /// at this point.
    pub const fn best(&self) -> &Linearized {
        &self.at
    }

    /// Returns the unknowns of the search.
    pub fn variables(&self) -> &[Variable] {
        &self.variables
    }

    /// Returns the cost at the best point: `|r|^2` plus the contribution of the priors.
    pub const fn cost(&self) -> f64 {
        self.cost
    }

    /// Returns the number of points evaluated, and how many of these evaluations failed.
    pub const fn work(&self) -> (u64, u64) {
        (self.evaluations, self.failures)
    }

    /// Returns the largest cosine between a column of the Jacobian, with its prior, and the residual; 0 at an
    /// exact minimum. Variables pressed against a bound do not count.
    pub fn gradient_ratio(&self) -> f64 {
        step::gradient_ratio(&self.at, &self.variables, self.cost)
    }

    /// Returns the residual at the minimum of the linearised problem: the residual itself if the search has
    /// converged, otherwise a first-order prediction of the residual at convergence.
    pub fn linear_minimum_residual(&self) -> DVector<f64> {
        step::linear_minimum(&self.at, &self.variables).residual
    }

    /// Returns the relative decrease of the cost that the linearised problem predicts for one more step.
    pub fn predicted_decrease(&self) -> f64 {
        let settled = self.linear_minimum_residual().norm_squared();
        ((self.at.residual.norm_squared() - settled) / self.cost).max(0.0)
    }

    fn place(&mut self, residual: DVector<f64>) {
        self.at.residual = residual;
        self.cost = self.at.residual.norm_squared() + step::prior_cost(&self.at.x, &self.variables);
        self.fresh = false;
    }

    /// Accepts the search's current point, given its residual, and plans the evaluation of its Jacobian.
    fn accept_point(&mut self, residual: DVector<f64>) {
        self.place(residual);
        if self.settings.exact {
            self.phase = Phase::Exact;
        } else {
            self.plan_columns(Vec::new());
        }
    }

    /// Plans finite-difference points for those columns of the Jacobian that are `None` in `known`.
    fn plan_columns(&mut self, known: Vec<Option<DVector<f64>>>) {
        // who knows no column at all is not asked again
        self.settings.exact &= known.iter().any(Option::is_some);
        let how = (&self.steps[..], self.settings.central);
        let columns = Columns::new(&self.at.x, &self.variables, how, known);
        self.columns_absorbed(columns);
    }

    fn columns(&mut self, mut columns: Columns, residuals: Vec<Option<DVector<f64>>>) {
        columns.absorb(&self.at.x, &self.variables, residuals);
        self.columns_absorbed(columns);
    }

    /// Stores the collected Jacobian columns; once all are complete, computes the Jacobian and either ends
    /// the search or plans the next fan of damped steps.
    fn columns_absorbed(&mut self, columns: Columns) {
        if !columns.is_complete() {
            self.phase = Phase::Columns(columns);
            return;
        }
        let (jacobian, changes) = columns.jacobian(&self.at.residual, self.variables.len());
        self.at.jacobian = jacobian;
        self.fresh = true;
        self.iteration += 1;
        for (step, (variable, change)) in self
            .steps
            .iter_mut()
            .zip(self.variables.iter().zip(changes))
        {
            *step = differences::next_step(*step, variable, change, &self.settings);
        }
        let small = self.last_decrease < self.settings.decrease;
        let converged = small || self.gradient_ratio() < self.settings.gradient;
        let differenced = self.settings.finish && !self.settings.exact;
        if converged && differenced && !self.settings.central {
            self.settings.central = true;
            self.last_decrease = 1.0;
            self.plan_columns(Vec::new());
        } else if converged {
            self.phase = Phase::Over(Termination::Converged);
        } else if self.iteration >= self.settings.iterations {
            self.phase = Phase::Over(Termination::Iterations);
        } else {
            self.refused = 0;
            self.plan_fan();
        }
    }

    fn plan_fan(&mut self) {
        let fan = step::fan(
            &self.at,
            &self.variables,
            (self.damping, self.settings.level),
        );
        self.phase = if fan.is_empty() {
            Phase::Over(Termination::Stalled)
        } else {
            Phase::Fan(fan)
        };
    }

    fn fan(&mut self, fan: Vec<(f64, Vec<f64>)>, residuals: Vec<Option<DVector<f64>>>) {
        let mut best: Option<(f64, f64, Vec<f64>, DVector<f64>)> = None;
        for ((damping, x), residual) in fan.into_iter().zip(residuals) {
            let Some(residual) = residual else { continue };
            let cost = residual.norm_squared() + step::prior_cost(&x, &self.variables);
            if best.as_ref().is_none_or(|(least, ..)| cost < *least) {
                best = Some((cost, damping, x, residual));
            }
        }
        match best {
            Some((cost, damping, x, residual)) if cost < self.cost => {
                self.last_decrease = (self.cost - cost) / self.cost;
                self.damping = damping.max(1e-9);
                self.at.x = x;
                self.accept_point(residual);
            }
            _ => {
                self.refused += 1;
                self.damping *= step::REFUSED;
                if self.refused < 3 {
                    self.plan_fan();
                } else {
                    let flat = self.gradient_ratio() < 10.0 * self.settings.gradient;
                    self.phase = Phase::Over(if flat {
                        Termination::Converged
                    } else {
                        Termination::Stalled
                    });
                }
            }
        }
    }
}
