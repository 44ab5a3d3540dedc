//! Tests that the discretisation error of the tool's model is reported, is never named as an effect, and does
//! not overturn correct answers.
use crate::machine::Roughness;
use crate::strata::{named, planted};
use crate::trial::{Setup, diagnosed, line};
use crate::truth::Truth;
use discrepancy::baseline::discretisation_check::Preflight;
use discrepancy::diagnose::Diagnosis;
use discrepancy::verdict::Verdict;

fn with(numerics: Roughness) -> Setup {
    Setup {
        numerics,
        ..Setup::default()
    }
}

fn says(answer: &Diagnosis, what: &str) -> bool {
    answer.notes.iter().any(|note| note.contains(what))
}

/// Checks a coarse model whose ripple is about as large as the standard error of the mean: the numerical
/// error is reported, a healthy machine stays healthy, and a clear effect keeps its name.
#[test]
fn a_rough_model_is_said_to_be_rough_and_names_nothing() {
    let rough = with(Roughness::Ripple(0.1));
    let (healthy, _) = diagnosed(&Truth::healthy(8400), &rough);
    assert_eq!(
        healthy.verdict,
        Verdict::NothingDetected,
        "{}",
        line(&healthy)
    );
    assert!(says(&healthy, "numerical error"), "{:?}", healthy.notes);
    let ratio = healthy.preflight.as_ref().map_or(0.0, Preflight::ratio);
    assert!((0.4..1.5).contains(&ratio), "{ratio}");

    let truth = planted(Truth::healthy(8401), named()[1], 8.0);
    let (ill, _) = diagnosed(&truth, &rough);
    assert_eq!(ill.verdict, Verdict::Named, "{}", line(&ill));
    assert_eq!(ill.effects[0].id, named()[1].id);
    assert!(says(&ill, "numerical error"), "{:?}", ill.notes);
    // the ratio at the answer is to the record's own error, not to that with the model's in it
    let after = ill.preflight_after.as_ref().expect("a check of the answer");
    assert!((0.4..1.5).contains(&after.ratio()), "{}", after.ratio());

    // and a model that is fine enough is not spoken of
    let (fine, _) = diagnosed(&truth, &with(Roughness::Exact));
    assert!(!says(&fine, "numerical error"), "{:?}", fine.notes);
}

/// Checks that a name is withdrawn if the effect explains the record only through the discretisation error of
/// the coarse model.
///
/// The record contains a ripple that no effect of the library makes, but that the coarse model makes while
/// the effect is on; a finer model does not make it.
#[test]
fn a_name_that_rests_on_a_coarse_model_is_withdrawn() {
    let id = "beam_inertia";
    let setup = |numerics| Setup {
        numerics,
        ripple_mpa: 0.6,
        ..Setup::default()
    };
    let (answer, _) = diagnosed(&Truth::healthy(8410), &setup(Roughness::RippleOf(id, 10.0)));
    let said = line(&answer);
    let best = answer.rounds[0].refits.first();
    assert_eq!(best.map(|r| r.id.as_str()), Some(id), "{said}");
    assert_eq!(answer.verdict, Verdict::Unresolved, "{said}");
    let reason = answer.reason.as_deref().unwrap_or_default();
    assert!(
        reason.contains(id) && reason.contains("numerical error"),
        "{reason}"
    );
    assert!(answer.effects.is_empty(), "{said}");
    assert!(says(&answer, "numerical error"), "{:?}", answer.notes);
}

/// Checks that nothing is named if no finer model completes; if only shorter cylinders fail, the rest of the
/// discretisation check still counts.
#[test]
fn without_a_finer_model_nothing_is_named() {
    let truth = planted(Truth::healthy(8420), named()[1], 8.0);
    let (blind, _) = diagnosed(&truth, &with(Roughness::NothingFiner));
    assert!(blind.preflight.is_none() && blind.preflight_after.is_none());
    assert_eq!(blind.verdict, Verdict::Unresolved, "{}", line(&blind));
    let reason = blind.reason.as_deref().unwrap_or_default();
    assert!(
        reason.contains("no finer model") && reason.contains(&named()[1].id),
        "{reason}"
    );
    assert!(
        says(&blind, "the numerical error is unknown"),
        "{:?}",
        blind.notes
    );
    let added = |d: &Diagnosis| d.rounds.iter().any(|round| round.added.is_some());
    assert!(!added(&blind));

    let (partly, _) = diagnosed(&truth, &with(Roughness::NoShorterCylinders));
    assert_eq!(partly.verdict, Verdict::Named, "{}", line(&partly));
    assert!(partly.preflight.as_ref().is_some_and(|p| !p.whole));
    assert!(says(&partly, "one at a time"), "{:?}", partly.notes);

    // where nothing is claimed nothing is withdrawn
    let (healthy, _) = diagnosed(&Truth::healthy(8421), &with(Roughness::NothingFiner));
    assert_eq!(
        healthy.verdict,
        Verdict::NothingDetected,
        "{}",
        line(&healthy)
    );
}
