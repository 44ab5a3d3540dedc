//! Projection of a search to more slots than are available: the real scheduler and the real strategy on a
//! simulated clock.
use super::row::SlotRow;
use dispatch::simulated::{Cluster, ClusterSetting, SimulatedDerivatives, SimulatedSearch};
use journal::event::Spent;
use protocol::job::{Derivative, Per, to_single_precision};
use search::{
    random::{Phase, Streams},
    space::Space,
    strategy::{EvaluationResult, Residual, Strategy},
};
use serde::Serialize;
use std::{cell::RefCell, collections::BTreeMap, rc::Rc, time::Duration};
use study::{least_parts, scaling::Shares};

/// Largest number of workers of one coordinator (measured: `docs/measurements.md`); more slots are slots of the
/// same workers.
const MAX_WORKERS: u64 = 1000;
/// One in this many workers of a projection is half as fast as the others.
const SLOW_ONE_IN: u64 = 10;

/// Upper limit of the simulated time of a projected search, longer than any search takes.
const LIMIT: Duration = Duration::from_hours(24 * 365);

/// Measured simulation times and overheads, the inputs of a projection.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Overheads {
    /// Mean computing time of a simulation in one slot \[s\].
    pub(super) simulation_s: f64,
    /// Quantiles of the computing time of a simulation at 0, 5 .. 100 % \[s\]; the distribution is wide since
    /// many simulations end early.
    pub(super) simulation_quantiles_s: Vec<f64>,
    /// Processor time of the coordinator per job and result over a Unix socket \[us\].
    pub(super) coordinator_us: f64,
    /// Median round-trip time of an empty job over a Unix socket \[ms\].
    pub(super) round_trip_ms: f64,
    /// Computing time of a simulation with derivatives by all unknowns over that of a plain one.
    pub(super) derivatives_over_plain: f64,
}

impl Overheads {
    /// Returns the simulated computing time of a job \[s\]: drawn from the quantiles, and dependent on the
    /// job number alone.
    pub(super) fn sample_duration_s(&self, job: u64) -> f64 {
        let index = usize::try_from(job).unwrap_or(usize::MAX);
        let mut stream = Streams::new(1, 6).at(0, Phase::Mutation, index);
        let last = self.simulation_quantiles_s.len().saturating_sub(1);
        let place = stream.unit() * last as f64;
        let below = place.floor();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a place in a short list"
        )]
        let at = |index: f64| self.simulation_quantiles_s.get(index as usize).copied();
        let low = at(below).unwrap_or(self.simulation_s);
        let high = at(below + 1.0).unwrap_or(low);
        low + (place - below) * (high - low)
    }
}

/// Synthetic objective in place of the simulation of a case: sum of squares with one minimum in the search space, in
/// normalised coordinates.
pub(super) struct SyntheticObjective<'a>(pub(super) &'a Space);

impl SyntheticObjective<'_> {
    /// Computes the synthetic objective of an individual, given by the values of its unknowns.
    pub(super) fn evaluate(&self, genes: &[f64]) -> EvaluationResult {
        EvaluationResult {
            fitness: self.differences(genes).map(|x| x * x).sum(),
            complete: true,
        }
    }

    /// Computes the residual whose squared norm is the synthetic objective, one value per axis of the space, with
    /// its derivatives by the unknowns.
    ///
    /// The residual is bent (a cubic term), so that a descent takes several steps as on a real case.
    pub(super) fn residual(&self, genes: &[f64]) -> Residual {
        let values: Vec<f64> = self.differences(genes).collect();
        let point = self.0.point(genes);
        let axes = self.0.axes().iter().enumerate();
        let derivatives = axes.map(|(axis, own)| {
            let x = point[axis] - 0.3;
            let slope = 1.0 + 3.0 * BEND * x * x;
            let per = Per::Unit(own.unknown.unit.clone());
            let terms = search::derivative::terms(self.0, axis, &point, genes);
            let factor = terms.first().map_or(1.0, |term| term.factor(&per));
            let mut curve = vec![0.0; values.len()];
            curve[axis] = slope / factor;
            let curves = vec![to_single_precision(curve)];
            (own.unknown.name.clone(), Derivative::Curves { per, curves })
        });
        Residual {
            derivatives: derivatives.collect(),
            values,
        }
    }

    fn differences(&self, genes: &[f64]) -> impl Iterator<Item = f64> {
        let point = self.0.point(genes);
        point.into_iter().map(|x| {
            let x = x - 0.3;
            x + BEND * x * x * x
        })
    }
}

