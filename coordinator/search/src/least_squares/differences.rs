//! Finite-difference columns of a Jacobian, except the columns known exactly; a column whose displaced points
//! all failed is retried once on the opposite side.
use super::problem::{LeastSquaresSettings, Variable};
use nalgebra::{DMatrix, DVector};

/// Point displaced along one variable for a finite difference: its step and its result.
#[derive(Clone, Debug)]
pub(super) struct Difference {
    variable: usize,
    /// Signed displacement of the variable for the finite difference.
    step: f64,
    found: DifferenceState,
}

/// Result at a point displaced for a finite difference.
#[derive(Clone, Debug)]
enum DifferenceState {
    Awaited,
    /// Residual vector at the displaced point.
    Residual(DVector<f64>),
    /// The displaced point could not be evaluated.
    Failed,
}

impl DifferenceState {
    const fn residual(&self) -> Option<&DVector<f64>> {
        match self {
            Self::Residual(residual) => Some(residual),
            Self::Awaited | Self::Failed => None,
        }
    }
}

/// Jacobian columns being collected at one point, known exactly or from finite differences.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    differences: Vec<Difference>,
    retried: bool,
    /// Exactly known Jacobian columns, indexed by variable; `None` where a column is determined by finite
    /// differences.
    known: Vec<Option<DVector<f64>>>,
}

impl Columns {
    pub(super) fn new(
        x: &[f64],
        variables: &[Variable],
        (steps, central): (&[f64], bool),
        known: Vec<Option<DVector<f64>>>,
    ) -> Self {
        let mut differences = Vec::new();
        for (variable, v) in variables.iter().enumerate() {
            if known.get(variable).is_some_and(Option::is_some) {
                continue;
            }
            let up = steps[variable];
            // a variable beside its bound is differenced inwards
            let (first, second) = if x[variable] + up <= v.upper {
                (up, -up)
            } else {
                (-up, up)
            };
            let mut add = |step: f64| {
                let moved = x[variable] + step;
                if moved >= v.lower && moved <= v.upper {
                    differences.push(Difference {
                        variable,
                        step,
                        found: DifferenceState::Awaited,
                    });
                }
            };
            add(first);
            if central {
                add(second);
            }
        }
        Self {
            differences,
            retried: false,
            known,
        }
    }

    fn open(&self) -> impl Iterator<Item = &Difference> {
        self.differences
            .iter()
            .filter(|d| matches!(d.found, DifferenceState::Awaited))
    }

    /// Returns the points displaced from `x` for finite differences that are still to be evaluated.
    pub(super) fn points(&self, x: &[f64]) -> Vec<Vec<f64>> {
        let point = |d: &Difference| {
            let mut point = x.to_vec();
            point[d.variable] += d.step;
            point
        };
        self.open().map(point).collect()
    }

    pub(super) fn absorb(
        &mut self,
        x: &[f64],
        variables: &[Variable],
        residuals: Vec<Option<DVector<f64>>>,
    ) {
        let awaited = self
            .differences
            .iter_mut()
            .filter(|d| matches!(d.found, DifferenceState::Awaited));
        for (difference, residual) in awaited.zip(residuals) {
            difference.found = residual.map_or(DifferenceState::Failed, DifferenceState::Residual);
        }
        if !self.retried {
            self.retried = true;
            self.retry(x, variables);
        }
    }

    /// Adds, for every Jacobian column none of whose displaced points could be evaluated, one more point on
    /// the opposite side with half the step.
    fn retry(&mut self, x: &[f64], variables: &[Variable]) {
        let mut again = Vec::new();
        for (variable, v) in variables.iter().enumerate() {
            let mut own = self.differences.iter().filter(|d| d.variable == variable);
            let Some(first) = own.clone().next() else {
                continue;
            };
            let step = -0.5 * first.step;
            let moved = x[variable] + step;
            let evaluated = own.any(|d| d.found.residual().is_some());
            if !evaluated && moved >= v.lower && moved <= v.upper {
                again.push(Difference {
                    variable,
                    step,
                    found: DifferenceState::Awaited,
                });
            }
        }
        self.differences.extend(again);
    }

    pub(super) fn is_complete(&self) -> bool {
        self.open().next().is_none()
    }

    /// Returns the Jacobian, and for each variable the largest change of the residual (norm) that a
    /// difference step caused; 0 for a variable that was not differenced.
    pub(super) fn jacobian(
        &self,
        residual: &DVector<f64>,
        count: usize,
    ) -> (DMatrix<f64>, Vec<f64>) {
        let mut jacobian = DMatrix::zeros(residual.len(), count);
        let mut changes = vec![0.0; count];
        for variable in 0..count {
            if let Some(Some(known)) = self.known.get(variable) {
                jacobian.set_column(variable, known);
                continue;
            }
            let own: Vec<(f64, &DVector<f64>)> = self
                .differences
                .iter()
                .filter(|d| d.variable == variable)
                .filter_map(|d| Some((d.step, d.found.residual()?)))
                .collect();
            let column = match own.as_slice() {
                [] => continue,
                [(step, there)] => (*there - residual) / *step,
                [(a, at_a), (b, at_b), ..] => (*at_a - *at_b) / (a - b),
            };
            changes[variable] = own
                .iter()
                .map(|(_, there)| (*there - residual).norm())
                .fold(0.0, f64::max);
            jacobian.set_column(variable, &column);
        }
        (jacobian, changes)
    }
}

/// Returns the difference step of a variable for the next Jacobian: the step for which the residual would
/// have changed by `settings.change`, limited to a factor of `settings.step_range` from the variable's first
/// step.
pub(super) fn next_step(
    step: f64,
    variable: &Variable,
    change: f64,
    settings: &LeastSquaresSettings,
) -> f64 {
    let wanted = if change > 0.0 {
        step * (settings.change / change).clamp(0.1, 10.0)
    } else {
        step
    };
    let range = settings.step_range;
    wanted.clamp(variable.step / range, variable.step * range)
}
