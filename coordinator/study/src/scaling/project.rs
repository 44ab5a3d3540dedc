//! Projection of a search to more slots than are available: the real scheduler and the real strategy on a
//! simulated clock.
use super::row::{Overheads, ScalingRow, Shares, SlotMode};
use dispatch::simulated::{Cluster, ClusterSetting, SimulatedSearch};
use protocol::event::Spent;
use search::{
    space::Space,
    strategy::{EvaluationResult, Strategy},
};
use std::time::Duration;

/// Upper limit of the simulated time of a projected search, longer than any search takes.
const LIMIT: Duration = Duration::from_hours(24 * 365);

/// Synthetic objective in place of the simulation of a case: squared distance from a point in the search
/// space, in normalised coordinates.
pub struct SyntheticObjective<'a>(pub &'a Space);

impl SyntheticObjective<'_> {
    /// Computes the synthetic objective of an individual, given by the values of its unknowns.
    pub fn evaluate(&self, genes: &[f64]) -> EvaluationResult {
        let point = self.0.point(genes);
        let squares = point.iter().map(|x| (x - 0.3) * (x - 0.3));
        EvaluationResult {
            fitness: squares.sum(),
            complete: true,
        }
    }
}

/// Runs a search on a simulated cluster of `slots` slots (parallel jobs) and returns its scaling result;
/// `name` and `population` of the search are only copied into the result.
pub fn project(
    (name, population): (&str, u64),
    strategy: Box<dyn Strategy>,
    space: &Space,
    slots: u64,
    overheads: &Overheads,
) -> ScalingRow {
    let seconds = |s: f64| Duration::try_from_secs_f64(s).unwrap_or_default();
    let mut cluster = Cluster::new(ClusterSetting {
        handling: seconds(overheads.coordinator_us * 1e-6),
        delay: seconds(overheads.round_trip_ms * 1e-3),
        ..ClusterSetting::even(slots)
    });
    let times = overheads.clone();
    cluster.job_durations = Some(Box::new(move |job| seconds(times.sample_duration_s(job))));
    let stand = SyntheticObjective(space);
    let tell = |genes: &[f64]| stand.evaluate(genes);
    let mut source = SimulatedSearch::new(strategy, &tell);
    cluster.run(&mut source, LIMIT);
    let spent = cluster.core.snapshot(cluster.now).spent;
    let evaluations = source.strategy.archive().entries().len() as u64;
    let (wall_s, handled) = (cluster.now.as_secs_f64(), cluster.results.len() as f64);
    ScalingRow {
        how: SlotMode::Projected,
        preset: name.to_owned(),
        population,
        slots,
        evaluations,
        wall_s,
        useful_s: spent.useful_us as f64 / 1e6,
        shares: Shares::between(&Spent::default(), &spent),
        coordinator_us_per_result: overheads.coordinator_us,
        coordinator_share: overheads.coordinator_us * 1e-6 * handled / wall_s,
        speed_up: 0.0,
        efficiency: 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use search::{
        strategy::{SearchPlan, build, preset},
        test_function::SPHERE,
    };

    fn projected(name: &str, slots: u64, coordinator_us: f64) -> ScalingRow {
        let space = SPHERE.space();
        let preset = preset(name).unwrap();
        let plan = SearchPlan {
            space: &space,
            workers: usize::try_from(slots).unwrap(),
        };
        let mut settings = (preset.settings)(&plan);
        preset.set(&mut settings, "generations", "20").unwrap();
        let overheads = Overheads {
            simulation_s: 1.0,
            simulation_quantiles_s: vec![0.5, 1.0, 1.5],
            coordinator_us,
            round_trip_ms: 1.0,
        };
        let strategy = build(&settings, &space, 1).unwrap();
        project((name, 80), strategy, &space, slots, &overheads)
    }

    #[test]
    fn a_search_without_generations_fills_more_slots_and_a_slow_coordinator_none() {
        let (paper, window) = (
            projected("paper-batch", 40, 100.0),
            projected("window", 40, 100.0),
        );
        assert!(window.shares.useful > 0.8, "{window:?}");
        assert!(paper.shares.useful < window.shares.useful, "{paper:?}");
        assert!(
            paper.shares.barrier > 5.0 * paper.shares.starved,
            "{paper:?}"
        );
        // half a second of work over each result: two a second at most, on any number of slots
        let slow = projected("window", 40, 500_000.0);
        let rate = slow.evaluations as f64 / slow.wall_s;
        assert!(rate < 2.05 && slow.shares.useful < 0.1, "{slow:?}");
        assert!(slow.coordinator_share > 0.95, "{slow:?}");
    }
}
