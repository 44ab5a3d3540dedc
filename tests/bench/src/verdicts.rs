//! Statistics of the individuals of a search box: counts per verdict, with their cost.
use protocol::job::{Counters, Reached, Verdict};
use serde::Serialize;

/// Verdict and cost of one individual.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RunRecord {
    pub(crate) verdict: Verdict,
    pub(crate) counters: Counters,
    pub(crate) wall_s: f64,
}

/// Group of individuals with the same verdict.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Class {
    /// Name of the verdict: `complete`, a kind of failure, or `failed` for all failures together.
    pub(crate) verdict: String,
    /// Stage of the failure, `under_load` or `in_motion`; `None` for complete runs and for all failures
    /// together.
    pub(crate) stage: Option<&'static str>,
    /// Number of individuals in the group.
    pub(crate) runs: usize,
    /// Newton iterations of the group's individuals: median, 90th percentile, maximum.
    pub(crate) newton_iterations: [u64; 3],
    /// Wall time of the group's individuals: median, 90th percentile, maximum \[s\].
    pub(crate) wall_s: [f64; 3],
}

/// Groups the individuals by verdict, the most frequent first, followed by the group of all failures if there
/// are any.
pub(crate) fn classes(individuals: &[RunRecord]) -> Vec<Class> {
    let mut kinds: Vec<(&str, Option<&'static str>)> = Vec::new();
    for kind in individuals.iter().map(|one| kind(&one.verdict)) {
        if !kinds.contains(&kind) {
            kinds.push(kind);
        }
    }
    let alike = |wanted| {
        let alike = individuals
            .iter()
            .filter(|one| kind(&one.verdict) == wanted);
        class(wanted, &alike.collect::<Vec<_>>())
    };
    let mut classes: Vec<Class> = kinds.into_iter().map(alike).collect();
    // equally common ones stay in the order in which they came first
    classes.sort_by_key(|class| std::cmp::Reverse(class.runs));
    let failed = individuals
        .iter()
        .filter(|one| one.verdict != Verdict::Complete);
    let failed = class(("failed", None), &failed.collect::<Vec<_>>());
    classes.extend((failed.runs > 0).then_some(failed));
    classes
}

/// Returns the name of a verdict and the stage of its failure, without the progress reached.
fn kind(verdict: &Verdict) -> (&str, Option<&'static str>) {
    match verdict {
        Verdict::Complete => ("complete", None),
        Verdict::Failed { kind, reached } => {
            let stage = match reached {
                Reached::LoadFraction(_) => "under_load",
                Reached::TimeFraction(_) => "in_motion",
            };
            (kind.as_str(), Some(stage))
        }
    }
}

fn class((verdict, stage): (&str, Option<&'static str>), individuals: &[&RunRecord]) -> Class {
    let mut newton_iterations: Vec<u64> = individuals
        .iter()
        .map(|one| one.counters.newton_iterations)
        .collect();
    let mut wall_s: Vec<f64> = individuals.iter().map(|one| one.wall_s).collect();
    newton_iterations.sort_unstable();
    wall_s.sort_by(f64::total_cmp);
    let places = [5, 9, 10].map(|tenths| individuals.len().saturating_sub(1) * tenths / 10);
    Class {
        verdict: verdict.to_owned(),
        stage,
        runs: individuals.len(),
        newton_iterations: places.map(|at| newton_iterations.get(at).copied().unwrap_or_default()),
        wall_s: places.map(|at| wall_s.get(at).copied().unwrap_or_default()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::pumping_unit::failure;

    #[test]
    fn individuals_are_counted_by_how_they_ended() {
        let through = |reached| Verdict::Failed {
            kind: failure::ROPE_THROUGH_HEAD,
            reached,
        };
        let individuals = [
            (through(Reached::LoadFraction(0.3)), 0),
            (Verdict::Complete, 3000),
            (through(Reached::TimeFraction(0.7)), 900),
            (through(Reached::LoadFraction(0.1)), 10),
        ]
        .map(|(verdict, iterations)| RunRecord {
            verdict,
            counters: Counters {
                newton_iterations: iterations,
                ..Counters::default()
            },
            wall_s: 1e-4 * iterations as f64,
        });
        let classes = classes(&individuals);
        let runs: Vec<usize> = classes.iter().map(|class| class.runs).collect();
        assert_eq!(runs, [2, 1, 1, 3]);
        assert_eq!(classes[0].newton_iterations, [0, 0, 10]);
        assert_eq!(classes[1].verdict, "complete");
        assert_eq!(
            (classes[3].verdict.as_str(), classes[3].stage),
            ("failed", None)
        );
        assert_eq!(classes[3].newton_iterations, [10, 10, 900]);
        assert!((classes[3].wall_s[2] - 0.09).abs() < 1e-12);
    }
}
