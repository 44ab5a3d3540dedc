//! Laws that every preset of the catalogue obeys.
use super::{memetic::MemeticSettings, *};
use crate::{
    random::{Phase, Stream, Streams},
    test_function::{self, RESONANCE, SPHERE, TestFunction},
};
use protocol::{
    case::{Coefficient, Gene, Quantity},
    unit::Unit,
};
use std::collections::BTreeMap;

/// A function that strategies are held to.
pub(super) type Tell<'a> = dyn Fn(&[f64]) -> Told + 'a;

/// Everything a run leaves behind, in id order.
#[derive(Debug, PartialEq)]
pub(super) struct Record {
    pub(super) asked: Vec<Proposal>,
    pub(super) told: Vec<Told>,
    pub(super) best: Best,
    pub(super) finish: Finish,
}

/// Runs a strategy to its end; `reorder` shuffles the open proposals before one is told.
pub(super) fn run(strategy: &mut dyn Strategy, tell: &Tell<'_>, reorder: Option<Stream>) -> Record {
    run_with(strategy, tell, &|_| Vec::new(), reorder)
}

/// Runs a strategy on a function, residual vectors included.
fn run_on(strategy: &mut dyn Strategy, function: &TestFunction, reorder: Option<Stream>) -> Record {
    let space = function.space();
    run_with(
        strategy,
        &|genes| function.tell(&space, genes),
        &|genes| function.residual(&space, genes),
        reorder,
    )
}

fn run_with(
    strategy: &mut dyn Strategy,
    tell: &Tell<'_>,
    residual: &dyn Fn(&[f64]) -> Vec<f64>,
    mut reorder: Option<Stream>,
) -> Record {
    let (mut asked, mut told, mut open) = (Vec::new(), BTreeMap::new(), Vec::new());
    while strategy.finished().is_none() {
        for proposal in strategy.ask() {
            open.push(proposal.clone());
            asked.push(proposal);
        }
        let position = reorder
            .as_mut()
            .map_or(0, |stream| stream.index(open.len()));
        let proposal: Proposal = open.remove(position);
        let result = tell(&proposal.genes);
        told.insert(proposal.id, result);
        if proposal.purpose.wants_residual() {
            strategy.tell_residual(proposal.id, residual(&proposal.genes));
        }
        strategy.tell(proposal.id, result);
    }
    assert!(strategy.ask().is_empty(), "nothing is asked after the end");
    Record {
        asked,
        told: told.into_values().collect(),
        best: strategy.best().unwrap(),
        finish: strategy.finished().unwrap(),
    }
}

fn run_preset(preset: &Preset, function: &TestFunction, seed: u64, order: Option<u64>) -> Record {
    let space = function.space();
    let mut strategy = (preset.settings)(&space).build(&space, seed).unwrap();
    let reorder = order.map(|order| Streams::new(order, 99).at(0, Phase::Initial, 0));
    run_on(strategy.as_mut(), function, reorder)
}

#[test]
fn the_result_does_not_depend_on_the_order_of_arrival() {
    for preset in CATALOGUE {
        let straight = run_preset(preset, &test_function::CLIFF, 11, None);
        for order in 1..=3 {
            let shuffled = run_preset(preset, &test_function::CLIFF, 11, Some(order));
            assert_eq!(straight, shuffled, "{}", preset.name);
        }
    }
}

#[test]
fn the_seed_decides_and_ids_are_consecutive() {
    for preset in CATALOGUE {
        let one = run_preset(preset, &SPHERE, 5, None);
        assert_eq!(one, run_preset(preset, &SPHERE, 5, None), "{}", preset.name);
        assert_ne!(
            one.best,
            run_preset(preset, &SPHERE, 6, None).best,
            "{}",
            preset.name
        );
        for (id, proposal) in (0..).zip(&one.asked) {
            assert_eq!(proposal.id, id, "{}", preset.name);
        }
        for pair in one.asked.windows(2) {
            assert!(pair[0].generation <= pair[1].generation, "{}", preset.name);
        }
    }
}

