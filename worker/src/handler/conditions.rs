//! Joins the scores of one individual under several conditions.
use protocol::{
    case::Objective,
    job::{Derivative, Evaluation, Failure, SimulateSpec, Verdict, to_single_precision},
};

/// Scores an individual under every calibrated condition in order, and joins the scores: fitness is summed
/// with the weights of the conditions, residuals and their derivatives are concatenated, times the roots of
/// the weights. A failure under one condition fails the whole
/// individual, is graded by that failure, and skips the remaining conditions.
///
/// # Errors
/// The first failure to simulate at all.
pub(super) fn scored(
    objective: &Objective,
    spec: &SimulateSpec,
    score: impl Fn(&SimulateSpec) -> Result<Evaluation, Failure>,
) -> Result<Evaluation, Failure> {
    let mut whole = score(spec)?;
    for other in &objective.others {
        if whole.verdict != Verdict::Complete {
            break;
        }
        let mut own = spec.clone();
        own.individual.condition = other.condition;
        whole = joined(whole, weighted(score(&own)?, other.weight));
    }
    Ok(whole)
}

/// Multiplies the errors of a complete evaluation by the weight of its condition: its fitness by the weight,
/// its residual and their derivatives by the root, so that the squared norm of the residual stays the fitness.
fn weighted(mut evaluation: Evaluation, weight: f64) -> Evaluation {
    if evaluation.verdict != Verdict::Complete {
        return evaluation;
    }
    let root = weight.sqrt();
    evaluation.fitness *= weight;
    for value in &mut evaluation.residual {
        *value *= root;
    }
    for column in &mut evaluation.columns {
        if let Derivative::Curves { curves, .. } = column {
            for curve in curves {
                *curve = to_single_precision(curve.iter().map(|x| f64::from(*x) * root));
            }
        }
    }
    evaluation
}

/// Joins the evaluations of an individual so far with that under the next condition; the evaluations so far
/// must be complete.
fn joined(mut sum: Evaluation, next: Evaluation) -> Evaluation {
    sum.counters.add(&next.counters);
    if next.verdict != Verdict::Complete {
        let counters = sum.counters;
        return Evaluation { counters, ..next };
    }
    let lengths = (sum.residual.len(), next.residual.len());
    sum.fitness += next.fitness;
    sum.channels.extend(next.channels);
    sum.residual.extend(next.residual);
    let columns = sum.columns.into_iter().zip(next.columns);
    sum.columns = columns
        .map(|(a, b)| concatenate_derivatives(lengths, a, b))
        .collect();
    sum
}

/// Concatenates the derivatives of two residuals of the given lengths; where a parameter has no effect under
/// one of the conditions, that part is zero.
fn concatenate_derivatives(
    (first, second): (usize, usize),
    a: Derivative,
    b: Derivative,
) -> Derivative {
    let nothing = |length: usize| vec![0.0_f32; length];
    let (per, ahead, behind) = match (a, b) {
        (nothing @ Derivative::Nothing { .. }, Derivative::Nothing { .. }) => return nothing,
        (Derivative::Curves { per, curves }, Derivative::Curves { curves: more, .. }) => {
            (per, flatten(curves), flatten(more))
        }
        (Derivative::Curves { per, curves }, Derivative::Nothing { .. }) => {
            (per, flatten(curves), nothing(second))
        }
        (Derivative::Nothing { .. }, Derivative::Curves { per, curves }) => {
            (per, nothing(first), flatten(curves))
        }
        (missing @ Derivative::Missing { .. }, _) | (_, missing @ Derivative::Missing { .. }) => {
            return missing;
        }
    };
    let curves = vec![[ahead, behind].concat()];
    Derivative::Curves { per, curves }
}

fn flatten(curves: Vec<Vec<f32>>) -> Vec<f32> {
    curves.into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::{
        case::{Term, WeightedCondition},
        job::{Counters, Identifier, Individual, Per, Reached, Reply},
    };

    fn evaluation(fitness: f64, columns: Vec<Derivative>) -> Evaluation {
        Evaluation {
            verdict: Verdict::Complete,
            fitness,
            channels: Vec::new(),
            residual: vec![fitness; 2],
            columns,
            counters: Counters {
                steps: 10,
                ..Counters::default()
            },
        }
    }

    const NOTHING: Derivative = Derivative::Nothing { per: Per::Decade };

    fn column(values: [f32; 2]) -> Derivative {
        Derivative::Curves {
            per: Per::Decade,
            curves: vec![values.to_vec()],
        }
    }

    fn over(others: &[(usize, f64)]) -> (Objective, SimulateSpec) {
        let objective = Objective {
            condition: 1,
            others: others
                .iter()
                .map(|&(condition, weight)| WeightedCondition { condition, weight })
                .collect(),
            terms: vec![Term {
                channel: "force".to_owned(),
                weight: 1.0,
            }],
        };
        let individual = Individual::new(1, vec![1.0]);
        let reply = Reply::Score {
            with_residual: true,
            whole: true,
        };
        (objective, SimulateSpec::new(individual, reply))
    }

    #[test]
    fn conditions_are_added_up_in_their_order_with_their_weights() {
        let (objective, spec) = over(&[(0, 1.0), (2, 0.25)]);
        let missing = || Derivative::Missing {
            reason: "at rest".to_owned(),
        };
        let score = |spec: &SimulateSpec| {
            Ok(match spec.individual.condition {
                1 => evaluation(1.0, vec![column([1.0, 2.0]), NOTHING, missing(), NOTHING]),
                0 => evaluation(
                    2.0,
                    vec![
                        column([3.0, 4.0]),
                        column([5.0, 6.0]),
                        column([0.0; 2]),
                        NOTHING,
                    ],
                ),
                _ => evaluation(
                    4.0,
                    vec![column([8.0, 0.0]), NOTHING, column([0.0; 2]), NOTHING],
                ),
            })
        };
        let whole = scored(&objective, &spec, score).unwrap();
        assert_eq!((whole.fitness, whole.counters.steps), (4.0, 30));
        assert_eq!(whole.residual, [1.0, 1.0, 2.0, 2.0, 2.0, 2.0]);
        let curve = |values: &[f32]| Derivative::Curves {
            per: Per::Decade,
            curves: vec![values.to_vec()],
        };
        let expected = [
            curve(&[1.0, 2.0, 3.0, 4.0, 4.0, 0.0]),
            curve(&[0.0, 0.0, 5.0, 6.0, 0.0, 0.0]),
            missing(),
            NOTHING,
        ];
        assert_eq!(whole.columns, expected);
    }

    #[test]
    fn what_fails_under_one_condition_fails_and_goes_no_further() {
        let (objective, spec) = over(&[(0, 1.0), (2, 0.25)]);
        let failed = Verdict::Failed {
            kind: Identifier::parse("diverged").unwrap(),
            reached: Reached::TimeFraction(0.5),
        };
        let score = |spec: &SimulateSpec| {
            assert_ne!(spec.individual.condition, 2, "not simulated");
            let own = evaluation(1.0, Vec::new());
            Ok(match spec.individual.condition {
                0 => Evaluation {
                    verdict: failed,
                    fitness: 1e6,
                    residual: Vec::new(),
                    ..own
                },
                _ => own,
            })
        };
        let whole = scored(&objective, &spec, score).unwrap();
        assert_eq!((whole.verdict, whole.fitness), (failed, 1e6));
        assert_eq!(whole.counters.steps, 20);
        assert!(whole.residual.is_empty());
    }
}
