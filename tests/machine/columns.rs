//! Tests of derivatives of complete simulations with respect to the coefficients and effect parameters that a
//! job names.
#![expect(
    clippy::wildcard_enum_match_arm,
    reason = "whatever else comes back is a failed test"
)]
use super::unit;
use protocol::{
    case::{Case, EffectSetting},
    job::{
        Answer, Column, Derivative, Failure, Individual, Job, MAX_COLUMNS, Observation, Outcome,
        Per, Reply, SimulateSpec, Verdict,
    },
    pumping_unit::Discretisation,
};
use worker::handler::Prepared;

/// Returns the shipped case with long (coarse) rope cylinders.
fn coarse() -> Case {
    let long = Discretisation {
        cylinder_length_m: Some(0.15),
        ..Discretisation::default()
    };
    let unit = worker::pumping_unit::refined(&unit(), &long).unwrap();
    unit.into_case().unwrap()
}

fn prepared(case: &Case) -> Prepared {
    Prepared::new(worker::SIMULATORS, case).unwrap()
}

fn asked(case: &Case, genes: Vec<f64>, columns: Vec<Column>) -> Result<Observation, Failure> {
    let spec = SimulateSpec {
        columns,
        ..SimulateSpec::new(Individual::new(0, genes), Reply::Channels)
    };
    match prepared(case).evaluate(&Job::Simulate(spec)) {
        Outcome::Done(Answer::Channels(seen)) => Ok(seen),
        Outcome::Failed(failure) => Err(failure),
        other @ Outcome::Done(_) => unreachable!("{other:?}"),
    }
}

/// Returns what a derivative is taken with respect to (with unit) and its curve for each channel, in double
/// precision.
fn curves(derivative: &Derivative) -> (&Per, Vec<Vec<f64>>) {
    match derivative {
        Derivative::Curves { per, curves } => {
            let doubles = |curve: &Vec<f32>| curve.iter().map(|x| f64::from(*x)).collect();
            (per, curves.iter().map(doubles).collect())
        }
        other => unreachable!("{other:?}"),
    }
}

fn apart(x: &[f64], y: &[f64]) -> f64 {
    let norm = |x: &mut dyn Iterator<Item = f64>| x.map(|x| x * x).sum::<f64>().sqrt();
    let apart = norm(&mut x.iter().zip(y).map(|(x, y)| x - y));
    apart / norm(&mut y.iter().copied()).max(1e-300)
}

/// Checks that derivatives by a coefficient, an effect's parameter and an absent effect agree with central
/// differences of two whole simulations, channel by channel and in the channel's unit.
#[test]
fn columns_are_what_whole_runs_beside_say() {
    let mut case = coarse();
    case.effects = vec![EffectSetting::new(
        "pivot_friction",
        &[("creep", 0.004), ("moment", 1000.0)],
    )];
    let names = ["kb1", "pivot_friction.moment", "gauge_gain.gain_1"];
    let columns = names.map(Column::new).to_vec();
    let seen = asked(&case, case.start(), columns).unwrap();
    assert_eq!((seen.verdict, seen.columns.len()), (Verdict::Complete, 3));
    let run = |change: &dyn Fn(&mut Case)| {
        let mut moved = case.clone();
        change(&mut moved);
        let seen = asked(&moved, moved.start(), Vec::new()).unwrap();
        assert_eq!(seen.verdict, Verdict::Complete);
        seen.curves
    };
    let difference = |step: f64, change: &dyn Fn(&mut Case, f64)| -> Vec<Vec<f64>> {
        let [up, down] = [step, -step].map(|by| run(&|case| change(case, by)));
        let channels = up.iter().zip(&down);
        let slope = |(up, down): (&Vec<f64>, &Vec<f64>)| {
            let each = up.iter().zip(down);
            each.map(|(up, down)| (up - down) / (2.0 * step)).collect()
        };
        channels.map(slope).collect()
    };
    let kb1 = case
        .unknowns
        .iter()
        .position(|it| it.name == "kb1")
        .unwrap();
    let judges = [
        // resonances move fast
        difference(1e-3, &|case, by| {
            case.unknowns[kb1].start *= (by * std::f64::consts::LN_10).exp();
        }),
        difference(50.0, &|case, by| case.effects[0].parameters[1].1 += by),
        difference(0.01, &|case, by| {
            let gain = EffectSetting::new("gauge_gain", &[("gain_1", by)]);
            case.effects.push(gain);
        }),
    ];
    let units = [
        Per::Decade,
        Per::Unit("N.m".to_owned()),
        Per::Unit("1".to_owned()),
    ];
    let channels: Vec<&str> = case.channels_of(0).map(|(_, it)| &*it.name).collect();
    assert_eq!(channels.len(), 6, "{channels:?}");
    for (((name, derivative), judge), unit) in
        names.iter().zip(&seen.columns).zip(&judges).zip(&units)
    {
        let (per, curves) = curves(derivative);
        assert_eq!(per, unit);
        for ((curve, judge), channel) in curves.iter().zip(judge).zip(&channels) {
            let off = apart(curve, judge);
            println!("{name} {channel}: {off:.1e}");
            // a gauge's gain moves nothing else
            let still = judge.iter().all(|x| *x == 0.0) && curve.iter().all(|x| *x == 0.0);
            // whole runs choose other steps and leave off elsewhere, which costs their difference some
            // percent; on the same steps columns are proved to 1e-4 beside the simulation
            assert!(off < 0.08 || still, "{name} {channel}: {off}");
        }
    }
}

