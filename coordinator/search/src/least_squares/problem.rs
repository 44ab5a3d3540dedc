//! Variables, priors, settings and results of the least-squares search.
use nalgebra::{DMatrix, DVector};

/// Unknown of the least-squares problem, with bounds, step sizes and prior.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// Value of the variable at which the search starts.
    pub start: f64,
    /// Lower bound of the variable.
    pub lower: f64,
    /// Upper bound of the variable.
    pub upper: f64,
    /// First difference step; later steps are adapted to the change of the residual that a step causes.
    pub step: f64,
    /// Longest change of the variable in one step of the search; without it a variable that hardly changes
    /// the residual would go to a bound.
    pub longest: f64,
    /// Normal prior distribution of the variable, if any.
    pub prior: Option<Prior>,
}

impl Variable {
    /// Creates a variable without bounds that has a standard normal prior distribution and starts at its mean.
    pub const fn standard_normal() -> Self {
        Self {
            start: 0.0,
            lower: f64::NEG_INFINITY,
            upper: f64::INFINITY,
            step: 1.0,
            longest: f64::INFINITY,
            prior: Some(Prior {
                mean: 0.0,
                deviation: 1.0,
            }),
        }
    }
}

/// Normal prior distribution of an unknown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prior {
    /// Mean of the variable's prior distribution.
    pub mean: f64,
    /// Standard deviation of the prior, positive.
    pub deviation: f64,
}

/// Settings of the least-squares search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeastSquaresSettings {
    /// Maximum number of iterations, each of which computes a Jacobian.
    pub iterations: u32,
    /// Convergence threshold on the largest absolute cosine of the angle between a column of the Jacobian and
    /// the residual.
    pub gradient: f64,
    /// Convergence threshold on the relative decrease of the cost by a step.
    pub decrease: f64,
    /// Desired change of the residual (norm) by a difference step.
    pub change: f64,
    /// Largest factor by which a variable's finite-difference step may grow or shrink from its first value.
    pub step_range: f64,
    /// Additional damping of every variable besides that by its own curvature, as a share of the mean
    /// curvature over the variables; without it a variable that hardly changes the residual goes to its bound
    /// at any damping.
    pub level: f64,
    /// Whether Jacobian columns are central differences, second-order accurate at twice the number of points.
    pub central: bool,
    /// Whether a search that has converged with one-sided differences continues with central differences
    /// until it converges again, so that the error of the one-sided differences no longer shifts the minimum.
    pub finish: bool,
    /// Whether the evaluator is asked for exact Jacobian columns; only the columns that it does not return
    /// are computed by finite differences.
    pub exact: bool,
}

impl LeastSquaresSettings {
    /// Returns the default settings with at most `iterations` iterations, each of which computes a Jacobian.
    pub fn short(iterations: u32) -> Self {
        Self {
            iterations,
            ..Self::default()
        }
    }
}

impl Default for LeastSquaresSettings {
    fn default() -> Self {
        Self {
            iterations: 12,
            gradient: 1e-2,
            decrease: 1e-3,
            change: 2.0,
            step_range: 10.0,
            level: 0.0,
            central: false,
            finish: false,
            exact: false,
        }
    }
}

/// Reason why a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Termination {
    /// The gradient vanishes, or steps no longer lower the cost noticeably.
    Converged,
    /// No step lowers the cost, though the gradient does not vanish.
    Stalled,
    /// The maximum number of iterations was reached.
    Iterations,
    /// The start could not be evaluated.
    StartFailed,
}

/// Best point with its residual and Jacobian.
#[derive(Clone, Debug, PartialEq)]
pub struct Linearized {
    /// Coordinates of the point of linearisation, one per variable.
    pub x: Vec<f64>,
    /// Residual vector at the point of linearisation, length n.
    pub residual: DVector<f64>,
    /// Derivatives of the residual by the variables, n x number of variables; a column is zero if none of its
    /// finite-difference points could be evaluated.
    pub jacobian: DMatrix<f64>,
}

/// Result of evaluating a point: residual and known derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct EvaluatedPoint {
    /// Residual vector at the evaluated point.
    pub residual: DVector<f64>,
    /// Derivatives of the residual by the variables (columns of the Jacobian), in the order of the variables,
    /// if they were requested; `None` for a column that is not known. Empty if no column is known.
    pub columns: Vec<Option<DVector<f64>>>,
}

impl From<DVector<f64>> for EvaluatedPoint {
    fn from(residual: DVector<f64>) -> Self {
        let columns = Vec::new();
        Self { residual, columns }
    }
}
