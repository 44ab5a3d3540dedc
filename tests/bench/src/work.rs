//! Accuracy of the gauge curves against work, for every time integration method.
//!
//! The reference solution is computed with two fourth-order methods at a hundredth of the usual tolerance;
//! their difference is the smallest error that can be resolved. A method is run at a ladder of tolerances and
//! largest steps. Which of the two limits the accuracy differs between methods, so that only the
//! Pareto-optimal points of each count. Everything but the wall times is deterministic.
use crate::machine::{GaugeRun, Machine};
use anyhow::ensure;
use serde::Serialize;
use simulation::{
    integrator::{
        method::{Method, SPECTRAL_RADIUS},
        tableau::{ESDIRK4, TR_BDF2},
    },
    run::RunSettings,
    verdict::Verdict,
};

/// Time integration method to compare: those of cases, and others that judge them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Integrator {
    /// TR-BDF2: second order, two implicit stages per step.
    TrBdf2,
    /// ESDIRK: fourth order, five implicit stages per step.
    Esdirk4,
    /// Rosenbrock method of fourth order: six linear solutions a step, a new factorisation each.
    Rodas4,
    /// Generalised-alpha, second order, one implicit stage a step.
    GeneralizedAlpha,
    /// Backward differentiation of variable step, orders 1 and 2.
    Bdf,
}

impl Integrator {
    /// All methods.
    pub(crate) const ALL: [Self; 5] = [
        Self::TrBdf2,
        Self::Esdirk4,
        Self::Rodas4,
        Self::GeneralizedAlpha,
        Self::Bdf,
    ];

    /// Returns the name of the method on the command line.
    pub(crate) const fn as_str(self) -> &'static str {
        match self {
            Self::TrBdf2 => "tr_bdf2",
            Self::Esdirk4 => "esdirk4",
            Self::Rodas4 => "rodas4",
            Self::GeneralizedAlpha => "generalized_alpha",
            Self::Bdf => "bdf",
        }
    }

    /// Returns the name of the method in tables and figures.
    pub(crate) const fn title(self) -> &'static str {
        match self {
            Self::TrBdf2 => "TR-BDF2",
            Self::Esdirk4 => "ESDIRK4",
            Self::Rodas4 => "RODAS4",
            Self::GeneralizedAlpha => "generalised-alpha",
            Self::Bdf => "BDF, order ≤ 2",
        }
    }

    const fn method(self) -> Method {
        match self {
            Self::TrBdf2 => Method::RungeKutta(&TR_BDF2),
            Self::Esdirk4 => Method::RungeKutta(&ESDIRK4),
            Self::Rodas4 => Method::Rosenbrock,
            Self::GeneralizedAlpha => Method::GeneralizedAlpha {
                spectral_radius: SPECTRAL_RADIUS,
            },
            Self::Bdf => Method::Bdf { highest: 2 },
        }
    }
}

/// Accuracy levels at which each method is run, from coarse to fine: pairs of tolerance \[1\] and largest
/// step \[s\].
const LADDER: [(f64, f64); 9] = [
    (1.0, 0.05),
    (1.0, 0.03),
    (1.0, 0.02),
    (1.0, 0.012),
    (0.1, 0.03),
    (1.0, 0.007),
    (0.03, 0.02),
    (0.01, 0.01),
    (0.001, 0.005),
];

/// Tolerance and largest step \[s\] of the reference solution.
const REFERENCE: (f64, f64) = (1e-3, 2e-3);

/// Limit on Newton iterations of one run: ten times those of the most expensive ordinary run.
const BUDGET: u64 = 120_000;

/// Integration settings of the reference paper: a fixed step, enforced by a tolerance so large that no step
/// is rejected.
const FIXED: Integration = Integration {
    integrator: Integrator::Bdf,
    longest_step_s: 1e-5,
    tolerance: 1e12,
    budget: u64::MAX,
};

/// Integration settings of one run; the largest step is not shortened on machines whose beam oscillates fast.
#[derive(Clone, Copy, Debug)]
struct Integration {
    integrator: Integrator,
    longest_step_s: f64,
    tolerance: f64,
    budget: u64,
}

