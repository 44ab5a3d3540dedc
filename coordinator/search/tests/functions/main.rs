//! Strategies on four functions of the BBOB suite's kinds (sphere, ellipsoid, Rosenbrock, Rastrigin; Hansen et
//! al., "Real-parameter black-box optimization benchmarking 2009", INRIA RR-6829), shifted and rotated, in five
//! dimensions over [-5, 5], 1,000 evaluations per dimension.
use nalgebra::{DMatrix, DVector};
use protocol::case::{Scale, Unknown};
use search::{
    random::{Phase, Streams},
    space::Space,
    strategy::{EvaluationResult, SearchPlan, build, preset},
};

const DIMENSION: usize = 5;
const BUDGET: usize = 1000 * DIMENSION;
const SEEDS: u64 = 10;

type Function = fn(&DVector<f64>) -> f64;

fn sphere(z: &DVector<f64>) -> f64 {
    z.norm_squared()
}

/// Computes the value of an ellipsoid function with axis ratios up to a thousand.
fn ellipsoid(z: &DVector<f64>) -> f64 {
    let weight = |k: usize| libm::pow(10.0, 6.0 * k as f64 / (DIMENSION as f64 - 1.0));
    z.iter().enumerate().map(|(k, z)| weight(k) * z * z).sum()
}

fn rosenbrock(z: &DVector<f64>) -> f64 {
    let pair = |k: usize| {
        let (x, y) = (z[k] + 1.0, z[k + 1] + 1.0);
        100.0 * (x * x - y) * (x * x - y) + (x - 1.0) * (x - 1.0)
    };
    (0..DIMENSION - 1).map(pair).sum()
}

/// Computes the Rastrigin function, with about 10^5 basins of attraction.
fn rastrigin(z: &DVector<f64>) -> f64 {
    let ripple = |z: &f64| 10.0 * (1.0 - libm::cos(std::f64::consts::TAU * z)) + z * z;
    z.iter().map(ripple).sum()
}

/// Returns in how many of ten instances a strategy reaches a fitness below `below`; checks that it uses
/// exactly the budget of evaluations.
fn solved(name: &str, function: Function, below: f64) -> u64 {
    let names: Vec<String> = (0..DIMENSION).map(|k| format!("x{k}")).collect();
    let unknown = |name: &String| Unknown::new(name, "1", Scale::Linear, 0.0, [-5.0, 5.0]);
    let space = Space::new(&names.iter().map(unknown).collect::<Vec<_>>()).expect("a box");
    let preset = preset(name).expect("a preset");
    let solves = |seed: u64| {
        let mut settings = (preset.settings)(&SearchPlan {
            space: &space,
            workers: 1,
        });
        let budget = BUDGET.to_string();
        preset
            .set(&mut settings, "evaluations", &budget)
            .expect("a setting");
        let mut stream = Streams::new(seed, 77).at(0, Phase::Initial, 0);
        let minimum = DVector::from_fn(DIMENSION, |_, _| 8.0 * stream.unit() - 4.0);
        let rotation = DMatrix::from_fn(DIMENSION, DIMENSION, |_, _| stream.normal())
            .qr()
            .q();
        let mut strategy = build(&settings, &space, seed).expect("settings");
        let mut asked = 0;
        while strategy.finished().is_none() {
            for proposal in strategy.ask() {
                asked += 1;
                let x = DVector::from_vec(proposal.genes);
                let fitness = function(&(&rotation * (x - &minimum)));
                let complete = true;
                strategy.tell(proposal.id, EvaluationResult { fitness, complete });
            }
        }
        assert_eq!(asked, BUDGET, "{name}");
        strategy.best().expect("a best").fitness < below
    };
    (1..=SEEDS).filter(|seed| solves(*seed)).count() as u64
}

#[test]
fn covariance_adaptation_solves_what_has_one_basin() {
    for function in [sphere, ellipsoid, rosenbrock] {
        assert!(solved("cma-es", function, 1e-8) >= 9);
    }
    assert!(solved("cma-es", rastrigin, 8.0) >= 8);
}

#[test]
fn differential_evolution_finds_the_basin_among_many() {
    assert!(solved("l-shade", sphere, 1e-8) >= 9);
    assert!(solved("l-shade", rosenbrock, 4.0) >= 9);
    assert!(solved("l-shade", rastrigin, 5.0) >= 9);
}
