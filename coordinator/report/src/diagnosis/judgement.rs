//! Judgement of every candidate effect in a round, with the reason in one sentence.
use super::words::{equals, nats, p_value};
use discrepancy::diagnose::Round;
use discrepancy::hypothesis::candidate::CandidateEffect;
use discrepancy::hypothesis::refit::Refitted;
use discrepancy::linear::score::{chi_squared_tail, family_wise};
use discrepancy::thresholds::AMBIGUITY_MARGIN;
use protocol::announce::Sign;

/// Share of an effect's signature absorbed by recalibration above which the effect counts as hidden.
const HIDDEN: f64 = 0.999;
/// Judgement of a candidate effect in one round: its test, its refit, and why it was kept or dropped.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Judgement {
    /// Tail probability of the effect's test statistic divided by the round's dispersion, corrected for the
    /// number of shapes tried; `None` without a test.
    pub p_value: Option<f64>,
    /// Gain in log evidence of the refitted model with the effect over the model without it, divided by the
    /// round's dispersion \[nats\].
    pub gain: Option<f64>,
    /// Whether the effect was added to the model or belongs to the ambiguity set of the added one.
    pub kept: bool,
    /// Reason why the effect was kept or dropped, in words.
    pub why: String,
}

/// Returns a round's candidate effects with their judgements: kept effects first, then by evidence, then by
/// the test.
pub(super) fn ranked(round: &Round) -> Vec<(&CandidateEffect, Judgement)> {
    let mut all: Vec<(&CandidateEffect, Judgement)> = round
        .candidates
        .iter()
        .map(|suspect| (suspect, judge(round, suspect)))
        .collect();
    all.sort_by(|(_, a), (_, b)| {
        let key = |j: &Judgement| {
            (
                j.gain.unwrap_or(f64::NEG_INFINITY),
                -j.p_value.unwrap_or(2.0),
            )
        };
        let ((gain_a, p_a), (gain_b, p_b)) = (key(a), key(b));
        let by_kept = b.kept.cmp(&a.kept);
        by_kept
            .then(gain_b.total_cmp(&gain_a))
            .then(p_b.total_cmp(&p_a))
    });
    all
}

/// Returns the tail probability of a candidate effect's test statistic divided by the round's dispersion,
/// corrected for the number of tries; `None` without a test.
pub(super) fn dispersed_p_value(round: &Round, suspect: &CandidateEffect) -> Option<f64> {
    let score = suspect.score.as_ref()?;
    if suspect.statistic() > 0.0 {
        let scaled = score.statistic / round.dispersion;
        Some(family_wise(
            chi_squared_tail(scaled, score.freedom),
            suspect.tries,
        ))
    } else {
        Some(1.0)
    }
}

/// Returns the result of refitting the model with a candidate effect in a round, if it was refitted.
fn refit<'a>(round: &'a Round, suspect: &CandidateEffect) -> Option<&'a Refitted> {
    let mut refits = round.refits.iter();
    refits.find(|refit| refit.id == suspect.effect.id)
}

/// Judges one candidate effect of a round.
pub(super) fn judge(round: &Round, suspect: &CandidateEffect) -> Judgement {
    let scale = round.dispersion;
    let refit = refit(round, suspect);
    Judgement {
        p_value: dispersed_p_value(round, suspect),
        gain: refit.map(|refit| (refit.log_evidence - round.null_evidence) / scale),
        kept: round.set.contains(&suspect.effect.id),
        why: match refit {
            Some(refit) => after_refit(round, refit, scale),
            None => before_refit(round, suspect),
        },
    }
}

/// Returns why a refitted candidate effect was kept or dropped.
fn after_refit(round: &Round, own: &Refitted, scale: f64) -> String {
    let gain = (own.log_evidence - round.null_evidence) / scale;
    let best = round.refits.first();
    let behind = best.map_or(0.0, |best| (best.log_evidence - own.log_evidence) / scale);
    if round.added.as_ref() == Some(&own.id) {
        return if round.set.len() > 1 {
            "kept: the best of its ambiguity set, added".to_owned()
        } else {
            "kept: added to the model".to_owned()
        };
    }
    let Some(best) = best.filter(|best| best.id != own.id) else {
        // the round's own reason stands below its table
        return format!(
            "dropped: the best candidate effect, with a gain of {} nats, but the evidence is insufficient",
            nats(gain)
        );
    };
    if !own.log_evidence.is_finite() {
        return "dropped: its refit has no evidence (the fit does not determine it)".to_owned();
    }
    if round.set.contains(&own.id) {
        return format!(
            "kept in the ambiguity set: {} nats behind {} on what was fitted, and with what took no part less than {AMBIGUITY_MARGIN:.0} behind the best",
            nats(behind),
            best.id
        );
    }
    if gain <= 0.0 {
        return "dropped: after recalibration of all unknowns it does not improve the fit"
            .to_owned();
    }
    format!("dropped: beaten by {} nats by {}", nats(behind), best.id)
}

/// Returns why a candidate effect was not refitted.
fn before_refit(round: &Round, suspect: &CandidateEffect) -> String {
    let Some(score) = &suspect.score else {
        return "could not be simulated here: nothing is said about it".to_owned();
    };
    if suspect.signature <= 0.0 {
        return "dropped: it changes nothing at any size that was tried".to_owned();
    }
    if !suspect.linear {
        return "dropped: its response is nonlinear (threshold), and the simulation budget left no refit"
            .to_owned();
    }
    if score.freedom == 0 || score.absorbed > HIDDEN {
        return "dropped: recalibration absorbs it, so this record cannot show it".to_owned();
    }
    if suspect.statistic() <= 0.0 {
        let one_sided = suspect
            .effect
            .parameters
            .iter()
            .any(|p| p.sign == Sign::Positive);
        return if one_sided {
            "dropped: the records would require a physically impossible sign".to_owned()
        } else {
            "dropped: it explains nothing".to_owned()
        };
    }
    // the tests decide who is refitted: whoever was likelier than one that was, was due
    let own = suspect.p_value();
    let least = |other: &&CandidateEffect| refit(round, other).is_some() && other.p_value() > own;
    if round.candidates.iter().filter(least).count() > 0 {
        return "dropped: its refit could not be simulated".to_owned();
    }
    let p = dispersed_p_value(round, suspect).unwrap_or(1.0);
    if p > 0.01 {
        format!("dropped: not significant (p {})", equals(&p_value(p)))
    } else {
        "dropped: the limit on refits was reached by more significant candidate effects".to_owned()
    }
}
