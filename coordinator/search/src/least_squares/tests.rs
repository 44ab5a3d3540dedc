//! Tests of the least-squares search on functions with a known minimum, including failed points and active
//! bounds.
use super::step::linear_minimum;
use super::*;
use nalgebra::{DMatrix, DVector};

fn variable(start: f64, lower: f64, upper: f64) -> Variable {
    Variable {
        start,
        lower,
        upper,
        step: 1e-4,
        longest: f64::INFINITY,
        prior: None,
    }
}

fn tight() -> LeastSquaresSettings {
    LeastSquaresSettings {
        iterations: 60,
        gradient: 1e-9,
        decrease: 1e-14,
        change: 1e-4,
        ..LeastSquaresSettings::default()
    }
}

fn run(search: &mut LeastSquares, residual: impl Fn(&[f64]) -> Option<Vec<f64>>) -> Termination {
    loop {
        if let Some(ended) = search.ended() {
            return ended;
        }
        let results = search
            .plan()
            .iter()
            .map(|x| residual(x).map(DVector::from_vec))
            .collect();
        search.absorb(results);
    }
}

fn rosenbrock(x: &[f64]) -> Vec<f64> {
    vec![10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0]]
}

#[test]
fn the_curved_valley_is_followed_to_its_end() {
    let mut search = LeastSquares::new(
        vec![variable(-1.2, -5.0, 5.0), variable(1.0, -5.0, 5.0)],
        tight(),
    );
    run(&mut search, |x| Some(rosenbrock(x)));
    for x in &search.best().x {
        assert!((x - 1.0).abs() < 1e-6, "{:?}", search.best().x);
    }
    assert!(search.work().0 < 400, "{:?}", search.work());
}

#[test]
fn an_exponential_is_fitted_as_by_the_normal_equations_of_its_logarithm() {
    let model = |x: &[f64]| -> Vec<f64> {
        (0..20)
            .map(|i| {
                let t = 0.1 * f64::from(i);
                x[0] * (-x[1] * t).exp() - 3.0 * (-1.7 * t).exp()
            })
            .collect()
    };
    for central in [false, true] {
        let settings = LeastSquaresSettings { central, ..tight() };
        let mut search = LeastSquares::new(
            vec![variable(1.0, 0.1, 10.0), variable(0.3, 0.0, 9.0)],
            settings,
        );
        assert_eq!(run(&mut search, |x| Some(model(x))), Termination::Converged);
        let x = &search.best().x;
        assert!(
            (x[0] - 3.0).abs() < 1e-6 && (x[1] - 1.7).abs() < 1e-6,
            "{x:?}"
        );
        assert!(search.gradient_ratio() < 1e-2);
    }
}

#[test]
fn the_settled_residual_is_that_of_the_linear_minimum() {
    let model = |x: &[f64]| vec![x[0] + x[1] - 3.0, x[0] - x[1], 2.0 * x[1] + 1.0];
    let settings = LeastSquaresSettings {
        iterations: 1,
        ..tight()
    };
    let variables = vec![variable(5.0, -9.0, 9.0), variable(5.0, -9.0, 9.0)];
    let mut search = LeastSquares::new(variables, settings);
    assert_eq!(
        run(&mut search, |x| Some(model(x))),
        Termination::Iterations
    );
    // normal equations: 2 x + 0 y = 3, 6 y = 1
    let expected = DVector::from_vec(model(&[1.5, 1.0 / 6.0]));
    assert!((search.linear_minimum_residual() - &expected).norm() < 1e-6);
    let promised = 1.0 - expected.norm_squared() / search.cost();
    assert!((search.predicted_decrease() - promised).abs() < 1e-6);
}

