//! Settings of the fits of an identifiability analysis.
use search::least_squares::LeastSquaresSettings;

/// Settings of the fit in which no unknown is held: it iterates to full convergence, and variables of
/// negligible curvature keep their values.
pub(super) const FREE: LeastSquaresSettings = LeastSquaresSettings {
    iterations: 20,
    gradient: 3e-3,
    decrease: 1e-4,
    change: 2.0,
    step_range: 10.0,
    level: 1e-3,
    central: true,
    finish: false,
    exact: false,
};
