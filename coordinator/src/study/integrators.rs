//! Accuracy of the gauge curves against work, for every method of integration, and what a fixed step
//! costs.
//!
//! Two runs of different fourth-order methods at a hundredth of the usual tolerance are the truth;
//! where they differ, nothing can be resolved. A method is run along a ladder of tolerances and
//! longest steps: which of the two limits it differs from method to method, so that only the
//! undominated points of each count. Everything but the wall times is deterministic.
use super::{Evaluator, Stop, StudyError, calibrate::or_stop};
use protocol::{
    case::Integrator,
    job::{Counters, Integration, Job, SimulateSpec, Simulation, Verdict},
};

/// Tolerance and longest step \[s\], from coarse to fine.
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

/// How the truth is computed: tolerance and longest step \[s\].
const TRUTH: (f64, f64) = (1e-3, 2e-3);

/// Newton iterations that one point may take: ten of the most expensive ordinary ones.
const BUDGET: u64 = 120_000;

/// The step that the paper's program was given, throughout.
const FIXED: Integration = Integration {
    integrator: Integrator::Bdf,
    longest_step_s: 1e-5,
    tolerance: ANYTHING,
    budget: Some(u64::MAX),
};

/// A tolerance that rejects no step.
const ANYTHING: f64 = 1e12;

/// What is compared.
#[derive(Clone, Debug, PartialEq)]
pub struct WorkPlan {
    /// Index of the condition in the case.
    pub condition: usize,
    /// Gene values in declared units.
    pub genes: Vec<f64>,
    /// Methods.
    pub methods: Vec<Integrator>,
    /// How many levels of the ladder, from the coarse end; 0 for the whole of it.
    pub levels: usize,
    /// Whether the reference paper's fixed step is run too, whole: it takes as long as hundreds of
    /// ordinary runs.
    pub fixed: bool,
}

/// One run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorkPoint {
    /// Method.
    pub integrator: Integrator,
    /// Tolerance.
    pub tolerance: f64,
    /// Longest step \[s\].
    pub longest_step_s: f64,
    /// How it ended.
    pub verdict: Verdict,
    /// Work.
    pub counters: Counters,
    /// Wall time on the worker \[s\].
    pub wall_s: f64,
    /// Root mean square difference to the truth over the range of the worst gauge; none unless
    /// complete.
    pub error: Option<f64>,
    /// Defect of the energy ledger over the work.
    pub energy_error: f64,
}

impl WorkPoint {
    fn new(integration: &Integration, simulation: &Simulation, truth: &Simulation) -> Self {
        Self {
            integrator: integration.integrator,
            tolerance: integration.tolerance,
            longest_step_s: integration.longest_step_s,
            verdict: simulation.verdict,
            counters: simulation.counters,
            wall_s: simulation.wall_s,
            error: worst_gauge(simulation, truth),
            energy_error: simulation.energy.relative_error,
        }
    }
}

/// All methods side by side.
#[derive(Clone, Debug, PartialEq)]
pub struct WorkPrecision {
    /// How far the two candidates for the truth are apart, as an error.
    pub resolution: f64,
    /// Method by method, from the coarse end of the ladder.
    pub points: Vec<WorkPoint>,
    /// The paper's kind of step, over the whole run; none unless asked for.
    pub fixed: Option<WorkPoint>,
}