/// Checks that a variable that a step leaves on a bound is freed where the cost decreases towards the inside: the
/// unbounded minimum is at -2 and -0.5, and with the first at zero the second has its minimum at 1.3.
#[test]
fn the_linear_minimum_frees_what_a_step_left_on_a_bound() {
    let jacobian = DMatrix::from_row_slice(2, 2, &[1.0, -0.9, 0.0, 0.19_f64.sqrt()]);
    let residual = |x: &[f64]| &jacobian * DVector::from_vec(vec![x[0] + 2.0, x[1] + 0.5]);
    let at = Linearized {
        x: vec![0.2, 0.2],
        residual: residual(&[0.2, 0.2]),
        jacobian: jacobian.clone(),
    };
    let bounded = variable(0.2, 0.0, 9.0);
    let found = linear_minimum(&at, &[bounded.clone(), bounded]);
    assert!(
        found.x[0].abs() <= 0.0 && (found.x[1] - 1.3).abs() < 1e-9,
        "{found:?}"
    );
    assert!((&found.residual - residual(&found.x)).norm() < 1e-9);
}

#[test]
fn a_bound_holds_and_the_others_still_converge() {
    let mut search = LeastSquares::new(
        vec![variable(0.0, -5.0, 0.5), variable(3.0, -5.0, 5.0)],
        tight(),
    );
    run(&mut search, |x| {
        Some(vec![x[0] - 2.0, x[1] - x[0], 0.3 * (x[1] - 1.0)])
    });
    let x = &search.best().x;
    assert!((x[0] - 0.5).abs() < 1e-12, "{x:?}");
    let expected = (0.5 + 0.09) / 1.09;
    assert!((x[1] - expected).abs() < 1e-6, "{x:?} {expected}");
}

#[test]
fn points_that_fail_are_missing_values() {
    // everything above 2.5 cannot be evaluated, the start lies just below, the minimum at 1
    let fails = |x: &[f64]| (x[0] <= 2.5).then(|| vec![x[0] * x[0] - 1.0, 0.1 * (x[1] - 4.0)]);
    let mut search = LeastSquares::new(
        vec![variable(2.49995, -5.0, 5.0), variable(0.0, -5.0, 5.0)],
        tight(),
    );
    run(&mut search, fails);
    let x = &search.best().x;
    assert!(
        (x[0] - 1.0).abs() < 1e-6 && (x[1] - 4.0).abs() < 1e-6,
        "{x:?}"
    );
    assert!(search.work().1 > 0);

    let mut search = LeastSquares::new(vec![variable(3.0, -5.0, 5.0)], tight());
    assert_eq!(run(&mut search, |_| None), Termination::StartFailed);
}

#[test]
fn a_prior_pulls_as_its_width_says_and_moves_what_the_data_do_not_see() {
    let prior = |mean, deviation| Some(Prior { mean, deviation });
    let mut variables = vec![variable(0.0, -9.0, 9.0), variable(5.0, -9.0, 9.0)];
    variables[0].prior = prior(0.0, 0.5);
    variables[1].prior = prior(2.0, 1.0);
    let mut search = LeastSquares::new(variables, tight());
    run(&mut search, |x| Some(vec![x[0] - 1.0]));
    let x = &search.best().x;
    // (x - 1) + 4 x = 0
    assert!(
        (x[0] - 0.2).abs() < 1e-6 && (x[1] - 2.0).abs() < 1e-6,
        "{x:?}"
    );
}

#[test]
fn a_known_start_is_not_evaluated_again_and_the_last_jacobian_is_fresh() {
    let start = [0.4, 0.1];
    let known = DVector::from_vec(rosenbrock(&start));
    let variables = vec![variable(9.0, -5.0, 5.0), variable(9.0, -5.0, 5.0)];
    let mut search = LeastSquares::from_known(variables, tight(), (&start, known));
    assert_eq!(search.plan().len(), 2);
    run(&mut search, |x| Some(rosenbrock(x)));
    let best = search.best();
    let expected = DMatrix::from_row_slice(2, 2, &[-20.0 * best.x[0], 10.0, -1.0, 0.0]);
    assert!(
        (&best.jacobian - expected).norm() < 1e-2,
        "{}",
        best.jacobian
    );
}

