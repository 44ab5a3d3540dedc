//! Tests of an objective over both conditions of the shipped machine, and of jobs with derivatives in parts.
use super::folder;
use case::Overrides;
use protocol::{
    case::{Case, WeightedCondition},
    job::{Column, Evaluation, Individual, Job, Reply, SimulateSpec},
};
use worker::handler::Prepared;

const WEIGHT: f64 = 0.25;

fn weighted() -> Case {
    let mut case = case::load(&folder(), &Overrides::default()).unwrap();
    case.objective.others = vec![WeightedCondition {
        condition: case.condition("4rpm").unwrap(),
        weight: WEIGHT,
    }];
    case
}

fn score(
    prepared: &Prepared,
    case: &Case,
    (condition, whole): (&str, bool),
    columns: &[&str],
) -> Evaluation {
    let condition = case.condition(condition).unwrap();
    let reply = Reply::Score {
        with_residual: true,
        whole,
    };
    let spec = SimulateSpec {
        columns: columns.iter().map(|name| Column::new(*name)).collect(),
        ..SimulateSpec::new(Individual::new(condition, case.start()), reply)
    };
    let answer = prepared.evaluate(&Job::Simulate(spec)).done().unwrap();
    answer.into_scored().unwrap()
}

/// Checks that the objective is the weighted sum over the conditions, that the squared norm of the residual is the
/// objective, and that derivatives computed in parts are, bit for bit, those computed together.
#[test]
fn conditions_are_summed_with_their_weights_and_parts_give_the_same_bits() {
    let case = weighted();
    let prepared = Prepared::new(worker::SIMULATORS, &case).unwrap();
    let [fast, slow] = ["5rpm", "4rpm"].map(|name| score(&prepared, &case, (name, false), &[]));
    let names = ["kb1", "cc", "kb4"];
    let whole = score(&prepared, &case, ("5rpm", true), &names);
    assert_eq!(
        whole.fitness.to_bits(),
        (fast.fitness + WEIGHT * slow.fitness).to_bits()
    );
    assert_eq!(
        whole.residual.len(),
        fast.residual.len() + slow.residual.len()
    );
    let squares: f64 = whole.residual.iter().map(|r| r * r).sum();
    assert!((squares / whole.fitness - 1.0).abs() < 1e-12, "{squares}");
    let parts = [&names[..1], &names[1..]];
    let parts = parts.map(|names| score(&prepared, &case, ("5rpm", true), names));
    for part in &parts {
        assert_eq!(part.fitness.to_bits(), whole.fitness.to_bits());
        assert_eq!(part.residual, whole.residual);
        assert_eq!(
            (part.counters, &part.channels),
            (whole.counters, &whole.channels)
        );
    }
    let [first, second] = parts;
    assert_eq!([first.columns, second.columns].concat(), whole.columns);
}