impl WorkPrecision {
    /// The complete points of a method that no other of its points beats in both work and error,
    /// by work.
    pub fn front(
        &self,
        integrator: Integrator,
        work: impl Fn(&WorkPoint) -> f64,
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

/// Runs the comparison, one job after the other, so that wall times do not disturb each other.
///
/// # Errors
/// If the truth cannot be computed, nobody evaluates any more, or the user stops it.
pub async fn work_precision<E: Evaluator>(
    evaluator: &mut E,
    plan: &WorkPlan,
    stop: &mut Stop,
    mut done: impl FnMut(&WorkPoint),
) -> Result<WorkPrecision, StudyError> {
    let mut runner = Runner {
        evaluator,
        plan,
        stop,
        next: 0,
    };
    // first, while no quantile of short runs sets a deadline yet
    let fixed = if plan.fixed {
        Some(runner.run(FIXED).await?)
    } else {
        None
    };
    let (tolerance, step) = TRUTH;
    let truth = runner.whole(Integrator::Rodas4, tolerance, step).await?;
    let second = runner.whole(Integrator::Esdirk4, tolerance, step).await?;
    let resolution = worst_gauge(&second, &truth).unwrap_or(f64::NAN);
    let mut points = Vec::new();
    let levels = if plan.levels == 0 {
        LADDER.len()
    } else {
        plan.levels
    };
    for &integrator in &plan.methods {
        for &(tolerance, longest_step_s) in LADDER.iter().take(levels) {
            let integration = Integration {
                integrator,
                longest_step_s,
                tolerance,
                budget: Some(BUDGET),
            };
            let simulation = runner.run(integration).await?;
            let point = WorkPoint::new(&integration, &simulation, &truth);
            done(&point);
            points.push(point);
        }
    }
    let fixed = fixed.map(|simulation| WorkPoint::new(&FIXED, &simulation, &truth));
    Ok(WorkPrecision {
        resolution,
        points,
        fixed,
    })
}

struct Runner<'a, E> {
    evaluator: &'a mut E,
    plan: &'a WorkPlan,
    stop: &'a mut Stop,
    next: u64,
}

impl<E: Evaluator> Runner<'_, E> {
    async fn run(&mut self, integration: Integration) -> Result<Simulation, StudyError> {
        let id = self.next;
        self.next += 1;
        let spec = SimulateSpec {
            effects: Vec::new(),
            condition: self.plan.condition,
            genes: self.plan.genes.clone(),
            motion_step_deg: 0.0,
            integration: Some(integration),
        };
        self.evaluator.submit(id, Job::Simulate(spec))?;
        let completed = or_stop(self.evaluator.next(), self.stop).await??;
        completed.simulated(|| format!("a run with {}", integration.integrator.as_str()))
    }

    async fn whole(
        &mut self,
        integrator: Integrator,
        tolerance: f64,
        longest_step_s: f64,
    ) -> Result<Simulation, StudyError> {
        let integration = Integration {
            integrator,
            longest_step_s,
            tolerance,
            budget: Some(u64::MAX),
        };
        let simulation = self.run(integration).await?;
        match simulation.verdict {
            Verdict::Complete => Ok(simulation),
            Verdict::Failed { kind, .. } => Err(StudyError::NoTruth { kind }),
        }
    }
}

/// Largest root mean square difference of a gauge over its range; none unless both are complete.
fn worst_gauge(simulation: &Simulation, truth: &Simulation) -> Option<f64> {
    if simulation.verdict != Verdict::Complete {
        return None;
    }
    let mut worst: f64 = 0.0;
    for (found, exact) in simulation.gauge_mpa.iter().zip(&truth.gauge_mpa) {
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

    fn point(integrator: Integrator, iterations: u64, error: Option<f64>) -> WorkPoint {
        WorkPoint {
            integrator,
            tolerance: 1.0,
            longest_step_s: 0.01,
            verdict: Verdict::Complete,
            counters: Counters {
                newton_iterations: iterations,
                ..Counters::default()
            },
            wall_s: 1e-4 * iterations as f64,
            error,
            energy_error: 0.0,
        }
    }

    #[test]
    fn only_undominated_points_of_a_method_count() {
        let all = WorkPrecision {
            resolution: 1e-6,
            points: vec![
                point(Integrator::Esdirk4, 500, Some(0.1)),
                point(Integrator::Esdirk4, 400, Some(0.2)),
                point(Integrator::Esdirk4, 600, Some(0.15)),
                point(Integrator::Esdirk4, 900, None),
                point(Integrator::TrBdf2, 100, Some(0.01)),
                point(Integrator::Esdirk4, 800, Some(0.02)),
            ],
            fixed: None,
        };
        let front = all.front(Integrator::Esdirk4, |p| p.counters.newton_iterations as f64);
        assert_eq!(front, [(400.0, 0.2), (500.0, 0.1), (800.0, 0.02)]);
    }
}