/// Checks that requesting derivatives leaves the simulated curves unchanged bit for bit, and that each
/// derivative is independent of which others are requested.
#[test]
fn columns_change_nothing_else() {
    let case = coarse();
    let ask = |names: &[&str]| {
        let columns = names.iter().map(|name| Column::new(*name)).collect();
        asked(&case, case.start(), columns).unwrap()
    };
    let plain = ask(&[]);
    let (one, many) = (ask(&["kc"]), ask(&["kb1", "load_offset.force", "kc"]));
    assert!(plain.columns.is_empty());
    for seen in [&one, &many] {
        assert_eq!(
            (&seen.verdict, &seen.counters, &seen.curves),
            (&plain.verdict, &plain.counters, &plain.curves)
        );
    }
    assert_eq!(one.columns[0], many.columns[2]);
    // what has no effect in the plane says so
    let nothing = Derivative::Nothing { per: Per::Decade };
    assert_eq!(ask(&["kb4"]).columns, [nothing]);
}

/// Checks that a failed simulation returns no derivatives, and the same verdict as without a request for
/// them.
#[test]
fn a_run_that_fails_has_no_columns() {
    let case = coarse();
    let mut genes = case.start();
    genes[0] *= 1e-6;
    let plain = asked(&case, genes.clone(), Vec::new()).unwrap();
    assert_ne!(plain.verdict, Verdict::Complete);
    let seen = asked(&case, genes, vec![Column::new("kb1"), Column::new("kc")]).unwrap();
    assert_eq!(seen, plain);
}

/// Checks that a request for a derivative by an unknown quantity is refused with its name and the known
/// names.
#[test]
fn columns_that_do_not_exist_are_refused() {
    let mut case = coarse();
    case.effects = vec![EffectSetting::new("load_offset", &[("force", 500.0)])];
    let refused = |columns: Vec<Column>| match asked(&case, case.start(), columns) {
        Err(Failure::Misconfigured { field, problem }) => (field, problem),
        other => unreachable!("{other:?}"),
    };
    for (name, says) in [
        ("kb7", "there is no `kb7`"),
        (
            "pivot_friction.momment",
            "did you mean `pivot_friction.moment`?",
        ),
        (
            "pivot_frction.moment",
            "did you mean `pivot_friction.moment`?",
        ),
        ("quite_another", "known are kb1, "),
        ("", "there is no ``"),
    ] {
        let (field, problem) = refused(vec![Column::new("kb1"), Column::new(name)]);
        assert_eq!(field, "columns[1]");
        assert!(problem.contains(says), "{problem}");
    }
    // the case has the effect: it has its values already
    let mut present = Column::new("load_offset.force");
    present.values = vec![("force".to_owned(), 1.0)];
    assert_eq!(refused(vec![present]).0, "columns[0]");
    // outside its bounds
    let mut outside = Column::new("head_profile_wear.depth");
    outside.values = vec![("centre".to_owned(), 1e9)];
    assert_eq!(refused(vec![outside]).0, "columns[0]");
    let (field, problem) = refused(vec![Column::new("kb1"); MAX_COLUMNS + 1]);
    assert_eq!(field, "columns");
    assert!(
        problem.contains("501") && problem.contains("500"),
        "{problem}"
    );
}
