//! Tests of concurrent searches with an evaluator that answers in random order.
use super::*;
use crate::JobNumbers;
use crate::{
    Snapshot, calibrate,
    test_evaluator::{TestEvaluator, case, physics},
};
use search::strategy::memetic::MemeticSettings;

struct Unseen;

impl Watch<ProgressView> for Unseen {
    fn progress(&mut self, _view: &ProgressView, _crew: &dyn Fn() -> Snapshot) {}
}

fn search(population: usize, seed: u64, evaluations: Option<u64>) -> Search {
    let settings = Settings::of(&MemeticSettings {
        generations: 3,
        population,
        ..MemeticSettings::paper()
    });
    Search {
        settings,
        seed,
        evaluations,
    }
}

async fn swept(case: &Case, order: u64, lists: &[&[Search]]) -> (Vec<SearchResult>, usize) {
    let space = Space::new(&case.unknowns).unwrap();
    let mut oracle = TestEvaluator::new(case, order, physics);
    let (_sender, mut stop) = tokio::sync::watch::channel(false);
    let mut sweep = Sweep::new(case, &space);
    let mut found = Vec::new();
    for list in lists {
        let more = sweep.run(&mut oracle, list, &mut Unseen, &mut stop).await;
        found.extend(more.unwrap());
    }
    (found, oracle.computed)
}

/// Checks that the result of a search depends neither on the order of results nor on concurrent searches.
#[tokio::test]
async fn searches_do_not_disturb_each_other() {
    let case = case();
    let all = [
        search(20, 1, None),
        search(30, 2, None),
        search(20, 3, None),
    ];
    let (found, _) = swept(&case, 1, &[&all]).await;
    let (other, _) = swept(&case, 2, &[&all[..1], &all[1..]]).await;
    assert_eq!(found, other);
    let space = Space::new(&case.unknowns).unwrap();
    for (search, found) in all.iter().zip(&found) {
        let mut oracle = TestEvaluator::new(&case, 5, physics);
        let mut alone = build(&search.settings, &space, search.seed).unwrap();
        let (_sender, mut stop) = tokio::sync::watch::channel(false);
        let (alone, watch) = (alone.as_mut(), &mut Unseen);
        let alone = calibrate(&mut oracle, &case, alone, watch, &mut stop).await;
        let alone = alone.unwrap();
        assert_eq!(found.best.as_ref(), Some(&alone.best));
        assert_eq!(found.evaluations, alone.log.len() as u64);
    }
}

/// Checks that different jobs of several searches get different numbers even if their content hashes begin
/// alike.
#[tokio::test]
async fn searches_find_the_same_where_numbers_of_jobs_are_few() {
    let case = case();
    let space = Space::new(&case.unknowns).unwrap();
    let all = [search(20, 1, Some(60)), search(20, 2, Some(60))];
    let (expected, _) = swept(&case, 1, &[&all]).await;
    let mut oracle = TestEvaluator::new(&case, 3, physics);
    oracle.numbers = JobNumbers::with_bits(7);
    let (_sender, mut stop) = tokio::sync::watch::channel(false);
    let mut sweep = Sweep::new(&case, &space);
    let found = sweep.run(&mut oracle, &all, &mut Unseen, &mut stop).await;
    assert_eq!(found.unwrap(), expected);
}

/// Checks that a budget ends a search exactly, even within a batch, with the best of the evaluated
/// individuals.
#[tokio::test]
async fn a_budget_is_kept_to_the_evaluation() {
    let case = case();
    let of = |evaluations| [search(20, 1, Some(evaluations))];
    let (short, computed) = swept(&case, 1, &[&of(33)]).await;
    assert_eq!((short[0].evaluations, computed), (33, 33));
    let (longer, _) = swept(&case, 1, &[&of(60)]).await;
    let fitness = |found: &[SearchResult]| found[0].best.as_ref().unwrap().fitness;
    assert!(fitness(&longer) <= fitness(&short));
}

/// Checks that an individual requested by several searches is computed once, even in a later call.
#[tokio::test]
async fn equal_individuals_are_computed_once() {
    let case = case();
    let one = [search(20, 1, None)];
    let (_, alone) = swept(&case, 1, &[&one]).await;
    let twice = [one[0].clone(), one[0].clone()];
    let (found, computed) = swept(&case, 3, &[&twice, &one]).await;
    assert_eq!(computed, alone);
    assert!(found.iter().all(|own| *own == found[0]));
}
