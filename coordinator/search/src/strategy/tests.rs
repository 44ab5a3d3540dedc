//! Requirements that every preset of the catalogue fulfils.
use super::{memetic::MemeticSettings, staged::StagedSettings, *};
use crate::{
    random::{Phase, Stream, Streams},
    space::Space,
    test_function::{self, RESONANCE, SPHERE, TestFunction},
};
use protocol::case::{Scale, Unknown};
use std::collections::BTreeMap;

/// Test objective: returns the result of an individual with the given gene values.
pub(super) type Tell<'a> = dyn Fn(&[f64]) -> EvaluationResult + 'a;

/// Record of a search under test: proposals and results in id order, best individual, and reason for its end.
#[derive(Debug, PartialEq)]
pub(super) struct Record {
    pub(super) asked: Vec<Proposal>,
    pub(super) told: Vec<EvaluationResult>,
    pub(super) best: Best,
    pub(super) finish: Finish,
}

/// Runs a strategy to its end on the objective `tell`; with `reorder`, open proposals are answered in random
/// order.
pub(super) fn run(strategy: &mut dyn Strategy, tell: &Tell<'_>, reorder: Option<Stream>) -> Record {
    run_with(strategy, tell, &|_| Vec::new(), reorder)
}

/// Runs a strategy to its end on a test function that also provides residual vectors.
pub(super) fn run_on(
    strategy: &mut dyn Strategy,
    function: &TestFunction,
    reorder: Option<Stream>,
) -> Record {
    let space = function.space();
    run_with(
        strategy,
        &|genes| function.tell(&space, genes),
        &|genes| function.residual(&space, genes),
        reorder,
    )
}

