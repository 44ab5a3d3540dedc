//! What is searched, how, and what is known of it.
use nalgebra::{DMatrix, DVector};

/// One unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// Where the search starts.
    pub start: f64,
    /// Least value.
    pub lower: f64,
    /// Greatest value.
    pub upper: f64,
    /// First difference step; later ones follow what a step changes.
    pub step: f64,
    /// How far one step of the search may move it: what hardly changes the residual would else go to a bound.
    pub longest: f64,
    /// What is known beforehand.
    pub prior: Option<Prior>,
}

/// A normal distribution of an unknown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prior {
    /// Its mean.
    pub mean: f64,
    /// Its standard deviation, positive.
    pub deviation: f64,
}

/// How the search goes about it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Most Jacobians.
    pub iterations: u32,
    /// Converged when no column of the Jacobian has a larger cosine with the residual.
    pub gradient: f64,
    /// Converged when a step lowers the cost by less than this share of it.
    pub decrease: f64,
    /// By how much a difference step should change the residual (in the norm of the residual).
    pub change: f64,
    /// How far the difference step may move from its first value, as a factor either way.
    pub step_range: f64,
    /// What a step is damped by beside a variable's own curvature: this share of the mean one. Without it what
    /// hardly changes the residual goes to its bound at any damping.
    pub level: f64,
    /// Whether columns are central differences: twice the points, second-order accurate.
    pub central: bool,
    /// Whether a search by one-sided differences that has converged goes on with central ones until it has
    /// converged once more: their error moves the minimum no longer.
    pub finish: bool,
    /// Whether whoever evaluates may know columns: they are asked for, and only those that it has not are
    /// differenced.
    pub exact: bool,
}

impl Settings {
    /// The default with at most so many Jacobians.
    pub fn short(iterations: u32) -> Self {
        Self {
            iterations,
            ..Self::default()
        }
    }
}

impl Default for Settings {
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

/// Why a search is over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// The gradient vanishes, or steps no longer pay.
    Converged,
    /// No step lowers the cost, though the gradient does not vanish.
    Stalled,
    /// The iterations are used up.
    Iterations,
    /// The start could not be evaluated.
    StartFailed,
}

/// What is known at the best point.
#[derive(Clone, Debug, PartialEq)]
pub struct Linearized {
    /// The point.
    pub x: Vec<f64>,
    /// Its residual vector, length n.
    pub residual: DVector<f64>,
    /// Derivatives of the residual, n x number of unknowns; a column that could not be evaluated is
    /// zero.
    pub jacobian: DMatrix<f64>,
}

/// What was evaluated at a point.
#[derive(Clone, Debug, PartialEq)]
pub struct Evaluated {
    /// The residual vector.
    pub residual: DVector<f64>,
    /// Its derivatives by the variables where those were wanted, in their order; none for a column that
    /// is not known. Empty where nothing is known of any.
    pub columns: Vec<Option<DVector<f64>>>,
}

impl From<DVector<f64>> for Evaluated {
    fn from(residual: DVector<f64>) -> Self {
        let columns = Vec::new();
        Self { residual, columns }
    }
}
