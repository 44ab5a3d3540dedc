//! Tests of the sliding-window memetic algorithm with windows of several sizes: plan, independence of the
//! order in which results arrive, and cost of a window.
use super::*;
use crate::test_function::{SPHERE, TestFunction};

fn settings(window: usize) -> WindowSettings {
    WindowSettings {
        window,
        memetic: MemeticSettings {
            population: 12,
            generations: 8,
            crossover_trials: 2,
            mutation_trials: 3,
            ..MemeticSettings::paper()
        },
    }
}

/// Runs a sliding-window search to its end, answering one open proposal per step: the first, or with `order`
/// a random one.
fn run(settings: &WindowSettings, function: &TestFunction, order: Option<u64>) -> Window {
    let space = function.space();
    let mut window = Window::new(settings, &space, 3).unwrap();
    let mut stream = order.map(|order| Streams::new(order, 9).at(0, Phase::Initial, 0));
    let mut open: Vec<Proposal> = Vec::new();
    while window.finished().is_none() {
        open.extend(window.ask());
        let at = stream.as_mut().map_or(0, |stream| stream.index(open.len()));
        let proposal = open.remove(at);
        window.tell(proposal.id, function.tell(&space, &proposal.genes));
    }
    window
}

#[test]
fn a_window_of_any_size_does_not_see_the_order_of_arrival() {
    for window in [1, 5, 12, 40] {
        let straight = run(&settings(window), &SPHERE, None);
        for order in 1..=4 {
            let shuffled = run(&settings(window), &SPHERE, Some(order));
            assert_eq!(
                straight.archive.entries(),
                shuffled.archive.entries(),
                "{window} {order}"
            );
        }
    }
}

/// Checks that individual k depends on no result after k - L, by changing one result.
#[test]
fn individual_k_depends_on_results_up_to_k_minus_the_window_and_on_no_later_one() {
    let window = 7;
    let function = SPHERE;
    let space = function.space();
    let record = |changed: Option<u64>| {
        let mut search = Window::new(&settings(window), &space, 5).unwrap();
        let mut all = Vec::new();
        while search.finished().is_none() {
            for proposal in search.ask() {
                let mut told = function.tell(&space, &proposal.genes);
                if changed == Some(proposal.id) {
                    // better than everything: it must become a parent at once
                    told.fitness = -1.0;
                }
                search.tell(proposal.id, told);
                all.push(proposal.genes);
            }
        }
        all
    };
    let plain = record(None);
    for changed in [20_u64, 33, 50] {
        let other = record(Some(changed));
        let first = (0..)
            .zip(plain.iter().zip(&other))
            .find(|(_, (a, b))| a != b);
        let first = first.expect("it must matter").0;
        let earliest = changed + window as u64;
        assert!(
            (earliest..earliest + 4).contains(&first),
            "result {changed} first shows in individual {first}"
        );
    }
}

#[test]
fn at_most_a_window_is_open_after_the_first_population_and_trials_have_their_share() {
    let settings = settings(5);
    let space = SPHERE.space();
    let mut search = Window::new(&settings, &space, 1).unwrap();
    let (mut open, mut purposes) = (0, BTreeMap::new());
    while search.finished().is_none() {
        for proposal in search.ask() {
            open += 1;
            *purposes.entry(proposal.purpose).or_insert(0) += 1;
        }
        let consumed = search.archive.entries().len() as u64;
        assert!(
            open <= 5 || consumed + open <= 12,
            "{open} after {consumed}"
        );
        let genes = search.operators.codec.decode(&search.open[0]);
        search.tell(consumed, SPHERE.tell(&space, &genes));
        open -= 1;
    }
    let expected = [
        (Purpose::Initial, 12),
        (Purpose::Offspring, 8 * 12),
        (Purpose::CrossoverTrial, 8 * 2),
        (Purpose::MutationTrial, 8 * 3),
    ];
    assert_eq!(purposes, BTreeMap::from(expected));
}

#[test]
fn a_threshold_ends_the_search_at_the_same_individual_whatever_has_arrived() {
    let mut settings = settings(9);
    settings.memetic.threshold = Some(3.0);
    let straight = run(&settings, &SPHERE, None);
    assert_eq!(straight.finished(), Some(Finish::Threshold));
    let length = straight.archive.entries().len();
    for order in 1..4 {
        let other = run(&settings, &SPHERE, Some(order));
        assert_eq!(other.archive.entries().len(), length);
    }
}
