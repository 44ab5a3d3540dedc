//! Tests of the predictive scores against dense Gaussian densities, and on records without an effect.
use super::*;
use crate::inputs::tests::case;
use crate::linear::whitened::WhitenedRecord;
use crate::validation::scoring_metric::ScoringMetric;
use record::{Record, Stated, recorded};
use search::least_squares::Prior;

fn variable(deviation: f64, bounds: [f64; 2]) -> Variable {
    Variable {
        start: 0.0,
        lower: bounds[0],
        upper: bounds[1],
        step: 0.1,
        longest: f64::INFINITY,
        prior: Some(Prior {
            mean: 0.0,
            deviation,
        }),
    }
}

fn posterior(at: &Linearized, variables: &[Variable], dispersion: f64) -> Posterior {
    let root = dispersion.sqrt();
    let at = Linearized {
        x: at.x.clone(),
        residual: &at.residual / root,
        jacobian: &at.jacobian / root,
    };
    let without = DMatrix::zeros(at.residual.len(), 0);
    Posterior::new(at, variables, dispersion, &without)
}

fn table(rows: usize, columns: usize, of: u64) -> DMatrix<f64> {
    let streams = search::random::Streams::new(of, 0);
    let mut stream = streams.at(0, search::random::Phase::Initial, 0);
    DMatrix::from_fn(rows, columns, |_, _| stream.normal())
}

/// Checks that the predictive score equals the log density of the dense Gaussian, less its constant.
#[test]
fn the_score_is_that_of_the_dense_gaussian() {
    let (fitted, predicted) = (table(12, 3, 1), table(7, 3, 2));
    let z = DVector::from_iterator(7, table(7, 1, 3).iter().copied());
    let deviations = [0.7, 2.0, 1.3];
    let variables = deviations.map(|own| variable(own, [-9.0, 9.0]));
    let at = Linearized {
        x: vec![0.1, -0.2, 0.3],
        residual: DVector::zeros(12),
        jacobian: fitted.clone(),
    };
    for scale in [1.0, 2.5] {
        let record = Predicted::new(z.clone(), predicted.clone());
        let priors = DVector::from_fn(3, |k, _| 1.0 / (deviations[k] * deviations[k]));
        let precision = fitted.tr_mul(&fitted) / scale + DMatrix::from_diagonal(&priors);
        let covariance = DMatrix::identity(7, 7) * scale
            + &predicted * precision.try_inverse().unwrap() * predicted.transpose();
        let solved = covariance.clone().lu().solve(&z).unwrap();
        let dense = -0.5 * (z.dot(&solved) + libm::log(covariance.determinant()));
        // both models have the constant -n/2 ln s^2 in common
        let constant = -0.5 * 7.0 * libm::log(scale);
        let own = posterior(&at, &variables, scale).predicted(&record) + constant;
        assert!((own - dense).abs() < 1e-10, "{own} {dense}");
    }
}

/// Checks that an unknown on its bound counts as known in the predictive score and is not integrated out.
#[test]
fn what_stands_on_a_bound_is_known() {
    let at = Linearized {
        x: vec![9.0],
        residual: DVector::zeros(4),
        jacobian: table(4, 1, 5),
    };
    let record = Predicted::new(DVector::from_element(3, 1.0), table(3, 1, 6));
    let own = posterior(&at, &[variable(1.0, [-9.0, 9.0])], 1.0).predicted(&record);
    assert!((own + 1.5).abs() < 1e-12, "{own}");
}

