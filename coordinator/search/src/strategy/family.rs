//! Families of fits: ends of descents with nearly equal fitness that differ in an unknown which the record
//! determines.
use crate::space::Space;
use serde::{Deserialize, Serialize};

/// Minimum distance of two families along an axis (coordinate): half a decade on a logarithmic axis, a
/// quarter of the interval on a linear one.
const FAMILY_DISTANCE: f64 = 0.5;

/// Largest fitness of a rival fit, as a multiple of the best: what a model error changes by as much may prefer
/// either. The wrong family of the shipped record has 1.49 times the fitness of the right one.
const RIVAL_FITNESS: f64 = 1.5;

/// End of a least-squares descent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DescentEnd {
    /// Gene values at the end in declared units, in the case's order.
    pub genes: Vec<f64>,
    /// Fitness at the end.
    pub fitness: f64,
}

/// Best fit of another family than that of the best individual.
#[derive(Clone, Debug, PartialEq)]
pub struct Rival<'a> {
    /// End of the descent that found the fit.
    pub end: &'a DescentEnd,
    /// Names of the unknowns in which the fit differs from the best individual.
    pub differs: Vec<&'a str>,
}

/// Returns the best fit of every other family than that of the best individual, best first: ends of descents
/// with at most 1.5 times its fitness that differ by more than half a decade (on a linear axis, a
/// quarter of the interval) in an unknown that the record determines, from the best individual and from each
/// other. `determines` tells whether the record determines an unknown, by its name.
pub fn rivals<'a>(
    space: &'a Space,
    (best, fitness): (&[f64], f64),
    ends: &'a [DescentEnd],
    determines: impl Fn(&str) -> bool,
) -> Vec<Rival<'a>> {
    let differs = |a: &[f64], b: &[f64]| -> Vec<&'a str> {
        let axes = space.axes().iter().zip(a.iter().zip(b));
        let far = axes.filter(|(axis, (a, b))| {
            determines(&axis.unknown.name) && (*a - *b).abs() > FAMILY_DISTANCE
        });
        far.map(|(axis, _)| axis.unknown.name.as_str()).collect()
    };
    let mut ranked: Vec<&DescentEnd> = ends.iter().collect();
    ranked.sort_by(|a, b| a.fitness.total_cmp(&b.fitness));
    let best = space.point(best);
    let mut rivals: Vec<Rival<'a>> = Vec::new();
    for end in ranked {
        let point = space.point(&end.genes);
        let from_best = differs(&best, &point);
        let mut others = rivals.iter();
        let known = others.any(|own| differs(&space.point(&own.end.genes), &point).is_empty());
        if end.fitness <= RIVAL_FITNESS * fitness && !from_best.is_empty() && !known {
            rivals.push(Rival {
                end,
                differs: from_best,
            });
        }
    }
    rivals
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::case::{Scale, Unknown};

    #[test]
    fn a_rival_is_near_in_fitness_and_far_in_an_unknown_that_is_determined() {
        let unknown = |name: &str| Unknown::new(name, "N/m", Scale::Logarithmic, 1.0, [1e-4, 1e4]);
        let space = Space::new(&[unknown("seen"), unknown("blind")]).expect("two unknowns");
        let end = |seen: f64, blind: f64, fitness| DescentEnd {
            genes: vec![10_f64.powf(seen), 10_f64.powf(blind)],
            fitness,
        };
        let ends = [
            end(2.0, 0.0, 1.4),
            // the same family as the best, which differs in what the record does not determine
            end(0.4, 3.0, 1.1),
            // a family of its own, but too bad
            end(-2.0, 0.0, 1.6),
            // the second of its family
            end(2.3, 0.0, 1.45),
            end(-1.0, 0.0, 1.2),
        ];
        let best = end(0.0, 0.0, 1.0);
        let found = rivals(&space, (&best.genes, best.fitness), &ends, |name| {
            name == "seen"
        });
        let rival = |end| Rival {
            end,
            differs: vec!["seen"],
        };
        assert_eq!(found, [&ends[4], &ends[0]].map(rival));
        assert!(rivals(&space, (&best.genes, best.fitness), &ends, |_| false).is_empty());
    }
}