/// Coefficient of the cubic term of the synthetic residual.
const BEND: f64 = 0.5;

/// Runs a search on a simulated cluster of `slots` slots (parallel jobs); `name` is only copied into the row.
pub(super) fn project(
    name: &str,
    strategy: Box<dyn Strategy>,
    space: &Space,
    slots: u64,
    overheads: &Overheads,
) -> SlotRow {
    let seconds = |s: f64| Duration::try_from_secs_f64(s).unwrap_or_default();
    let slots_per_worker = slots.div_ceil(MAX_WORKERS).max(1);
    let mut cluster = Cluster::new(ClusterSetting {
        slots: usize::try_from(slots_per_worker).unwrap_or(usize::MAX),
        slow_one_in: SLOW_ONE_IN,
        handling: seconds(overheads.coordinator_us * 1e-6),
        delay: seconds(overheads.round_trip_ms * 1e-3),
        ..ClusterSetting::even(slots.div_ceil(slots_per_worker))
    });
    let factors = Rc::new(RefCell::new(BTreeMap::new()));
    let (times, own) = (overheads.clone(), Rc::clone(&factors));
    cluster.job_durations = Some(Box::new(move |job| {
        let factor = own.borrow().get(&job).copied().unwrap_or(1.0);
        seconds(factor * times.sample_duration_s(job))
    }));
    let stand = SyntheticObjective(space);
    let tell = |genes: &[f64]| stand.evaluate(genes);
    let residual = |genes: &[f64]| stand.residual(genes);
    let mut source = SimulatedSearch::new(strategy, &tell);
    source.derivatives = Some(SimulatedDerivatives {
        residual: &residual,
        columns: space.dimension(),
        cost: overheads.derivatives_over_plain,
        least_parts,
        factors,
    });
    cluster.run(&mut source, LIMIT);
    let spent = cluster.snapshot().spent;
    let evaluations = source.strategy.archive().entries().len() as u64;
    let (wall_s, handled) = (cluster.now.as_secs_f64(), cluster.results.len() as f64);
    SlotRow {
        how: "projected",
        preset: name.to_owned(),
        slots,
        evaluations,
        wall_s,
        shares: Shares::between(&Spent::default(), &spent),
        coordinator_share: overheads.coordinator_us * 1e-6 * handled / wall_s,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dispatch::simulated::Fault;
    use search::{
        strategy::{SearchPlan, build, preset},
        test_function::SPHERE,
    };

    fn projected(name: &str, slots: u64, coordinator_us: f64) -> SlotRow {
        let space = SPHERE.space();
        let preset = preset(name).unwrap();
        let plan = SearchPlan {
            space: &space,
            workers: usize::try_from(slots).unwrap(),
        };
        let mut settings = (preset.settings)(&plan);
        if name != "least-squares" {
            preset.set(&mut settings, "generations", "20").unwrap();
        }
        let overheads = Overheads {
            simulation_s: 1.0,
            simulation_quantiles_s: vec![0.5, 1.0, 1.5],
            coordinator_us,
            round_trip_ms: 1.0,
            derivatives_over_plain: 6.0,
        };
        let strategy = build(&settings, &space, 1).unwrap();
        project(name, strategy, &space, slots, &overheads)
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
    /// Checks the derivatives of the synthetic residual against differences.
    #[test]
    fn synthetic_derivatives_are_those_of_the_residual() {
        let space = SPHERE.space();
        let stand = SyntheticObjective(&space);
        let x = [0.4, -0.2, 1.1, 0.7];
        let found = stand.residual(&space.values(&x));
        let squares: f64 = found.values.iter().map(|r| r * r).sum();
        let fitness = stand.evaluate(&space.values(&x)).fitness;
        assert!((squares / fitness - 1.0).abs() < 1e-12);
        for axis in 0..4 {
            let at = |step: f64| {
                let mut x = x;
                x[axis] += step;
                stand.residual(&space.values(&x)).values[axis]
            };
            let difference = (at(1e-6) - at(-1e-6)) / 2e-6;
            let values = space.values(&x);
            let terms = search::derivative::terms(&space, axis, &x, &values);
            let mut sum = [0.0; 4];
            let by = &found.derivatives[&format!("x{axis}")];
            terms[0].add(by, (0, None), &mut sum).unwrap();
            assert!(
                (sum[axis] / difference - 1.0).abs() < 1e-6,
                "{axis}: {sum:?}"
            );
        }
    }

    /// Checks that descents use slots that their few jobs would leave idle, with the same evaluations.
    #[test]
    fn descents_on_many_slots_divide_their_derivatives() {
        let few = projected("least-squares", 4, 100.0);
        let many = projected("least-squares", 80, 100.0);
        assert_eq!(few.evaluations, many.evaluations);
        // parts repeat the simulation that they differentiate
        let useful = |row: &SlotRow| row.shares.useful * row.wall_s * row.slots as f64;
        assert!(useful(&many) > 1.05 * useful(&few), "{many:?} {few:?}");
        assert!(few.wall_s > 1.5 * many.wall_s, "{many:?} {few:?}");
    }

    /// Checks that derivatives computed ahead change no evaluation, whatever is lost, doubled or killed, and that
    /// they use slots that would be idle.
    #[test]
    fn derivatives_computed_ahead_change_no_evaluation() {
        let space = SPHERE.space();
        let stand = SyntheticObjective(&space);
        let tell = |genes: &[f64]| stand.evaluate(genes);
        let residual = |genes: &[f64]| stand.residual(genes);
        let run = |workers: u64, loss: f64, kills: u64| {
            let mut cluster = Cluster::new(ClusterSetting {
                slow_one_in: 10,
                loss,
                duplication: loss,
                ..ClusterSetting::even(workers)
            });
            for n in 0..kills {
                let at = Duration::from_millis(1500 + 1700 * n);
                cluster.fault(at, (n * 3) % workers, Fault::Kill);
            }
            let settings = preset("least-squares").unwrap().settings;
            let plan = SearchPlan {
                space: &space,
                workers: 80,
            };
            let strategy = build(&settings(&plan), &space, 1).unwrap();
            let mut source = SimulatedSearch::new(strategy, &tell);
            source.derivatives = Some(SimulatedDerivatives {
                residual: &residual,
                columns: space.dimension(),
                cost: 5.0,
                least_parts,
                factors: Rc::default(),
            });
            cluster.run(&mut source, LIMIT);
            let spent = cluster.snapshot().spent;
            (source.digest(), spent.speculative_us)
        };
        let (alone, _) = run(1, 0.0, 0);
        let mut ahead = 0;
        for (workers, loss, kills) in [(8, 0.0, 0), (80, 0.0, 0), (80, 0.2, 8), (500, 0.1, 0)] {
            let (digest, speculative_us) = run(workers, loss, kills);
            assert_eq!(
                digest, alone,
                "{workers} workers, {loss} lost, {kills} killed"
            );
            ahead += speculative_us;
        }
        assert!(ahead > 1_000_000, "{ahead}");
    }

    #[test]
    fn jobs_take_what_was_measured_each_its_own() {
        let overheads = Overheads {
            simulation_s: 1.0,
            simulation_quantiles_s: vec![0.0, 0.0, 0.5, 4.0],
            coordinator_us: 100.0,
            round_trip_ms: 0.2,
            derivatives_over_plain: 6.0,
        };
        let times: Vec<f64> = (0..9000)
            .map(|job| overheads.sample_duration_s(job))
            .collect();
        assert_eq!(times[7].to_bits(), overheads.sample_duration_s(7).to_bits());
        // a third takes nothing, a third up to half a second, a third up to four
        let shorter = |than: f64| times.iter().filter(|time| **time <= than).count();
        assert!(shorter(0.0).abs_diff(3000) < 150 && shorter(0.5).abs_diff(6000) < 150);
        let mean = times.iter().sum::<f64>() / 9000.0;
        assert!((mean - 2.5 / 3.0).abs() < 0.05, "{mean}");
    }
}