/// Checks that, without an effect, the best of twenty candidates fitted to noise rarely reaches the score
/// that an effect needs.
#[test]
fn noise_is_predicted_no_better_by_what_was_fitted_to_it() {
    let streams = search::random::Streams::new(9, 0);
    let (mut claims, sets) = (0, 400);
    for draw in 0..sets {
        let mut stream = streams.at(0, search::random::Phase::Initial, draw);
        let mut noise = |n: usize| DVector::from_fn(n, |_, _| stream.normal());
        let (y, held) = (noise(40), noise(40));
        // the best of twenty candidates on the fitted record
        let best = (0..20)
            .map(|k| table(80, 1, 100 + k))
            .map(|g| {
                let own = g.rows(0, 40).column(0).into_owned();
                let size = own.dot(&y) / (own.norm_squared() + 0.25);
                (own.dot(&y) * size, g, size)
            })
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .unwrap();
        let (_, g, size) = best;
        let at = Linearized {
            x: vec![size],
            residual: DVector::zeros(40),
            jacobian: -g.rows(0, 40).into_owned(),
        };
        let record = Predicted::new(
            &held - g.rows(40, 40).column(0) * size,
            -g.rows(40, 40).into_owned(),
        );
        let with = posterior(&at, &[variable(2.0, [-9.0, 9.0])], 1.0).predicted(&record);
        let needed = Thresholds::default().prediction;
        claims += u32::from(with + 0.5 * held.norm_squared() >= needed);
    }
    assert!(claims <= 20, "{claims} of {sets}");
}

/// Needs 3 nats of score, or 6 of evidence.
const NEEDED: Needed = Needed {
    score: 3.0,
    chosen: 0.0,
    evidence: 6.0,
};

fn said(cycles: f64, condition: f64, together: Option<f64>) -> Option<String> {
    let one = |(part, nats): (DataRole, f64)| Prediction {
        condition: usize::from(part == DataRole::Condition),
        part,
        nats,
    };
    let records = [(DataRole::Cycles, cycles), (DataRole::Condition, condition)].map(one);
    let scores = Scores {
        records: records.into(),
        together,
        ..Scores::default()
    };
    rejection_reason("slip", &scores, NEEDED, &case())
}

#[test]
fn a_name_must_predict_all_together_and_nothing_clearly_worse() {
    // held-out cycles repeat the fitted ones: they neither carry a name nor speak against one
    assert_eq!(said(5.0, -2.9, Some(3.0)), None);
    assert_eq!(said(-90.0, 3.0, Some(3.0)), None);
    let better = said(2.9, 0.0, Some(2.9)).unwrap();
    assert!(
        better.contains("no better") && better.contains("2.9 nats"),
        "{better}"
    );
    let worse = said(90.0, -3.1, Some(80.0)).unwrap();
    assert!(worse.contains("condition 4rpm worse"), "{worse}");
    assert!(
        said(1.0, 1.0, Some(f64::NAN)).is_some(),
        "no number is no evidence"
    );
    let alone = |evidence: f64| {
        let scores = Scores {
            evidence,
            ..Scores::default()
        };
        rejection_reason("slip", &scores, NEEDED, &case())
    };
    assert_eq!(alone(6.0), None);
    let nothing = alone(5.9).unwrap();
    assert!(nothing.contains("nothing else is held out"), "{nothing}");
    let gone = Scores {
        failed: vec![(DataRole::Condition, 1)],
        ..Scores::default()
    };
    assert!(
        rejection_reason("slip", &gone, NEEDED, &case())
            .unwrap()
            .contains("does not run")
    );
}

