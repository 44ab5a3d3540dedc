//! Finite-difference columns of a Jacobian, except those already known; a column whose points all failed is
//! retried once on the opposite side.
use super::problem::{Settings, Variable};
use nalgebra::{DMatrix, DVector};

/// Difference point of one variable: its step and its result.
#[derive(Clone, Debug)]
pub(super) struct Difference {
    variable: usize,
    /// Signed difference step.
    step: f64,
    found: Found,
}

/// Result of evaluating a difference point.
#[derive(Clone, Debug)]
enum Found {
    Awaited,
    /// Residual at the difference point.
    Residual(DVector<f64>),
    /// The point could not be evaluated.
    Failed,
}

impl Found {
    const fn residual(&self) -> Option<&DVector<f64>> {
        match self {
            Self::Residual(residual) => Some(residual),
            Self::Awaited | Self::Failed => None,
        }
    }
}

/// Jacobian columns being collected at one point, known or by differences.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    differences: Vec<Difference>,
    retried: bool,
    /// Columns known without differences, indexed by variable; `None` where a column must be differenced.
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
                        found: Found::Awaited,
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
            .filter(|d| matches!(d.found, Found::Awaited))
    }

    /// Returns the points still to be evaluated.
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
            .filter(|d| matches!(d.found, Found::Awaited));
        for (difference, residual) in awaited.zip(residuals) {
            difference.found = residual.map_or(Found::Failed, Found::Residual);
        }
        if !self.retried {
            self.retried = true;
            self.retry(x, variables);
        }
    }

    /// Adds, for every column without a single evaluated point, one more point on the opposite side with half
    /// the step.
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
                    found: Found::Awaited,
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

/// Returns the difference step that would have changed the residual by `settings.change`, limited to
/// `settings.step_range` about the variable's first step.
pub(super) fn next_step(step: f64, variable: &Variable, change: f64, settings: &Settings) -> f64 {
    let wanted = if change > 0.0 {
        step * (settings.change / change).clamp(0.1, 10.0)
    } else {
        step
    };
    let range = settings.step_range;
    wanted.clamp(variable.step / range, variable.step * range)
}
