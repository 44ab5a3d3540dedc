//! The whole box of genes: how individuals end that a search may propose, and what that costs.
//!
//! Points are a seeded Latin hypercube over the logarithms of the genes, so the same case, seed and
//! number of points are the same individuals. Everything but the wall times is deterministic.
use super::{Evaluator, Stop, StudyError, calibrate::or_stop};
use protocol::job::{Counters, Job, Reached, SimulateSpec, Verdict};
use search::space::{Interval, Space};
use search::strategy::latin_hypercube;

/// What is tried.
#[derive(Clone, Debug, PartialEq)]
pub struct BoxPlan {
    /// Index of the condition in the case.
    pub condition: usize,
    /// How many individuals.
    pub points: usize,
    /// How far from the recommended value at most, within the case's bounds (decades, of a
    /// parameter of an effect halves of its interval); the bounds alone where there is none.
    pub decades: Option<f64>,
    /// Seed of the hypercube.
    pub seed: u64,
}

/// One individual.
#[derive(Clone, Debug, PartialEq)]
pub struct BoxPoint {
    /// Gene values in declared units.
    pub genes: Vec<f64>,
    /// How it ended.
    pub verdict: Verdict,
    /// Work.
    pub counters: Counters,
    /// Wall time on the worker \[s\].
    pub wall_s: f64,
}

/// Individuals that ended alike.
#[derive(Clone, Debug, PartialEq)]
pub struct BoxClass {
    /// A complete run, or a kind of failure with a reached share of 0 under load or in motion; none for
    /// all that failed.
    pub verdict: Option<Verdict>,
    /// How many.
    pub runs: usize,
    /// Newton iterations: median, nine in ten, most.
    pub iterations: [u64; 3],
    /// Wall time \[s\], the same.
    pub wall_s: [f64; 3],
}

/// Simulates the individuals of a box; `done` hears of each in the order in which they end.
///
/// # Errors
/// If nobody evaluates any more, or the user stops it.
pub async fn whole_box<E: Evaluator>(
    evaluator: &mut E,
    (space, plan): (&Space, &BoxPlan),
    stop: &mut Stop,
    mut done: impl FnMut(usize, &BoxPoint),
) -> Result<Vec<BoxPoint>, StudyError> {
    let individuals = individuals(space, plan);
    for (id, genes) in (0..).zip(&individuals) {
        let spec = SimulateSpec {
            condition: plan.condition,
            genes: genes.clone(),
            effects: Vec::new(),
            motion_step_deg: 0.0,
            integration: None,
        };
        evaluator.submit(id, Job::Simulate(spec))?;
    }
    let mut points = vec![None; individuals.len()];
    for ended in 1..=individuals.len() {
        let completed = or_stop(evaluator.next(), stop).await??;
        let id = completed.id;
        let simulation = completed.simulated(|| format!("individual {id} of the box"))?;
        let place = usize::try_from(id).ok().and_then(|at| {
            let genes = individuals.get(at)?.clone();
            Some((points.get_mut(at)?, genes))
        });
        let Some((place, genes)) = place else {
            return Err(StudyError::WrongKind { id });
        };
        let point = place.insert(BoxPoint {
            genes,
            verdict: simulation.verdict,
            counters: simulation.counters,
            wall_s: simulation.wall_s,
        });
        done(ended, point);
    }
    Ok(points.into_iter().flatten().collect())
}

fn individuals(space: &Space, plan: &BoxPlan) -> Vec<Vec<f64>> {
    let reach = plan.decades.unwrap_or(f64::INFINITY);
    let near = Interval {
        from: -reach,
        to: reach,
    };
    let axes = space.axes().iter();
    let intervals: Vec<Interval> = axes.map(|axis| near.within(axis.interval())).collect();
    let points = latin_hypercube(&intervals, plan.points, plan.seed);
    points.iter().map(|point| space.values(point)).collect()
}

/// The individuals by how they ended, the commonest first, then all that failed.
pub fn box_classes(points: &[BoxPoint]) -> Vec<BoxClass> {
    let mut verdicts: Vec<Verdict> = Vec::new();
    for verdict in points.iter().map(|point| ended(&point.verdict)) {
        if !verdicts.contains(&verdict) {
            verdicts.push(verdict);
        }
    }
    let of = |verdict: Option<Verdict>| {
        let alike = |point: &&BoxPoint| match verdict {
            Some(verdict) => ended(&point.verdict) == verdict,
            None => point.verdict != Verdict::Complete,
        };
        let alike: Vec<&BoxPoint> = points.iter().filter(alike).collect();
        class(verdict, &alike)
    };
    let mut classes: Vec<BoxClass> = verdicts.into_iter().map(|v| of(Some(v))).collect();
    // equally common ones stay in the order in which they came first
    classes.sort_by_key(|class| std::cmp::Reverse(class.runs));
    let failed = of(None);
    if failed.runs > 0 {
        classes.push(failed);
    }
    classes
}

/// A verdict without how far it got.
fn ended(verdict: &Verdict) -> Verdict {
    match *verdict {
        Verdict::Complete => Verdict::Complete,
        Verdict::Failed { kind, reached } => Verdict::Failed {
            kind,
            reached: match reached {
                Reached::LoadFraction(_) => Reached::LoadFraction(0.0),
                Reached::TimeFraction(_) => Reached::TimeFraction(0.0),
            },
        },
    }
}

fn class(verdict: Option<Verdict>, points: &[&BoxPoint]) -> BoxClass {
    let (mut iterations, mut wall_s): (Vec<u64>, Vec<f64>) = points
        .iter()
        .map(|point| (point.counters.newton_iterations, point.wall_s))
        .unzip();
    iterations.sort_unstable();
    wall_s.sort_by(f64::total_cmp);
    // the middle one, nine in ten, the last
    let at = |tenths: usize| (iterations.len().saturating_sub(1)) * tenths / 10;
    let places = [at(5), at(9), at(10)];
    BoxClass {
        verdict,
        runs: iterations.len(),
        iterations: places.map(|at| iterations.get(at).copied().unwrap_or_default()),
        wall_s: places.map(|at| wall_s.get(at).copied().unwrap_or_default()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::job::PhysicsFailure;

    fn point(verdict: Verdict, iterations: u64) -> BoxPoint {
        BoxPoint {
            genes: Vec::new(),
            verdict,
            counters: Counters {
                newton_iterations: iterations,
                ..Counters::default()
            },
            wall_s: 1e-4 * iterations as f64,
        }
    }

    #[test]
    fn individuals_are_counted_by_how_they_ended() {
        let failed = |kind, reached| Verdict::Failed { kind, reached };
        let through = PhysicsFailure::RopeThroughHead;
        let points = [
            point(failed(through, Reached::LoadFraction(0.3)), 0),
            point(Verdict::Complete, 3000),
            point(failed(through, Reached::TimeFraction(0.7)), 900),
            point(failed(through, Reached::LoadFraction(0.1)), 10),
        ];
        let classes = box_classes(&points);
        let runs: Vec<usize> = classes.iter().map(|class| class.runs).collect();
        assert_eq!(runs, [2, 1, 1, 3]);
        assert_eq!(classes[0].iterations, [0, 0, 10]);
        assert_eq!(classes[1].verdict, Some(Verdict::Complete));
        assert_eq!(classes[3].verdict, None);
        assert_eq!(classes[3].iterations, [10, 10, 900]);
        assert!((classes[3].wall_s[2] - 0.09).abs() < 1e-12);
    }
}
