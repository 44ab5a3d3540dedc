//! Verbal results of a diagnosis: reason of the verdict and further remarks.
use crate::baseline::base::Baseline;
use crate::diagnose::diagnosis::WorkingDiagnosis;
use crate::inputs::Inputs;
use crate::model::fit::Fit;
use crate::validation::compare::ValidationRecord;
use crate::validation::predictive::unscored;
use crate::verdict::{TestValidity, Verdict};

/// Findings that contradict the hypothesis that the residual is noise alone, from which the verdict follows.
#[derive(Debug)]
pub(crate) struct Rejection {
    /// Whether the tests of the named effects reject the hypothesis of noise alone.
    pub(crate) names: bool,
    /// Description of the effects that were found but cannot be named.
    pub(crate) suspect: Option<String>,
    /// Reason why the effects are not named, although the basis of the tests is reliable.
    pub(crate) doubt: Option<String>,
    /// Description of the residual that remains after fitting the answer, if it is more than noise.
    pub(crate) left: Option<String>,
}

/// Describes the size of the residual that the answer leaves, as a multiple of the noise's standard deviation.
pub(crate) fn left(base: &Baseline, after: &Fit) -> String {
    let ratio = (after.chi_squared() / base.noise()).sqrt();
    let assumed = !base.known().is_seen();
    if assumed && ratio < 1.0 {
        format!(
            "the residual is only {ratio:.2} times the assumed noise: the assumption is too high"
        )
    } else if assumed {
        format!("the residual is {ratio:.2} times the assumed noise")
    } else {
        format!("the residual is {ratio:.2} times the noise and remains unexplained")
    }
}

/// Returns the reason for the verdict of a diagnosis in words; `None` where it needs none.
pub(crate) fn reason(
    ground: TestValidity,
    diagnosis: &WorkingDiagnosis,
    rejection: &Rejection,
) -> Option<String> {
    let nothing = diagnosis.verdict == Verdict::NothingDetected;
    if ground == TestValidity::NothingConsidered && nothing {
        return Some("no effect of the library was considered, so none was looked for".to_owned());
    }
    if diagnosis.verdict != Verdict::Unresolved {
        return None;
    }
    let round = diagnosis.rounds.first().and_then(|r| r.reason.clone());
    let Rejection {
        names,
        suspect,
        doubt,
        left,
    } = rejection;
    let what = match (suspect, left) {
        (Some(suspect), _) if doubt.is_some() => format!(
            "the likeliest effect is {suspect}, but it is not named: {}",
            doubt.as_deref().unwrap_or_default()
        ),
        (Some(suspect), _) => format!("the likeliest effect is {suspect}"),
        (None, Some(left)) if !*names => {
            round.map_or_else(|| left.clone(), |round| format!("{left}; {round}"))
        }
        (None, _) if *names => round.unwrap_or_default(),
        (None, _) => "the localisation of the residual shows a deviation that noise alone is \
                      unlikely to cause"
            .to_owned(),
    };
    Some(match ground {
        TestValidity::Valid | TestValidity::NoiseStated => what,
        TestValidity::DiscretisationUnknown => format!(
            "no finer model completes its simulation, so that the discretisation error of the curves \
             is not known; {what}"
        ),
        TestValidity::NoiseUnknown => format!(
            "the noise is not known: there is one cycle, and some channel states no noise; {what}; \
             record more cycles, or state `noise` of every channel"
        ),
        TestValidity::NothingConsidered => format!(
            "the residual is not explained, and no effect of the library was considered; {what}"
        ),
    })
}

/// Adds remarks on numerical error, on records that do not test the answer, and on effects excluded from the tests, to a
/// diagnosis.
pub(crate) fn remarks(
    inputs: &Inputs,
    shown: &[ValidationRecord<'_>],
    diagnosis: &mut WorkingDiagnosis,
) {
    let (of, check) = match (&diagnosis.preflight_after, &diagnosis.preflight) {
        (Some(after), _) => ("the answer", Some(after)),
        (None, before) => ("the recalibrated model", before.as_ref()),
    };
    if let Some(check) = check.filter(|check| check.is_rough()) {
        let ratio = check.ratio();
        diagnosis.notes.push(format!(
            "numerical error: a finer model changes the curves of {of} by {ratio:.2} standard errors of the \
             record (target: one third); this counts as noise in every test, but sizes may be wrong by as \
             much"
        ));
    }
    let added = diagnosis.rounds.iter().any(|round| round.added.is_some());
    if added {
        let unscored = unscored(shown, &diagnosis.prediction, inputs);
        diagnosis.notes.extend(unscored);
    }
    if added && diagnosis.preflight_after.is_none() {
        diagnosis.notes.push(
            "no finer model completes at the answer: its numerical error is unknown".to_owned(),
        );
    }
    if diagnosis.verdict == Verdict::Unlisted && !inputs.thresholds.without.is_empty() {
        diagnosis.notes.push(format!(
            "these effects of the library were not considered, and may be the cause: {}",
            inputs.thresholds.without.join(", ")
        ));
    }
}