/// Checks that, without an effect, the mean of `exp dS` on held-out cycles is about 1 for the best of many
/// candidates on the fitted cycles: the directions that shorten a record's residual must not be estimated
/// from that record.
#[test]
fn held_out_cycles_know_nothing_of_the_fit() {
    const SAMPLES: usize = 120;
    const CANDIDATES: usize = 40;
    let streams = search::random::Streams::new(31, 0);
    let mut channel = recorded(0);
    channel.channel.abscissa.points = (0..SAMPLES).map(|i| 3.0 * i as f64).collect();
    let (mut sum, mut claims, sets) = (0.0, 0, 800);
    for draw in 0..sets {
        let mut stream = streams.at(0, search::random::Phase::Initial, draw);
        let mut curve = || vec![(0..SAMPLES).map(|_| stream.normal()).collect::<Vec<f64>>()];
        let record = Record {
            condition: 0,
            channels: vec![channel.clone()],
            cycles: (0..8).map(|_| curve()).collect(),
            held_out: false,
            stated: Stated::default(),
        };
        let split = record.split();
        let numerics = protocol::job::Numerics::default();
        let on = WhitenedRecord::under_own_noise(split.fitted.clone(), 60, numerics);
        let fitted = &split.fitted.cycles;
        let scale = ScoringMetric::of(&split.cycles, fitted, &on.metric, fitted.len());
        let best = (0..CANDIDATES)
            .map(|_| {
                let g = on.metric.whiten(&curve());
                let size = g.dot(&on.measured) / (g.norm_squared() + 0.25);
                (g.dot(&on.measured) * size, g, size)
            })
            .max_by(|a, b| a.0.total_cmp(&b.0));
        let (_, g, size) = best.unwrap();
        let column = |g: &DVector<f64>| DMatrix::from_columns(&[-g]);
        let left = DMatrix::from_columns(&[&on.measured - &g * size]);
        let at = Linearized {
            x: vec![size],
            residual: divide_by_student_deviation(&on.metric, left)
                .column(0)
                .into_owned(),
            jacobian: divide_by_student_deviation(&on.metric, column(&g)),
        };
        let variables = [variable(2.0, [-9.0, 9.0])];
        let nothing = scale.residual(&vec![vec![0.0; SAMPLES]]);
        let jacobian = scale.weigh(column(&g));
        let held = Predicted::new(&nothing + jacobian.column(0) * size, jacobian);
        let with = posterior(&at, &variables, 1.0).predicted(&held);
        let score = with + 0.5 * nothing.norm_squared();
        sum += libm::exp(score);
        claims += usize::from(score >= Thresholds::default().prediction);
    }
    let mean = sum / sets as f64;
    // variances from six cycles leave a little; with directions from all eight cycles it is 1.5
    assert!(mean < 1.3, "{mean}");
    assert!(claims <= 6, "{claims}");
}

mod toy;

/// Checks that the score of a model with a discrepancy equals the log density of the dense Gaussian conditioned
/// on the fitted record: for cycles that share the discrepancy, and for a record with one of its own.
#[test]
fn a_discrepancy_is_shared_by_cycles_and_drawn_anew_elsewhere() {
    let (jacobian, elsewhere) = (table(9, 2, 21), table(9, 2, 22));
    let waves = table(9, 3, 23) * 1.7;
    let [y, held] = [24, 25].map(|of| table(9, 1, of).column(0) * 3.0);
    let deviation = 1.4;
    let variables = [0, 1].map(|_| variable(deviation, [-99.0, 99.0]));
    // a point that is no minimum
    let x = DVector::from_vec(vec![0.4, -0.9]);
    let at = Linearized {
        x: x.iter().copied().collect(),
        residual: &y + &jacobian * &x,
        jacobian: jacobian.clone(),
    };
    let own = Posterior::new(at, &variables, 1.0, &-&waves);
    let prior = DMatrix::identity(2, 2) * (deviation * deviation);
    let noise = DMatrix::<f64>::identity(9, 9);
    for shares in [true, false] {
        let zeros = DMatrix::zeros(9, 3);
        let record = Predicted {
            residual: &held + &elsewhere * &x,
            jacobian: beside(&elsewhere, &if shares { -&waves } else { zeros }),
            own: if shares {
                DMatrix::zeros(9, 0)
            } else {
                waves.clone()
            },
        };
        let delta = &waves * waves.transpose();
        let here = &noise + &delta + &jacobian * &prior * jacobian.transpose();
        let there = &noise + &delta + &elsewhere * &prior * elsewhere.transpose();
        let mut between = &elsewhere * &prior * jacobian.transpose();
        if shares {
            between += &delta;
        }
        let factor = here.cholesky().unwrap();
        let mean = &between * factor.solve(&y);
        let covariance = there - &between * factor.solve(&between.transpose());
        let left = &held - mean;
        let factor = covariance.cholesky().unwrap();
        let dense = -0.5 * (left.dot(&factor.solve(&left)) + log_determinant(&factor));
        let found = own.predicted(&record);
        assert!((found - dense).abs() < 1e-9, "{shares}: {found} {dense}");
    }
}
