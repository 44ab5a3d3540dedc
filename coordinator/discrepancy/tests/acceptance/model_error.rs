//! Tests with a model that is a little wrong: every record has a smooth error that no model reproduces, drawn
//! anew for each condition.
use crate::strata::{machine, named, planted};
use crate::trial::{Setup, diagnosed, diagnoses, line, say};
use crate::truth::Truth;
use discrepancy::verdict::Verdict;

fn wrong(size: f64) -> Setup {
    Setup {
        model_error: size,
        ..Setup::default()
    }
}

/// Checks that at most one healthy machine in twenty gets a name from a model that is a little wrong.
#[test]
fn a_model_error_gets_no_name() {
    let sets = diagnoses(6, 60);
    for size in [0.3, 1.0, 3.0] {
        let mut claims = Vec::new();
        for seed in 0..sets {
            let (answer, _) = diagnosed(&Truth::healthy(11_000 + seed), &wrong(size));
            if !matches!(
                answer.verdict,
                Verdict::NothingDetected | Verdict::Unresolved
            ) {
                claims.push(line(&answer));
            }
        }
        say(&format!(
            "zero effect, model error {size}: {} claims of {sets}",
            claims.len()
        ));
        assert!(20 * claims.len() as u64 <= sets, "{claims:#?}");
    }
}

/// Checks that effects at three times their limits are still found by a model that is a little wrong.
#[test]
fn effects_are_found_beside_a_model_error() {
    let each = diagnoses(1, 15);
    let (mut right, mut all, mut other) = (0, 0, Vec::new());
    for (k, effect) in named().into_iter().enumerate() {
        for seed in 0..each {
            let truth = planted(machine(k, seed), effect, 3.0);
            let (answer, _) = diagnosed(&truth, &wrong(1.0));
            all += 1;
            let first = answer.rounds.first().map_or(&[][..], |round| &round.set);
            if first.first() == Some(&effect.id) {
                right += 1;
            } else {
                other.push(format!("{}: {}", effect.id, line(&answer)));
            }
        }
    }
    say(&format!(
        "3 x limit, model error 1: top {right} of {all}; {other:#?}"
    ));
    assert!(4 * right >= 3 * all, "{right} of {all}: {other:#?}");
}