/// Runs a strategy to its end on an objective and a residual vector of the gene values.
pub(super) fn run_with(
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
            let (values, by) = (residual(&proposal.genes), BTreeMap::new());
            strategy.tell_residual(
                proposal.id,
                Residual {
                    values,
                    derivatives: by,
                },
            );
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

/// Returns a preset's settings for a space, with 16 planned workers.
pub(super) fn settings(preset: &Preset, space: &Space) -> Settings {
    (preset.settings)(&SearchPlan { space, workers: 16 })
}

fn made(preset: &Preset, space: &Space, seed: u64) -> Box<dyn Strategy> {
    build(&settings(preset, space), space, seed).unwrap()
}

fn run_preset(preset: &Preset, function: &TestFunction, seed: u64, order: Option<u64>) -> Record {
    let space = function.space();
    let mut strategy = made(preset, &space, seed);
    let reorder = order.map(|order| Streams::new(order, 99).at(0, Phase::Initial, 0));
    run_on(strategy.as_mut(), function, reorder)
}

impl Record {
    /// Returns the FNV-1a hash of all proposals of the recorded search and of its best fitness.
    pub(super) fn bits(&self) -> u64 {
        let mut hash = 0xcbf2_9ce4_8422_2325_u64;
        let mut add = |bytes: &[u8]| {
            for byte in bytes {
                hash = (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
            }
        };
        for proposal in &self.asked {
            add(&proposal.id.to_le_bytes());
            add(&proposal.generation.to_le_bytes());
            add(proposal.purpose.as_str().as_bytes());
            for gene in &proposal.genes {
                add(&gene.to_bits().to_le_bytes());
            }
        }
        add(&self.best.fitness.to_bits().to_le_bytes());
        hash
    }
}

/// Checks, by a hash, that a search over ten genes is bit-identical from one program version to the next.
#[test]
fn the_bits_of_every_preset_stay() {
    let frozen = [
        ("quick", 0x8271_1539_3b72_c7ff),
        ("memetic", 0xaff2_9ab8_8a60_5ccc),
        ("least-squares", 0xe6e3_4944_ef6c_20a7),
        ("hybrid", 0x165b_cdda_ecdd_bace),
        ("cma-es", 0x2862_dc27_a593_03d9),
        ("l-shade", 0x5195_2faa_3a58_243a),
        ("paper", 0xf6d4_4582_7373_c45c),
        ("paper-batch", 0xedd7_0ec3_b5b0_1ef7),
        ("window", 0xd885_4af3_a20d_69fd),
    ];
    for (name, bits) in frozen {
        let record = run_preset(preset(name).unwrap(), &RESONANCE, 7, None);
        assert_eq!(record.bits(), bits, "{name}: {:#x}", record.bits());
    }
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

/// Checks that asking for what a search anticipates changes nothing, and that descents whose results are all
/// there anticipate what they propose next.
#[test]
fn anticipation_changes_nothing_and_comes_true() {
    let space = RESONANCE.space();
    let preset = preset("least-squares").unwrap();
    let (mut strategy, mut silent) = (made(preset, &space, 3), made(preset, &space, 3));
    let (mut open, mut anticipated) = (Vec::new(), Vec::new());
    let (mut right, mut proposed) = (0, 0);
    while strategy.finished().is_none() {
        let asked = strategy.ask();
        assert_eq!(asked, silent.ask());
        for proposal in &asked {
            let draft = ProposalDraft {
                genes: proposal.genes.clone(),
                purpose: proposal.purpose,
            };
            if proposal.purpose == Purpose::LeastSquares {
                proposed += 1;
                right += u32::from(anticipated.contains(&draft));
            }
        }
        open.extend(asked);
        anticipated = strategy.anticipate();
        let proposal: Proposal = open.remove(0);
        let result = RESONANCE.tell(&space, &proposal.genes);
        for one in [&mut strategy, &mut silent] {
            if proposal.purpose.wants_residual() {
                let residual = Residual {
                    values: RESONANCE.residual(&space, &proposal.genes),
                    ..Residual::default()
                };
                one.tell_residual(proposal.id, residual);
            }
            one.tell(proposal.id, result);
        }
    }
    assert_eq!(strategy.best(), silent.best());
    // of four descents three are complete when the next batch is anticipated, and of the last one none
    assert!(4 * right > proposed, "{right} of {proposed}");
}

#[test]
fn the_seed_decides_and_ids_are_consecutive() {
    for preset in CATALOGUE {
        let one = run_preset(preset, &SPHERE, 5, None);
        assert_eq!(one, run_preset(preset, &SPHERE, 5, None), "{}", preset.name);
        let other = run_preset(preset, &SPHERE, 6, None);
        let differs = one.asked != other.asked;
        assert_eq!(
            differs,
            expectations::of(preset.name).seed_dependent,
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
        let mut again = made(preset, &space, 2);
        let mut asked = again.ask();
        for (proposal, told) in whole.asked.iter().zip(&whole.told[..cut]) {
            if proposal.purpose.wants_residual() {
                let values = SPHERE.residual(&space, &proposal.genes);
                let by = BTreeMap::new();
                again.tell_residual(
                    proposal.id,
                    Residual {
                        values,
                        derivatives: by,
                    },
                );
            }
            again.tell(proposal.id, *told);
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
                let bounds = axis.unknown.lower..=axis.unknown.upper;
                assert!(bounds.contains(value), "{}", preset.name);
            }
        }
        if expectations::of(preset.name).starts_at_recommended {
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
        &|genes| EvaluationResult {
            fitness: 1e6 + genes[0],
            complete: false,
        },
        &|_| EvaluationResult {
            fitness: f64::INFINITY,
            complete: false,
        },
        &|_| EvaluationResult {
            fitness: f64::NAN,
            complete: true,
        },
    ];
    for preset in CATALOGUE {
        for tell in all_failures {
            let mut strategy = made(preset, &space, 4);
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
            EvaluationResult {
                fitness: if complete { told.fitness } else { -1.0 },
                complete,
            }
        };
        let mut strategy = made(preset, &space, 8);
        while strategy.finished().is_none() {
            for proposal in strategy.ask() {
                strategy.tell(proposal.id, tell(&proposal.genes));
                let best = strategy.best().unwrap();
                let any = strategy
                    .archive()
                    .entries()
                    .iter()
                    .any(|entry| entry.result.complete);
                assert_eq!(best.complete, any, "{}", preset.name);
            }
        }
    }
}

#[test]
fn progress_ends_at_what_was_expected() {
    for preset in CATALOGUE {
        let space = SPHERE.space();
        let mut strategy = made(preset, &space, 1);
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
        // every descent ends in the one minimum: both base points of a scan are the same, and its stations known
        let least = if preset.name == "quick" { 0.5 } else { 0.7 };
        assert!((least..1.4).contains(&ratio), "{}: {ratio}", preset.name);
    }
}

#[test]
fn every_preset_finds_the_minima_that_it_promises_to_find() {
    for preset in CATALOGUE {
        let best = |function| run_preset(preset, &function, 21, None).best.fitness;
        for function in [SPHERE, test_function::CLIFF] {
            let (found, name) = (best(function), function.name);
            assert!(
                found < expectations::of(preset.name).one_basin,
                "{} {name}: {found}",
                preset.name
            );
        }
        let found = best(test_function::RASTRIGIN);
        assert!(
            found < expectations::of(preset.name).many_basins,
            "{}: {found}",
            preset.name
        );
    }
}

/// Checks that every preset finds the minimum within the bounds with two logarithmic and two linear unknowns:
/// one linear start is negative, the other is at its lower bound.
#[test]
fn linear_axes_are_searched_like_logarithmic_ones() {
    let linear = |name, start, bounds| Unknown::new(name, "N", Scale::Linear, start, bounds);
    let logarithmic = |name| Unknown {
        trust: Some([-1.0, 1.5]),
        ..Unknown::new(name, "N/m", Scale::Logarithmic, 1e8, [1e4, 1e12])
    };
    let space = Space::new(&[
        logarithmic("first"),
        logarithmic("second"),
        linear("negative", -0.2, [-1.0, 0.2]),
        linear("one-sided", 0.0, [0.0, 10.0]),
    ])
    .unwrap();
    let function = SPHERE.moved(&[0.7, -0.3, -0.5, 0.9]);
    let minimum = [1e8 * libm::exp10(0.7), 1e8 * libm::exp10(-0.3), -0.5, 4.5];
    for preset in CATALOGUE {
        let mut strategy = made(preset, &space, 21);
        let record = run_with(
            strategy.as_mut(),
            &|genes| function.tell(&space, genes),
            &|genes| function.residual(&space, genes),
            None,
        );
        for proposal in &record.asked {
            for (value, axis) in proposal.genes.iter().zip(space.axes()) {
                let bounds = axis.unknown.lower..=axis.unknown.upper;
                assert!(bounds.contains(value), "{}", preset.name);
            }
        }
        let found = &record.best.genes;
        for (x, wanted) in space.point(found).iter().zip(space.point(&minimum)) {
            let far = (x - wanted).abs();
            assert!(
                far < expectations::of(preset.name).distance,
                "{}: {found:?}",
                preset.name
            );
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
    let error = build(&Settings::of(&bad), &space, 0).err().unwrap();
    assert_eq!(
        error.to_string(),
        "crossover_probability is 1.5, but must be 0 to 1"
    );
    let mut quick = StagedSettings::quick(&space);
    quick.trust.pop();
    assert!(build(&Settings::of(&quick), &space, 0).is_err());
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
    for preset in CATALOGUE {
        let Some(most) = expectations::of(preset.name).valley_evaluations else {
            continue;
        };
        let (mut found, mut runs) = (0, 0);
        for truth in truths {
            for seed in 1..=4 {
                let function = RESONANCE.moved(truth);
                let record = run_preset(preset, &function, seed, None);
                let asked = record.asked.len();
                assert!(asked <= most, "{}: {asked}", preset.name);
                runs += 1;
                found += u32::from(record.best.fitness < 0.03);
            }
        }
        assert!(found * 10 >= runs * 9, "{}: {found} of {runs}", preset.name);
    }
}

/// Settings that keep searches short when tests vary one setting; settings that a preset lacks are skipped.
const SMALL: &[(&str, &str)] = &[
    ("population", "12"),
    ("generations", "3"),
    ("crossover_trials", "3"),
    ("mutation_trials", "3"),
    ("points", "40"),
];

/// Prerequisites of settings, as (setting, other key, value): the setting has an effect only with this value
/// of the other key.
const BESIDE: &[(&str, &str, &str)] = &[
    ("real_step", "encoding", "real"),
    ("reuse_clones", "mutation_probability", "0"),
    ("descent_apart", "scan_step", "0.02"),
    ("growth", "evaluations", "9000"),
    ("best", "population", "80"),
    ("speculation", "acceptance", "first"),
];

/// Returns allowed values of a setting other than its present value `now`.
fn others(setting: &setting::Setting, now: &str) -> Vec<String> {
    let some = match setting.values {
        setting::AllowedValues::Words(words) => words.iter().map(ToString::to_string).collect(),
        setting::AllowedValues::Whole(least, most) => {
            let now: u64 = now.parse().unwrap_or(least);
            vec![
                now.saturating_add(2).min(most).to_string(),
                least.max(1).to_string(),
            ]
        }
        setting::AllowedValues::Real(least, most) => match now.parse::<f64>() {
            Ok(now) => vec![(0.5 * now + 0.5 * least.max(1e-3 * now)).to_string()],
            // none so far: one that every search reaches
            Err(_) => vec![most.min(1e9).to_string()],
        },
        setting::AllowedValues::Switch => vec!["true".to_owned(), "false".to_owned()],
    };
    some.into_iter().filter(|value| value != now).collect()
}

/// Checks that every allowed value of every setting can be set, is printed as it was given, and changes the
/// search.
#[test]
fn every_setting_of_every_preset_can_be_set_and_changes_something() {
    let space = test_function::RASTRIGIN.space();
    for preset in CATALOGUE {
        let named = preset.settable();
        let keys: Vec<&str> = named.iter().map(|one| one.key.as_str()).collect();
        let mut small = settings(preset, &space);
        for (key, value) in SMALL.iter().filter(|(key, _)| keys.contains(key)) {
            preset.set(&mut small, key, value).unwrap();
        }
        for one in &named {
            let mut base = small.clone();
            for (_, key, value) in BESIDE.iter().filter(|(key, ..)| *key == one.key) {
                preset.set(&mut base, key, value).unwrap();
            }
            let run = |settings: &Settings| {
                let mut strategy = build(settings, &space, 3).unwrap();
                run_on(strategy.as_mut(), &test_function::RASTRIGIN, None)
            };
            let before = run(&base);
            let now = one.value(&base).unwrap();
            let mut changes = Vec::new();
            for value in others(&one.setting, &now) {
                let mut changed = base.clone();
                let shown = preset.set(&mut changed, &one.key, &value).unwrap();
                assert_eq!(one.value(&changed), Some(shown.clone()));
                let name = format!("{} {}={shown}", preset.name, one.key);
                assert_ne!(changed, base, "{name}");
                let same = run(&changed) == before;
                changes.push(!same);
                let word = matches!(one.setting.values, setting::AllowedValues::Words(_));
                assert!(!(word && same), "{name} changes nothing");
                preset.set(&mut changed, &one.key, &now).unwrap();
                assert_eq!(changed, base, "{name} and back");
            }
            assert!(changes.contains(&true), "{} {}", preset.name, one.key);
        }
    }
}

#[test]
fn unknown_settings_and_values_are_refused_with_what_there_is() {
    let space = test_function::RASTRIGIN.space();
    let paper = preset("paper").unwrap();
    let mut settings = settings(paper, &space);
    let mut said = |key: &str, value: &str| {
        let error = paper.set(&mut settings, key, value).unwrap_err();
        error.to_string()
    };
    assert_eq!(said("encodign", "gray"), "there is no setting `encodign`");
    assert_eq!(
        said("encoding", "grey"),
        "encoding is grey, but must be binary, gray, real"
    );
    assert_eq!(
        said("bits_per_gene", "1"),
        "bits_per_gene is 1, but must be 2 to 30"
    );
    assert_eq!(
        said("threshold", "-1"),
        "threshold is -1, but must be 0 or more, or none"
    );
    for text in ["NaN", "inf", ""] {
        said("threshold", text);
    }
    // nothing of this space is scanned
    let plain = Unknown::new("k", "1", Scale::Logarithmic, 1.0, [0.1, 10.0]);
    let space = Space::new(&[plain]).unwrap();
    let quick = preset("quick").unwrap();
    let mut settings = (quick.settings)(&SearchPlan {
        space: &space,
        workers: 1,
    });
    let error = quick.set(&mut settings, "scan_step", "0.1").unwrap_err();
    let words = error.to_string();
    assert!(words.starts_with("`scan_step` has no effect"), "{words}");
}