#[test]
fn a_replay_of_the_first_results_gives_the_same_state() {
    for preset in CATALOGUE {
        let whole = run_preset(preset, &SPHERE, 2, None);
        let space = SPHERE.space();
        let cut = whole.told.len() / 3;
        let mut again = (preset.settings)(&space).build(&space, 2).unwrap();
        let mut asked = again.ask();
        for (id, told) in (0..).zip(&whole.told[..cut]) {
            again.tell(id, *told);
            asked.extend(again.ask());
        }
        assert_eq!(asked[..], whole.asked[..asked.len()], "{}", preset.name);
        assert_eq!(again.progress().evaluations, cut as u64, "{}", preset.name);
        let best = whole.told[..cut]
            .iter()
            .map(|told| told.fitness)
            .fold(f64::MAX, f64::min);
        assert_eq!(again.progress().best_fitness, Some(best), "{}", preset.name);
    }
}

#[test]
fn bounds_are_never_left_and_the_recommended_individual_opens_a_quick_search() {
    for preset in CATALOGUE {
        // a minimum outside the box pulls everything against its walls
        let far = SPHERE.moved(&[6.0, -6.0, 5.0, 5.0]);
        let space = far.space();
        let record = run_preset(preset, &far, 3, None);
        for proposal in &record.asked {
            for (value, axis) in proposal.genes.iter().zip(space.axes()) {
                assert!((axis.lower..=axis.upper).contains(value), "{}", preset.name);
            }
        }
        if preset.name == "quick" {
            for x in space.point(&record.asked[0].genes) {
                assert!(x.abs() < 5e-5, "{x}");
            }
        }
    }
}

#[test]
fn if_everything_fails_the_search_still_ends() {
    let space = SPHERE.space();
    let all_failures: [&Tell<'_>; 3] = [
        &|genes| Told {
            fitness: 1e6 + genes[0],
            complete: false,
        },
        &|_| Told {
            fitness: f64::INFINITY,
            complete: false,
        },
        &|_| Told {
            fitness: f64::NAN,
            complete: true,
        },
    ];
    for preset in CATALOGUE {
        for tell in all_failures {
            let mut strategy = (preset.settings)(&space).build(&space, 4).unwrap();
            let record = run(strategy.as_mut(), tell, None);
            assert!(!record.best.complete, "{}", preset.name);
            assert_eq!(strategy.progress().best_fitness, None, "{}", preset.name);
        }
    }
}

#[test]
fn a_failure_is_never_best_beside_a_complete_run() {
    let space = SPHERE.space();
    for preset in CATALOGUE {
        // failures with a fitness that beats everything, to prove that the flag decides
        let tell = |genes: &[f64]| {
            let told = SPHERE.tell(&space, genes);
            let complete = space.point(genes)[0] < 0.5;
            Told {
                fitness: if complete { told.fitness } else { -1.0 },
                complete,
            }
        };
        let mut strategy = (preset.settings)(&space).build(&space, 8).unwrap();
        while strategy.finished().is_none() {
            for proposal in strategy.ask() {
                strategy.tell(proposal.id, tell(&proposal.genes));
                let best = strategy.best().unwrap();
                let any = strategy
                    .archive()
                    .entries()
                    .iter()
                    .any(|entry| entry.told.complete);
                assert_eq!(best.complete, any, "{}", preset.name);
            }
        }
    }
}

#[test]
fn progress_ends_at_what_was_expected() {
    for preset in CATALOGUE {
        let space = SPHERE.space();
        let mut strategy = (preset.settings)(&space).build(&space, 1).unwrap();
        let first = strategy.progress();
        assert_eq!(first.evaluations, 0);
        run_on(strategy.as_mut(), &SPHERE, None);
        let last = strategy.progress();
        assert_eq!(
            last.evaluations, last.expected_evaluations,
            "{}",
            preset.name
        );
        assert_eq!(last.generation, last.generations, "{}", preset.name);
        let ratio = last.evaluations as f64 / first.expected_evaluations as f64;
        assert!((0.7..1.4).contains(&ratio), "{}: {ratio}", preset.name);
    }
}

#[test]
fn every_preset_finds_every_easy_minimum() {
    for preset in CATALOGUE {
        for function in [SPHERE, test_function::CLIFF] {
            let found = run_preset(preset, &function, 21, None).best;
            let enough = match preset.name {
                "quick" => 1e-4,
                "least-squares" => 1e-8,
                _ => 0.1,
            };
            assert!(
                found.fitness < enough,
                "{} {}: {}",
                preset.name,
                function.name,
                found.fitness
            );
        }
        let found = run_preset(preset, &test_function::RASTRIGIN, 21, None).best;
        assert!(found.fitness < 1.1, "{}: {}", preset.name, found.fitness);
    }
}