impl Integration {
    /// Simulates a machine with these settings.
    fn run(&self, machine: &Machine, genes: &[f64]) -> anyhow::Result<GaugeRun> {
        machine.run(genes, |settings| RunSettings {
            method: self.integrator.method(),
            longest_step: self.longest_step_s,
            slow_swing: f64::INFINITY,
            tolerance: self.tolerance,
            budget: self.budget,
            ..settings
        })
    }
}

/// Settings of a comparison of time integration methods.
pub(crate) struct Plan {
    /// Values of the case's unknowns with which all runs are simulated, in the units of the case.
    pub(crate) genes: Vec<f64>,
    /// Time integration methods to compare.
    pub(crate) methods: Vec<Integrator>,
    /// Number of accuracy levels to run, from the coarsest; 0 for all.
    pub(crate) levels: usize,
    /// Whether the reference paper's fixed step is also run over the whole revolution, which takes as long as
    /// hundreds of ordinary runs.
    pub(crate) fixed: bool,
}

/// Accuracy and work of one simulation with one integration method; a row of `integrators.csv`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Point {
    pub(crate) integrator: Integrator,
    pub(crate) tolerance: f64,
    pub(crate) longest_step_s: f64,
    #[serde(skip)]
    pub(crate) verdict: Verdict,
    /// Whether the whole revolution was simulated.
    pub(crate) complete: bool,
    pub(crate) steps: u64,
    pub(crate) rejected_steps: u64,
    /// Number of Newton iterations; for a Rosenbrock method, of linear solves.
    pub(crate) newton_iterations: u64,
    /// Number of evaluations of the tangent matrix (Jacobian).
    pub(crate) jacobians: u64,
    /// Number of factorisations of the tangent matrix.
    pub(crate) factorizations: u64,
    pub(crate) wall_s: f64,
    /// Largest root mean square difference of a gauge curve from the reference solution, divided by the
    /// gauge's range \[1\]; `None` unless complete.
    #[serde(rename = "error_over_range")]
    pub(crate) error: Option<f64>,
    /// Error of the energy balance divided by the work done \[1\].
    pub(crate) energy_error: f64,
}

impl Point {
    fn new(integration: &Integration, run: &GaugeRun, truth: &GaugeRun) -> Self {
        let counters = &run.result.statistics;
        let (work, stored) = (run.result.work, run.result.stored);
        let missing = work.input - work.output - work.dissipated - stored;
        let scale = work.input.abs().max(work.output.abs());
        Self {
            integrator: integration.integrator,
            tolerance: integration.tolerance,
            longest_step_s: integration.longest_step_s,
            verdict: run.result.verdict,
            complete: run.result.verdict == Verdict::Complete,
            steps: counters.steps,
            rejected_steps: counters.error_rejections + counters.newton_rejections,
            newton_iterations: counters.newton_iterations,
            jacobians: counters.jacobians,
            factorizations: counters.factorizations,
            wall_s: run.wall_s,
            error: worst_gauge(run, truth),
            energy_error: if scale > 0.0 {
                missing.abs() / scale
            } else {
                0.0
            },
        }
    }
}

/// Results of all time integration methods on one machine; printed by `--output json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Comparison {
    /// Difference between the two reference solutions: smallest error that can be resolved \[1\].
    pub(crate) resolution: f64,
    /// Results of the runs, method by method, each from coarse to fine integration settings.
    pub(crate) points: Vec<Point>,
    /// Result with the reference paper's fixed step; `None` unless requested.
    pub(crate) fixed_step: Option<Point>,
}

impl Comparison {
    /// Returns the Pareto-optimal pairs (work, error) of a method's complete runs, sorted by work.
    pub(crate) fn front(
        &self,
        integrator: Integrator,
        work: impl Fn(&Point) -> f64,
    ) -> Vec<(f64, f64)> {
        let own = self.points.iter().filter(|p| p.integrator == integrator);
        let mut points: Vec<(f64, f64)> = own
            .filter_map(|point| Some((work(point), point.error?)))
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let mut best = f64::INFINITY;
        points.retain(|&(_, error)| {
            let better = error < best;
            best = best.min(error);
            better
        });
        points
    }
}