/// Runs a search on the Rosenbrock function; the evaluator returns exact Jacobian columns for those variables
/// for which `knows` is true.
fn run_knowing(search: &mut LeastSquares, knows: impl Fn(usize) -> bool) -> Termination {
    loop {
        if let Some(ended) = search.ended() {
            return ended;
        }
        let wants = search.wants_columns();
        let evaluate = |x: &Vec<f64>| {
            let columns = [[-20.0 * x[0], -1.0], [10.0, 0.0]];
            let columns = columns.iter().enumerate();
            let columns = columns.map(|(k, c)| knows(k).then(|| DVector::from_row_slice(c)));
            Some(EvaluatedPoint {
                residual: DVector::from_vec(rosenbrock(x)),
                columns: if wants { columns.collect() } else { Vec::new() },
            })
        };
        let found = search.plan().iter().map(evaluate).collect();
        search.absorb(found);
    }
}

#[test]
fn known_columns_take_the_place_of_differences() {
    let search = |exact| {
        let variables = vec![variable(-1.2, -5.0, 5.0), variable(1.0, -5.0, 5.0)];
        LeastSquares::new(variables, LeastSquaresSettings { exact, ..tight() })
    };
    let (mut differenced, mut exact) = (search(false), search(true));
    run_knowing(&mut differenced, |_| true);
    run_knowing(&mut exact, |_| true);
    for x in &exact.best().x {
        assert!((x - 1.0).abs() < 1e-9, "{:?}", exact.best().x);
    }
    let at = exact.best();
    assert_eq!(at.jacobian[(0, 0)].to_bits(), (-20.0 * at.x[0]).to_bits());
    // a point in place of two for every Jacobian
    assert!(exact.work().0 < differenced.work().0);
    // one of them, as if the other did not exist
    let mut half = search(true);
    run_knowing(&mut half, |k| k == 1);
    assert!((half.best().x[0] - 1.0).abs() < 1e-6, "{:?}", half.best().x);
    assert!(exact.work().0 < half.work().0);
    // nobody knows any: the search is that of differences, bit for bit, and does not ask again
    let mut none = search(true);
    run_knowing(&mut none, |_| false);
    assert_eq!(none.best(), differenced.best());
    assert_eq!(none.work(), differenced.work());
}

/// Residual with its exact Jacobian columns.
fn exact(x: &[f64]) -> EvaluatedPoint {
    let columns = [vec![-20.0 * x[0], -1.0], vec![10.0, 0.0]];
    EvaluatedPoint {
        residual: DVector::from_vec(rosenbrock(x)),
        columns: columns.map(|own| Some(DVector::from_vec(own))).into(),
    }
}

/// Checks that the search anticipates its next points: with certainty once all results are there, and before
/// that as one of few candidates, the best known point first.
#[test]
fn the_next_points_are_anticipated() {
    let settings = LeastSquaresSettings {
        exact: true,
        ..tight()
    };
    let variables = vec![variable(-1.2, -5.0, 5.0), variable(1.0, -5.0, 5.0)];
    let mut search = LeastSquares::new(variables, settings);
    let mut fans = 0;
    while search.ended().is_none() {
        let points = search.plan();
        let found: Vec<Option<EvaluatedPoint>> = points.iter().map(|x| Some(exact(x))).collect();
        let none = search.anticipate(vec![None; points.len()]);
        let mut all_but_last: Vec<_> = found.iter().cloned().map(Some).collect();
        *all_but_last.last_mut().unwrap() = None;
        let some = search.anticipate(all_but_last);
        let all = search.anticipate(found.iter().cloned().map(Some).collect());
        let wanted_columns = search.wants_columns();
        search.absorb(found);
        let Anticipated::Certain(next) = all else {
            panic!("{all:?}");
        };
        assert_eq!(next.plan(), search.plan());
        let (Anticipated::Candidates(none), Anticipated::Candidates(some)) = (none, some) else {
            panic!("some results are awaited");
        };
        if wanted_columns {
            assert!(none.is_empty() && some.is_empty());
        } else if search.wants_columns() {
            fans += 1;
            assert_eq!(none.len(), points.len());
            assert_eq!(none[0], points[points.len() - 1], "the most damped step");
            assert!(some.len() <= 2, "the best known and the awaited one");
            let next = &search.plan()[0];
            assert!(none.contains(next) && some.contains(next), "{some:?}");
        }
    }
    assert!(fans > 5, "{fans}");
}
