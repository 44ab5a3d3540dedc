//! What a diagnosis says in words: why it does not say more, and what else should be known.
use crate::diagnose::diagnosis::Diagnosis;
use crate::ground::base::Base;
use crate::ground::preflight::Preflight;
use crate::inputs::Inputs;
use crate::model::fit::Fit;
use crate::verdict::{Ground, Verdict};

/// A numerical error beyond this share of the record's standard error is said aloud.
const FINE_ENOUGH: f64 = 1.0 / 3.0;

/// What speaks against noise alone.
#[derive(Debug)]
pub(crate) struct Rejection {
    /// Whether the tests of the named effects do.
    pub(crate) names: bool,
    /// What was found and cannot be named.
    pub(crate) suspect: Option<String>,
    /// Why that is not named, where the tests themselves mean what they say.
    pub(crate) doubt: Option<String>,
    /// What is left and is no noise, in words.
    pub(crate) left: Option<String>,
}

/// What is left and is no noise, in words.
pub(crate) fn left(base: &Base, after: &Fit) -> String {
    let ratio = after.chi_squared() / base.noise();
    let assumed = !base.known().is_seen();
    if assumed && ratio < 1.0 {
        format!("what is left is only {ratio:.2} times the assumed noise, which is no such noise")
    } else if assumed {
        format!("what is left is {ratio:.2} times the assumed noise")
    } else {
        format!("what is left is {ratio:.2} times the noise: more than noise, and not explained")
    }
}

/// Why, where the verdict needs it.
pub(crate) fn reason(
    ground: Ground,
    diagnosis: &Diagnosis,
    rejection: &Rejection,
) -> Option<String> {
    let nothing = diagnosis.verdict == Verdict::NothingDetected;
    if ground == Ground::NothingConsidered && nothing {
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
            "the likeliest suspect is {suspect}, but it is no name: {}",
            doubt.as_deref().unwrap_or_default()
        ),
        (Some(suspect), _) => format!("the likeliest suspect is {suspect}"),
        (None, Some(left)) if !*names => {
            round.map_or_else(|| left.clone(), |round| format!("{left}; {round}"))
        }
        (None, _) if *names => round.unwrap_or_default(),
        (None, _) => "the maps of where simulation and record part show a place that noise alone \
                      would hardly leave"
            .to_owned(),
    };
    Some(match ground {
        Ground::Firm | Ground::NoiseStated => what,
        Ground::Unsound => format!(
            "no finer model completes its simulation, so how far the discretisation moves the curves \
             is not known; {what}"
        ),
        Ground::NoiseUnknown => format!(
            "the noise is not known: there is one cycle, and some channel states no noise; {what}; \
             record more cycles, or state `noise` of every channel"
        ),
        Ground::NothingConsidered => format!(
            "something is left, and no effect of the library was considered that could name it; {what}"
        ),
    })
}

/// What else should be known: numerical error, effects that were left out.
pub(crate) fn remarks(inputs: &Inputs, diagnosis: &mut Diagnosis) {
    let (of, check) = match (&diagnosis.preflight_after, &diagnosis.preflight) {
        (Some(after), _) => ("the answer", Some(after)),
        (None, before) => ("the recalibrated model", before.as_ref()),
    };
    let ratio = check.map_or(0.0, Preflight::ratio);
    if ratio > FINE_ENOUGH {
        diagnosis.notes.push(format!(
            "numerical error: a finer model moves {of}'s curves by {ratio:.2} standard errors of the \
             record, where a third is the aim; it counts as noise in every test, but sizes may be off \
             by as much, and a finer model in the case would lower it"
        ));
    }
    let added = diagnosis.rounds.iter().any(|round| round.added.is_some());
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