/// Runs the comparison, one run after another, so that wall times do not disturb each other.
pub(crate) fn compare(
    machine: &Machine,
    plan: &Plan,
    mut done: impl FnMut(&Point) -> anyhow::Result<()>,
) -> anyhow::Result<Comparison> {
    let truth = converged(machine, plan, Integrator::Rodas4)?;
    let second = converged(machine, plan, Integrator::Esdirk4)?;
    let run = |integration: Integration| {
        let own = integration.run(machine, &plan.genes)?;
        anyhow::Ok(Point::new(&integration, &own, &truth))
    };
    let levels = match plan.levels {
        0 => LADDER.len(),
        some => some,
    };
    let mut points = Vec::new();
    for &integrator in &plan.methods {
        for &(tolerance, longest_step_s) in LADDER.iter().take(levels) {
            let point = run(Integration {
                integrator,
                longest_step_s,
                tolerance,
                budget: BUDGET,
            })?;
            done(&point)?;
            points.push(point);
        }
    }
    Ok(Comparison {
        resolution: worst_gauge(&second, &truth).unwrap_or(f64::NAN),
        points,
        fixed_step: plan.fixed.then(|| run(FIXED)).transpose()?,
    })
}

/// Computes a reference solution whose error is negligible.
///
/// # Errors
/// A run that is not complete.
fn converged(machine: &Machine, plan: &Plan, integrator: Integrator) -> anyhow::Result<GaugeRun> {
    let (tolerance, longest_step_s) = REFERENCE;
    let integration = Integration {
        integrator,
        longest_step_s,
        tolerance,
        budget: u64::MAX,
    };
    let run = integration.run(machine, &plan.genes)?;
    ensure!(
        run.result.verdict == Verdict::Complete,
        "the reference run with these parameters is not complete ({:?}): choose other parameters with --genes",
        run.result.verdict
    );
    Ok(run)
}

/// Returns the root mean square difference of a run's gauge curves from the reference, divided by the
/// range, for the worst gauge \[1\]; `None` unless the run is complete.
fn worst_gauge(run: &GaugeRun, truth: &GaugeRun) -> Option<f64> {
    if run.result.verdict != Verdict::Complete {
        return None;
    }
    let mut worst: f64 = 0.0;
    for (found, exact) in run.gauges.iter().zip(&truth.gauges) {
        if found.len() != exact.len() || exact.is_empty() {
            return None;
        }
        let squares = found.iter().zip(exact).map(|(a, b)| (a - b) * (a - b));
        let mean = squares.sum::<f64>() / exact.len() as f64;
        let low = exact.iter().copied().fold(f64::INFINITY, f64::min);
        let high = exact.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        worst = worst.max(mean.sqrt() / (high - low));
    }
    Some(worst)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(integrator: Integrator, newton_iterations: u64, error: Option<f64>) -> Point {
        Point {
            integrator,
            tolerance: 1.0,
            longest_step_s: 0.01,
            verdict: Verdict::Complete,
            complete: true,
            steps: 0,
            rejected_steps: 0,
            newton_iterations,
            jacobians: 0,
            factorizations: 0,
            wall_s: 0.0,
            error,
            energy_error: 0.0,
        }
    }

    #[test]
    fn only_undominated_points_of_a_method_count() {
        let all = Comparison {
            resolution: 1e-6,
            points: vec![
                point(Integrator::Esdirk4, 500, Some(0.1)),
                point(Integrator::Esdirk4, 400, Some(0.2)),
                point(Integrator::Esdirk4, 600, Some(0.15)),
                point(Integrator::Esdirk4, 900, None),
                point(Integrator::TrBdf2, 100, Some(0.01)),
                point(Integrator::Esdirk4, 800, Some(0.02)),
            ],
            fixed_step: None,
        };
        let front = all.front(Integrator::Esdirk4, |p| p.newton_iterations as f64);
        assert_eq!(front, [(400.0, 0.2), (500.0, 0.1), (800.0, 0.02)]);
    }
}
