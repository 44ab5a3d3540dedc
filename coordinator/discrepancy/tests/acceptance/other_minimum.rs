//! Tests of answers whose fit is not the right one: it lies in another minimum, or needs instruments that are
//! impossible.
use crate::by_curves::ByCurves;
use crate::mimic::{SAMPLES, inputs, simulated};
use crate::trial::{line, now};
use discrepancy::diagnose::{Diagnosis, diagnose};
use discrepancy::verdict::Verdict;
use protocol::case::{Scale, Unknown};
use record::{Acts, Nuisance};
use search::space::Space;
use std::f64::consts::TAU;

/// Returns a pulse, `sag`, a wave of the fourth order, `clock`, and waves of other orders that vanish at the
/// unknown's true value of 2. At -2 the largest of them vanishes, too; a pulse looks like `sag` there, with the
/// opposite sign under the second condition.
fn two_minima(x: f64, amounts: &[(&str, f64)], condition: usize) -> Vec<f64> {
    let amount = |id: &str| {
        let own = amounts.iter().find(|(name, _)| *name == id);
        own.map_or(0.0, |(_, amount)| *amount)
    };
    let sign = if condition == 0 { 1.0 } else { -1.0 };
    let pulse = amount("sag") + 0.2 * sign * (x - 2.0);
    let at = |k: usize| {
        let t = TAU * k as f64 / SAMPLES as f64;
        (x * x - 4.0) * t.sin()
            + pulse * (40.0 * (t.cos() - 1.0)).exp()
            + amount("clock") * (4.0 * t).sin()
            + 0.03 * (x - 2.0) * (5.0 * t).sin()
    };
    (0..SAMPLES).map(at).collect()
}

/// Diagnoses records of [`two_minima`] from a start, with an instrument of the given tolerance that acts as
/// `clock` and is no candidate effect.
fn diagnosed(start: f64, hidden: &[(&str, f64)], tolerance: f64) -> Diagnosis {
    let mut inputs = inputs(two_minima, 2.0, &["sag", "clock"], &[hidden, hidden], 5);
    inputs.unknowns = vec![Unknown::new("size", "N", Scale::Linear, -1.0, [-3.0, 3.0])];
    inputs.space = Space::new(&inputs.unknowns).expect("ordered");
    inputs.start = Some(vec![inputs.space.axes()[0].coordinate(start)]);
    inputs.global_search = "quick";
    inputs.thresholds.without = vec!["clock".to_owned()];
    for record in &mut inputs.records {
        record.stated.nuisances = vec![Nuisance {
            id: "clock".to_owned(),
            parameter: "amount".to_owned(),
            unit: "N".to_owned(),
            acts: Acts::Effect,
            deviation: tolerance,
            never_negative: false,
            assumed: false,
        }];
    }
    let mut lab = ByCurves(|spec| Some(simulated(two_minima, spec)));
    now(diagnose(&mut lab, &inputs))
}

fn size(answer: &Diagnosis) -> f64 {
    answer.effects[0].parameters[0].value
}

/// Checks that an answer whose fit lies in another minimum, where it opens the gap of another condition, is
/// fitted again from a global search before it is judged.
#[test]
fn an_answer_in_a_wrong_minimum_is_fitted_again() {
    for start in [-2.0, 2.0] {
        let answer = diagnosed(start, &[("sag", 0.3)], 0.02);
        let said = line(&answer);
        assert_eq!(answer.verdict, Verdict::Named, "{start}: {said}");
        assert!((size(&answer) - 0.3).abs() < 0.05, "{start}: {said}");
        assert!(!answer.is_in_part(), "{start}: {:?}", answer.remainder);
    }
}

/// Checks that an instrument far beyond its tolerance makes a name one in part, which does not count what the
/// instrument takes up as explained, and that a name smaller than what the instrument takes up is none.
#[test]
fn an_instrument_that_is_impossible_leaves_the_larger_effect_named_in_part() {
    let usual = diagnosed(2.0, &[("sag", 2.0), ("clock", 0.03)], 0.02);
    assert!(!usual.is_in_part(), "{:?}", usual.remainder);

    let large = diagnosed(2.0, &[("sag", 2.0), ("clock", 0.3)], 0.02);
    let said = line(&large);
    assert_eq!(large.verdict, Verdict::Named, "{said}");
    assert!(large.is_in_part(), "{said}");
    let reason = large.reason.as_deref().unwrap_or_default();
    assert!(reason.contains("clock.amount at 1"), "{reason}");
    let explained = large.remainder.explained.expect("an answer");
    assert!((0.7..0.95).contains(&explained), "{explained}");

    let small = diagnosed(2.0, &[("sag", 0.6), ("clock", 0.3)], 0.02);
    let said = line(&small);
    assert_eq!(small.verdict, Verdict::Unresolved, "{said}");
    let reason = small.reason.as_deref().unwrap_or_default();
    assert!(reason.contains("far beyond their tolerance"), "{reason}");
}