/// Two coefficients beside two parameters of effects: one negative, one that begins at its lower bound.
/// Every preset finds the minimum, and none leaves the bounds.
#[test]
fn linear_axes_are_searched_like_logarithmic_ones() {
    let linear = |parameter: &str, recommended: f64, [lower, upper]: [f64; 2]| Gene {
        quantity: Quantity::Effect {
            id: "effect".to_owned(),
            parameter: parameter.to_owned(),
            unit: "N".to_owned(),
        },
        recommended,
        lower,
        upper,
    };
    let stiffness = |name| Gene::coefficient(name, Unit::NewtonPerMetre, 1e8, [1e4, 1e12]);
    let space = Space::new(&[
        stiffness(Coefficient::Kb1),
        stiffness(Coefficient::Kb23),
        linear("negative", -0.2, [-1.0, 0.2]),
        linear("one-sided", 0.0, [0.0, 10.0]),
    ])
    .unwrap();
    let function = SPHERE.moved(&[0.7, -0.3, -0.5, 0.9]);
    let minimum = [1e8 * libm::exp10(0.7), 1e8 * libm::exp10(-0.3), -0.5, 4.5];
    for preset in CATALOGUE {
        let mut strategy = (preset.settings)(&space).build(&space, 21).unwrap();
        let record = run_with(
            strategy.as_mut(),
            &|genes| function.tell(&space, genes),
            &|genes| function.residual(&space, genes),
            None,
        );
        for proposal in &record.asked {
            for (value, axis) in proposal.genes.iter().zip(space.axes()) {
                assert!((axis.lower..=axis.upper).contains(value), "{}", preset.name);
            }
        }
        let enough = match preset.name {
            "quick" => 0.01,
            "least-squares" => 1e-4,
            _ => 0.3,
        };
        let found = &record.best.genes;
        for (x, wanted) in space.point(found).iter().zip(space.point(&minimum)) {
            assert!((x - wanted).abs() < enough, "{}: {found:?}", preset.name);
        }
    }
}

#[test]
fn settings_outside_their_range_are_refused_by_name() {
    let space = SPHERE.space();
    let bad = MemeticSettings {
        crossover_probability: 1.5,
        ..MemeticSettings::paper()
    };
    let error = Settings::Memetic(bad).build(&space, 0).err().unwrap();
    assert_eq!(
        error.to_string(),
        "crossover_probability is 1.5, but must be 0 to 1"
    );
    let mut quick = quick::QuickSettings::for_space(&space);
    quick.trust.pop();
    assert!(Settings::Quick(quick).build(&space, 0).is_err());
}

#[test]
fn refining_presets_enter_the_valley_wherever_it_lies() {
    // true stiffness up to half a decade from Table 3, true damping from Table 3 to far above
    let truths: [&'static [f64]; 6] = [
        &[0.4, 0.26, 0.27, 0.35, 3.0, 1.03, 0.05, 0.15, 2.6, 1.31],
        &[-0.07, 0.5, 0.2, 0.1, 2.7, 1.5, 0.5, 0.4, 2.9, 0.6],
        &[0.88, 0.1, 0.4, 0.7, 3.4, 0.3, 0.2, 0.9, 2.2, 1.0],
        &[0.63, 0.7, 0.0, 0.5, 2.2, 2.0, 1.0, 0.2, 2.5, 1.8],
        &[0.17, 0.3, 0.1, 0.3, 3.2, 1.0, 0.0, 0.6, 3.1, 0.2],
        &[0.511, 0.3, 0.1, 0.0, 1.4, 1.0, 0.0, 0.6, 2.7, 0.2],
    ];
    for name in ["quick", "least-squares"] {
        let preset = preset(name).unwrap();
        let (mut found, mut runs) = (0, 0);
        for truth in truths {
            for seed in 1..=4 {
                let function = RESONANCE.moved(truth);
                let record = run_preset(preset, &function, seed, None);
                assert!(
                    record.asked.len() <= 1_100,
                    "{name}: {}",
                    record.asked.len()
                );
                runs += 1;
                found += u32::from(record.best.fitness < 0.03);
            }
        }
        assert!(found * 10 >= runs * 9, "{name}: {found} of {runs}");
    }
}
