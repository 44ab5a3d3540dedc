//! Tests specific to the memetic algorithm: number of evaluations, options, exact speculation.
use super::*;
use crate::{
    strategy::{
        Finish, Purpose, Settings, build,
        tests::{Record, run},
    },
    test_function::{self, SPHERE, TestFunction},
};

type Change = fn(&mut MemeticSettings);

/// Runs a small search of the paper's algorithm with settings modified by `change`.
fn search(
    change: impl Fn(&mut MemeticSettings),
    function: &TestFunction,
    seed: u64,
) -> (Record, MemeticSettings) {
    let mut settings = MemeticSettings {
        population: 20,
        generations: 12,
        ..MemeticSettings::paper()
    };
    change(&mut settings);
    let space = function.space();
    let mut strategy = build(&Settings::of(&settings), &space, seed).unwrap();
    (
        run(
            strategy.as_mut(),
            &|genes| function.tell(&space, genes),
            None,
        ),
        settings,
    )
}

/// Returns generation and genes of all children of a run. They depend on the whole population including the
/// elite, so equal children in every generation imply the same path of the elite.
fn children(record: &Record) -> Vec<(u32, Vec<f64>)> {
    let bred = record
        .asked
        .iter()
        .filter(|p| p.purpose == Purpose::Offspring);
    bred.map(|proposal| (proposal.generation, proposal.genes.clone()))
        .collect()
}

#[test]
fn exact_speculation_takes_the_same_path_as_the_sequential_climb() {
    for function in test_function::ALL {
        for seed in 0..6 {
            let run = |speculation| {
                let change = |s: &mut MemeticSettings| {
                    s.speculation = speculation;
                    s.reuse_clones = false;
                };
                search(change, function, seed).0
            };
            let (sequential, half, full) = (run(Some(1)), run(Some(7)), run(None));
            assert_eq!(sequential.asked.len(), 20 + 12 * 40, "{}", function.name);
            assert!(
                full.asked.len() > sequential.asked.len(),
                "{}",
                function.name
            );
            for other in [&half, &full] {
                assert_eq!(children(&sequential), children(other), "{}", function.name);
                assert_eq!(sequential.best.genes, other.best.genes);
                assert_eq!(
                    sequential.best.fitness.to_bits(),
                    other.best.fitness.to_bits()
                );
            }
        }
    }
}

#[test]
fn reuse_of_clones_saves_evaluations_and_changes_nothing_else() {
    let clones = |s: &mut MemeticSettings| s.mutation_probability = 0.002;
    let without = search(
        |s| {
            clones(s);
            s.reuse_clones = false;
        },
        &SPHERE,
        9,
    );
    let with = search(clones, &SPHERE, 9);
    assert!(with.0.asked.len() + 20 < without.0.asked.len());
    assert_eq!(with.0.best.genes, without.0.best.genes);
    assert_eq!(
        with.0.best.fitness.to_bits(),
        without.0.best.fitness.to_bits()
    );
}

#[test]
fn the_paper_costs_what_its_text_implies() {
    let count = |change: fn(&mut MemeticSettings)| {
        let space = SPHERE.space();
        let mut settings = MemeticSettings {
            reuse_clones: false,
            ..MemeticSettings::paper()
        };
        change(&mut settings);
        let mut strategy = build(&Settings::of(&settings), &space, 1).unwrap();
        let (mut batches, mut evaluations) = (0, 0);
        while strategy.finished().is_none() {
            let batch = strategy.ask();
            batches += 1;
            evaluations += batch.len();
            for proposal in batch {
                strategy.tell(proposal.id, SPHERE.tell(&space, &proposal.genes));
            }
        }
        (evaluations, batches)
    };
    assert_eq!(count(|s| s.speculation = Some(1)), (6_080, 1_261));
    assert_eq!(
        count(|s| *s = MemeticSettings {
            reuse_clones: false,
            ..MemeticSettings::paper_batch()
        }),
        (9_680, 121)
    );
    assert_eq!(count(|s| s.climbers = Climbers::All), (14_480, 181));
    let (evaluations, batches) = count(|_| {});
    assert!((6_081..8_000).contains(&evaluations), "{evaluations}");
    assert!((121..350).contains(&batches), "{batches}");
}

