//! Decision whether the likeliest candidate effect of a round is accepted.
//!
//! It uses the tests and refits of the round only; the check against a finer model is made elsewhere.
use crate::baseline::base::Baseline;
use crate::hypothesis::joint_refit::JointRefit;
use crate::hypothesis::round::WorkingRound;
use crate::hypothesis::trace::largest_change;
use crate::model::fit::Fit;
use crate::thresholds::{LAW_FLOOR, Thresholds};

/// Returns the best refit as the next model if it is accepted, else records the reason in the round. The
/// ambiguity set is determined after all rounds.
pub(crate) fn decide(
    round: &mut WorkingRound,
    current: &Fit,
    base: &Baseline,
    thresholds: &Thresholds,
) -> Option<Fit> {
    let best = round.refits.first()?;
    let gain = round.nats(best.log_evidence);
    if let Some(doubt) = doubt(round.p_value, gain, thresholds) {
        round.reason = Some(format!("{} is the likeliest, but {doubt}", best.id));
        return None;
    }
    let change = largest_change(base, [current, &best.fit]);
    if let Some(trace) = change.and_then(|own| own.trace(&best.id, &base.record.record)) {
        round.reason = Some(trace);
        round.trace = Some(best.id.clone());
        return None;
    }
    let needed = needed_beside(current, base, thresholds);
    if gain < needed {
        round.reason = Some(format!(
            "{} is the likeliest, but it gains {gain:.1} nats where {needed:.1} are required: an error of 5 % in the laws \
             of the effects beside it may gain as much",
            best.id
        ));
        return None;
    }
    let (id, fit) = (best.id.clone(), best.fit.clone());
    round.set = vec![id.clone()];
    round.added = Some(id);
    Some(fit)
}

/// Decides whether several effects together are accepted instead of the best single one. If so, `round`
/// becomes the round of the first effect, and one copy of the round is returned for each of the others.
pub(crate) fn decide_joint(
    round: &mut WorkingRound,
    (both, current): (&JointRefit, &Fit),
    thresholds: &Thresholds,
) -> Option<Vec<WorkingRound>> {
    let best = round.refits.first().map_or(current, |best| &best.fit);
    let gains = [best, current].map(|other| both.fit.gain_over(other));
    let enough = gains.iter().all(|gained| *gained > thresholds.gain);
    if !enough || round.p_value > thresholds.alpha {
        return None;
    }
    round.dispersion = both.fit.dispersion().min(current.dispersion());
    let mut rounds = both.members.iter().map(|id| WorkingRound {
        added: Some(id.clone()),
        set: vec![id.clone()],
        together: true,
        reason: None,
        ..round.clone()
    });
    let first = rounds.next()?;
    let beside = rounds.collect();
    *round = first;
    Some(beside)
}

/// Returns the gain of log evidence (nats) that an effect needs beside those that a model has: at least what an error of
/// [`LAW_FLOOR`] in the laws of these may cost of their gain. An effect that resembles such an error
/// gains that without being there: in practice set 4, beside a shift in time that gains 4,011 nats, an offset gains
/// 9.1, although none is hidden.
pub(crate) fn needed_beside(present: &Fit, base: &Baseline, thresholds: &Thresholds) -> f64 {
    if present.model.added.is_empty() {
        return thresholds.gain;
    }
    let gained = present.gain_over(&base.fit);
    thresholds.gain.max(LAW_FLOOR * LAW_FLOOR * gained)
}

/// Returns the reason why an effect is not accepted for its family-wise p-value or its gain of log evidence
/// (nats); `None` if both suffice.
fn doubt(p_value: f64, gain: f64, thresholds: &Thresholds) -> Option<String> {
    let (alpha, needed) = (thresholds.alpha, thresholds.gain);
    let chance = format!("the family-wise p-value is {p_value:.1e}, above the level {alpha}");
    let poor = format!("it gains {gain:.1} nats where {needed:.0} are required");
    match (p_value > alpha, gain < needed) {
        (false, false) => None,
        (true, false) => Some(chance),
        (false, true) => Some(format!("{poor}, at a family-wise p-value of {p_value:.1e}")),
        (true, true) => Some(format!("{chance}, and {poor}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_doubt_names_what_is_missing_and_only_that() {
        let said = |p, gain| doubt(p, gain, &Thresholds::default());
        assert_eq!(said(1e-4, 3.0), None);
        assert_eq!(
            said(0.0432, 7.0).unwrap(),
            "the family-wise p-value is 4.3e-2, above the level 0.01"
        );
        assert_eq!(
            said(6.4e-5, 1.74).unwrap(),
            "it gains 1.7 nats where 3 are required, at a family-wise p-value of 6.4e-5"
        );
        let both = said(0.5, -2.0).unwrap();
        assert!(
            both.contains("5.0e-1") && both.contains("-2.0 nats"),
            "{both}"
        );
    }
}
