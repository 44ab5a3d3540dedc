//! Acceptance tests with two effects at once, and with effects that are in no library.
use crate::strata::{OUTSIDE, named, planted};
use crate::trial::{Setup, diagnose_usual, diagnosed, diagnoses, line, say};
use crate::truth::{Truth, Unlisted};
use discrepancy::validation::compare::GapRow;
use discrepancy::verdict::Verdict;

/// Acceptance 9: checks that two effects at four times their detection limits are both found.
#[test]
fn two_effects_at_once_are_both_found() {
    let named = named();
    let sets = diagnoses(5, 75);
    let (mut exact, mut one) = (0, 0);
    let mut missed = Vec::new();
    for seed in 0..sets {
        let k = usize::try_from(seed).expect("few") % named.len();
        let (first, second) = ((5 * k + 1) % named.len(), (7 * k + 3) % named.len());
        let second = if first == second { second + 1 } else { second };
        let (a, b) = (named[first], named[second % named.len()]);
        let truth = planted(planted(Truth::healthy(4000 + seed), a, 4.0), b, 4.0);
        let answer = diagnose_usual(&truth);
        let sets: Vec<&Vec<String>> = answer
            .rounds
            .iter()
            .map(|r| &r.set)
            .filter(|s| !s.is_empty())
            .collect();
        let found = [a, b]
            .iter()
            .filter(|e| sets.iter().any(|s| s.contains(&e.id)))
            .count();
        one += usize::from(found >= 1);
        if found == 2 && sets.len() == 2 {
            exact += 1;
        } else {
            missed.push(format!("{} + {}: {}", a.id, b.id, line(&answer)));
        }
    }
    say(&format!(
        "two effects: exact {exact}, at least one right {one} of {sets}; {missed:#?}"
    ));
    assert!(f64::from(exact) >= 0.6 * sets as f64, "{missed:#?}");
    assert!(one as f64 >= 0.85 * sets as f64, "{missed:#?}");
}

/// Acceptance 9: checks that an effect outside the library is called unlisted, mostly with the right joint
/// and form, and with the amplitude of the force.
#[test]
fn what_is_in_no_library_gets_no_name() {
    let each = diagnoses(1, 15);
    let (mut unlisted, mut form, mut joint, mut both) = (0, 0, 0, 0);
    let mut missed = Vec::new();
    for (k, (what, place, forms)) in OUTSIDE.iter().enumerate() {
        for seed in 0..each {
            let mut truth = Truth::healthy(3000 + 100 * k as u64 + seed);
            truth.unlisted = Some(*what);
            let answer = diagnose_usual(&truth);
            if answer.verdict == Verdict::Unlisted {
                unlisted += 1;
                let said = answer.generic.as_deref().unwrap_or_default();
                let right_form = forms.iter().any(|f| said.ends_with(&format!(".{f}")));
                let right_joint = said.starts_with(&format!("probe.{place}."));
                form += usize::from(right_form);
                joint += usize::from(right_joint);
                both += usize::from(right_form && right_joint);
                let force = answer.force.as_ref().expect("the force that was said");
                assert_eq!(force.id, said);
                let [low, high] = force.interval;
                assert!(low < force.amplitude && force.amplitude < high, "{force:?}");
                // a force that is there is not an accident of the noise, and it closes the gap
                assert!(low * high > 0.0, "{low} {high}");
                let gap = force.rows.iter().find(|row| row.condition == 1);
                // the gap is that of the gauges, which a torque at the crank does not reach
                let upper = |row: &GapRow| {
                    row.closed
                        .interval
                        .map_or(row.closed.closed, |[_, upper]| upper)
                };
                let closes = gap.is_some_and(|row| upper(row) > 0.0);
                assert!(closes || *place == "crank", "{said}: {gap:?}");
            } else {
                missed.push(format!("{what:?}: {}", line(&answer)));
            }
        }
    }
    let all = each * OUTSIDE.len() as u64;
    say(&format!(
        "outside the library: unlisted {unlisted} of {all}, form right {form}, joint right {joint}, \
         both {both}; {missed:#?}"
    ));
    assert!(f64::from(unlisted) >= 0.9 * all as f64, "{missed:#?}");
    assert!(
        both as f64 >= 0.6 * f64::from(unlisted),
        "{both} of {unlisted}"
    );
}

/// Checks that a degree of freedom outside the library that acts like a listed effect is given that name
/// only: a mass that swings slowly on the beam equals an inertia of the beam up to the noise.
#[test]
fn what_acts_like_a_listed_effect_takes_only_its_name() {
    for seed in 0..diagnoses(1, 15) {
        let mut truth = Truth::healthy(3500 + seed);
        truth.unlisted = Some(Unlisted::SwingingMass(0.1));
        let answer = diagnose_usual(&truth);
        let first = answer.effects.first().map(|e| e.id.as_str());
        let honest = first == Some("beam_inertia") || answer.verdict == Verdict::Unlisted;
        assert!(honest, "{}", line(&answer));
    }
}

/// Checks that a generic force that is better than a named effect in its place takes that place, also where
/// the named effect was added because the force did not beat it by enough before.
#[test]
fn a_force_in_the_place_of_a_name_that_it_beats_is_unlisted() {
    for seed in 0..diagnoses(2, 15) {
        let mut truth = Truth::healthy(3700 + seed);
        truth.unlisted = Some(Unlisted::BeamDrag(0.3));
        let mut setup = Setup::default();
        // every force counts as listed until a name is chosen, and a name need not be better than a smooth
        // discrepancy
        setup.thresholds.alike = -1.0;
        setup.thresholds.gain = -5.0;
        let (answer, _) = diagnosed(&truth, &setup);
        let said = line(&answer);
        assert_eq!(answer.verdict, Verdict::Unlisted, "{said}");
        // the head moves with the beam
        let form = answer
            .generic
            .as_deref()
            .is_some_and(|own| own.rsplit('.').next() == Some("v2"));
        assert!(form, "{said}");
        assert!(answer.effects.is_empty(), "{said}");
        let mut reasons = answer
            .rounds
            .iter()
            .filter_map(|round| round.reason.as_deref());
        assert!(reasons.any(|own| own.contains("in the place of")), "{said}");
    }
}

/// Checks that a name that explains a part says so: two effects act, and one round is allowed.
#[test]
fn a_name_that_leaves_more_than_noise_is_said_in_part() {
    let truth = planted(Truth::healthy(3800), named()[1], 8.0);
    let truth = planted(truth, named()[3], 8.0);
    let mut setup = Setup::default();
    setup.thresholds.rounds = 1;
    let (part, _) = diagnosed(&truth, &setup);
    assert!(part.is_in_part(), "{}", line(&part));
    let reason = part.reason.as_deref().unwrap_or_default();
    assert!(
        reason.starts_with("explains") && reason.contains("remain"),
        "{reason}"
    );
    let (whole, _) = diagnosed(&truth, &Setup::default());
    assert!(
        !whole.is_in_part(),
        "{} {:?}",
        line(&whole),
        whole.remainder
    );
    let explained = [&part, &whole].map(|own| own.remainder.explained.unwrap());
    assert!(
        explained[0] < explained[1] && explained[1] > 0.95,
        "{explained:?}"
    );
    assert_eq!(whole.reason, None);
}