/// Names and changes of settings for every interpretation of the paper that differs from the default.
const READINGS: &[(&str, Change)] = &[
    ("gray", |s| s.encoding = Encoding::Gray),
    ("real", |s| s.encoding = Encoding::Real),
    ("inverse plus one", |s| {
        s.roulette = Roulette::InversePlusOne;
    }),
    ("difference", |s| s.roulette = Roulette::Difference),
    ("rank", |s| s.roulette = Roulette::Rank),
    ("one point", |s| s.crossover = Crossover::OnePoint),
    ("per gene", |s| s.mutation_unit = MutationUnit::Gene),
    ("per individual", |s| {
        s.mutation_unit = MutationUnit::Individual;
    }),
    ("even", |s| s.special_crossover = SpecialCrossover::Even),
    ("two bits", |s| s.flipped_bits = Some(2)),
    ("all climb", |s| s.climbers = Climbers::All),
    ("literal", |s| s.climbers = Climbers::Literal),
    ("best of batch", |s| s.acceptance = Acceptance::BestOfBatch),
    ("plus", |s| s.survival = Survival::Plus),
];

/// Checks that the hash of a short run is unchanged for each interpretation in [`READINGS`].
#[test]
fn the_bits_of_every_reading_stay() {
    let frozen: &[u64] = &[
        0xa4e5_592d_55a4_5533,
        0x0696_3896_3ffc_e4cd,
        0x073a_fea2_7f08_e851,
        0xea4d_e7e0_fbd1_262d,
        0x5299_d42d_d8c2_b545,
        0xf318_995a_7513_908a,
        0x8e46_3967_e7d1_367a,
        0x2d02_7474_d24c_c7a1,
        0xac35_4b04_84db_5860,
        0xab6f_9cc4_9ba3_8087,
        0x2fb9_285b_6d37_de64,
        0x3661_d193_8547_2b36,
        0x933c_cb43_3733_6cf1,
        0x5716_dde6_6df0_30ad,
    ];
    for ((name, change), bits) in READINGS.iter().zip(frozen) {
        let short = |s: &mut MemeticSettings| {
            s.generations = 6;
            change(s);
        };
        let (record, _) = search(short, &test_function::RESONANCE, 7);
        assert_eq!(record.bits(), *bits, "{name}: {:#x}", record.bits());
    }
}

#[test]
fn every_reading_of_the_paper_finds_the_sphere() {
    for (name, change) in READINGS {
        let long = |s: &mut MemeticSettings| {
            s.generations = 40;
            change(s);
        };
        let (record, settings) = search(long, &SPHERE, 17);
        let first = record.told[..settings.population].iter();
        let first = first.map(|told| told.fitness).fold(f64::MAX, f64::min);
        let last = record.best.fitness;
        assert!(
            last < 0.5 * first && last < 0.6,
            "{name}: {first} became {last}"
        );
        let text = serde_json::to_string(&Settings::of(&settings)).unwrap();
        let back: Settings = serde_json::from_str(&text).unwrap();
        assert_eq!(back, Settings::of(&settings), "{name}");
        assert_eq!(back.read::<MemeticSettings>().unwrap(), settings, "{name}");
    }
}

#[test]
fn a_linear_scale_starts_in_the_highest_decade() {
    let (record, settings) = search(|s| s.scale = CodeScale::Linear, &SPHERE, 1);
    let space = SPHERE.space();
    let first = &record.asked[..settings.population];
    let points = first
        .iter()
        .flat_map(|proposal| space.point(&proposal.genes));
    let high = points.filter(|x| *x > 3.0).count();
    assert!(
        high * 10 > settings.population * space.dimension() * 8,
        "{high}"
    );
}

#[test]
fn the_threshold_ends_the_search() {
    let (record, _) = search(|s| s.threshold = Some(0.5), &SPHERE, 1);
    assert_eq!(record.finish, Finish::Threshold);
    assert!(record.best.fitness <= 0.5);
    let before = search(|_| {}, &SPHERE, 1).0.asked.len();
    assert!(record.asked.len() < before);
}
