//! Tests with one planted effect at a time, at multiples of its printed detection limit.
use crate::strata::{NOISES, machine, named, planted, planted_at};
use crate::trial::{Setup, diagnose_usual, diagnoses, line, say};
use crate::truth::{ALL, Truth};
use discrepancy::diagnose::Diagnosis;
use discrepancy::model::sizes;
use discrepancy::verdict::Verdict;
use protocol::announce::EffectDescriptor;
use statrs::distribution::{Binomial, DiscreteCDF};

/// Acceptance 7 and 10, and the intervals, over three levels of noise: checks that at three times its limit
/// an effect is in the ambiguity set, mostly first; that the other members of the set were predicted; and
/// that its size is right.
#[test]
fn every_effect_is_named_at_three_times_its_limit() {
    let each = diagnoses(1, 15);
    let (mut top, mut within, mut members) = (0_u32, 0, 0);
    let (mut confusions, mut predicted) = (0, 0);
    let (mut covered, mut errors) = (0, Vec::new());
    let mut of_level = [(0, 0); NOISES.len()];
    let mut missed = Vec::new();
    for (k, effect) in named().into_iter().enumerate() {
        for seed in 0..each {
            let level = (k + seed as usize) % NOISES.len();
            let truth = planted(machine(k, seed), effect, 3.0);
            let answer = diagnose_usual(&truth);
            of_level[level].1 += 1;
            let first = answer.rounds.first().map_or(&[][..], |round| &round.set);
            if first.first() == Some(&effect.id) {
                top += 1;
                of_level[level].0 += 1;
                let (inside, error) = size_of(&answer, effect, &truth);
                covered += usize::from(inside);
                errors.push(error);
            }
            if first.contains(&effect.id) {
                within += 1;
                members += first.len();
            } else {
                missed.push(format!(
                    "{} {:?}: {}",
                    effect.id,
                    truth.effects,
                    line(&answer)
                ));
            }
            for rival in first.iter().filter(|id| **id != effect.id) {
                confusions += 1;
                predicted += usize::from(expected(&answer, effect, rival));
            }
        }
    }
    let all = each as usize * named().len();
    errors.sort_by(f64::total_cmp);
    let median = errors[errors.len() / 2];
    say(&format!(
        "3 x limit: top {top}, in set {within} of {all}; mean set {:.2}; {predicted} of {confusions} \
         confusions predicted; interval holds {covered} of {top}; median error {:.1} %; top by noise \
         {NOISES:?}: {of_level:?}",
        members as f64 / f64::from(within),
        100.0 * median
    ));
    assert!(f64::from(within) >= 0.9 * all as f64, "{missed:#?}");
    assert!(
        f64::from(top) >= 0.85 * all as f64,
        "{top} of {all} {missed:#?}"
    );
    assert!(members as f64 <= 2.0 * f64::from(within));
    assert!(
        5 * predicted >= 4 * confusions,
        "{predicted} of {confusions}"
    );
    assert!(
        reaches(covered as u64, u64::from(top), 0.85),
        "{covered} of {top}"
    );
    assert!(median <= 0.1, "{median}");
}

/// Returns whether a counted share is not significantly below an aim (binomial test, 5 %): fifty trials with
/// success rate 87 % give fewer than 85 % in one sample of three.
fn reaches(counted: u64, of: u64, aim: f64) -> bool {
    let chance = Binomial::new(aim, of).expect("a share");
    chance.cdf(counted) > 0.05
}

/// Returns whether the interval of the planted effect's size contains the true size, and the relative error
/// of the estimate.
fn size_of(answer: &Diagnosis, effect: &EffectDescriptor, truth: &Truth) -> (bool, f64) {
    let own = sizes(effect).into_iter();
    let planted = &truth.effects[0].1;
    let k = own.max_by(|&a, &b| planted[a].abs().total_cmp(&planted[b].abs()));
    let estimate = answer.effects.iter().find(|e| e.id == effect.id);
    let (Some(k), Some(estimate)) = (k, estimate) else {
        return (false, 1.0);
    };
    let own = &estimate.parameters[k];
    let inside = (own.interval[0]..=own.interval[1]).contains(&planted[k]);
    (inside, (own.value / planted[k] - 1.0).abs())
}

/// Returns whether the diagnosis states that the record cannot tell a rival from the effect.
fn expected(answer: &Diagnosis, effect: &EffectDescriptor, rival: &str) -> bool {
    let mut pairs = answer.look_alikes.iter();
    pairs.any(|pair| {
        [&effect.id, rival]
            .iter()
            .all(|id| pair.effects.iter().any(|own| own == id))
    })
}

/// Acceptance 8, second half, over the levels of noise: checks that the printed limit is within a factor 1.5
/// of the size that is detected in nine records of ten.
#[test]
fn printed_limits_are_those_of_ninety_per_cent_power() {
    let each = diagnoses(1, 10);
    let detected = |multiple: f64| {
        let mut seen = 0;
        for (k, effect) in named().into_iter().enumerate() {
            for seed in 0..each {
                let answer = diagnose_usual(&planted(machine(k, seed), effect, multiple));
                seen += usize::from(answer.verdict != Verdict::NothingDetected);
            }
        }
        seen as f64 / (each as f64 * named().len() as f64)
    };
    let (above, below) = (detected(1.5), detected(1.0 / 1.5));
    say(&format!(
        "detected at 1.5 x limit {:.0} %, at limit / 1.5 {:.0} %",
        100.0 * above,
        100.0 * below
    ));
    assert!(above >= 0.9, "{above}");
    assert!(below <= 0.9, "{below}");
}

/// Acceptance 9: checks that with the gauges alone most names are still right.
#[test]
fn four_gauges_alone_name_most_effects() {
    let channels = ALL[..4].to_vec();
    let setup = Setup {
        channels,
        ..Setup::default()
    };
    let (mut right, mut all) = (0, 0);
    let mut missed = Vec::new();
    for seed in 0..diagnoses(1, 5) {
        for (k, effect) in named().into_iter().enumerate() {
            let healthy = Truth::healthy(30_000 + 100 * k as u64 + seed);
            let limits = crate::trial::diagnosed(&healthy, &setup).0.limits;
            let scale = effect.parameters[sizes(effect)[0]].scale;
            let limit = limits.iter().find(|l| l.id == effect.id);
            if limit.is_none_or(|l| l.size >= 2.0 * scale) {
                // the limits say that the gauges do not see it
                continue;
            }
            let truth = planted_at(healthy, effect, 3.0, &limits);
            let (answer, _) = crate::trial::diagnosed(&truth, &setup);
            let first = answer.rounds.first().map_or(&[][..], |round| &round.set);
            all += 1;
            if first.contains(&effect.id) {
                right += 1;
            } else {
                missed.push(format!(
                    "{} {:?}: {}",
                    effect.id,
                    truth.effects,
                    line(&answer)
                ));
            }
        }
    }
    say(&format!("gauges only: {right} of {all} in the set"));
    assert!(
        all >= 10 && 4 * right >= 3 * all,
        "{right} of {all} {missed:#?}"
    );
}
