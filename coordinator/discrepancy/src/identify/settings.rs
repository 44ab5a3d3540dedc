//! How everything here is fitted.
use search::least_squares::Settings;

/// How the free fit goes: to its floor, with unknowns of next to no curvature held where they are.
pub(super) const FREE: Settings = Settings {
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
