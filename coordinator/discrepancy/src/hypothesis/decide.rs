//! Decision whether the likeliest candidate effect of a round is accepted.
//!
//! It uses the tests and refits of the round only; the check against a finer model is made elsewhere.
use crate::baseline::base::Baseline;
use crate::hypothesis::joint_refit::JointRefit;
use crate::hypothesis::round::Round;
use crate::model::fit::Fit;
use crate::thresholds::Thresholds;

/// Returns the best refit as the next model if it is accepted, else records the reason in the round. The
/// ambiguity set is determined after all rounds.
pub(crate) fn decide(
    round: &mut Round,
    current: &Fit,
    base: &Baseline,
    thresholds: &Thresholds,
) -> Option<Fit> {
    let best = round.refits.first()?;
    if let Some(doubt) = doubt(round.p_value, round.nats(best.log_evidence), thresholds) {
        round.reason = Some(format!("{} is the likeliest, but {doubt}", best.id));
        return None;
    }
    let lengths = [&base.fit, current, &best.fit].map(Fit::chi_squared);
    // beside what was found: what leaves no more than noise lacks nothing that matters; a noise that is only
    // stated tells too little of that to make a significant effect negligible
    let adequate = base.known().is_seen() && base.explains(current, thresholds.adequacy);
    let removed = removed(lengths, base.noise());
    if adequate && removed < thresholds.practical {
        round.reason = Some(format!(
            "{} is significant but negligible: it removes {:.1} % of the misfit above the noise, and the model without it \
             already fits to within the noise",
            best.id,
            100.0 * removed
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
    round: &mut Round,
    (both, current): (&JointRefit, &Fit),
    thresholds: &Thresholds,
) -> Option<Vec<Round>> {
    let best = round.refits.first().map_or(current, |best| &best.fit);
    let gained = both.fit.gain_over(best).min(both.fit.gain_over(current));
    if gained <= thresholds.gain || round.p_value > thresholds.alpha {
        return None;
    }
    round.dispersion = both.fit.dispersion();
    let mut rounds = both.members.iter().map(|id| Round {
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

/// Returns the share of the baseline's excess misfit that an effect removes, from the squared residuals of
/// the baseline, of the current model and of the model with the effect, and the squared residual expected of
/// noise alone.
fn removed([first, now, then]: [f64; 3], noise: f64) -> f64 {
    (now - then) / (first - noise).max(1.0)
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
    fn what_is_removed_counts_by_the_gap_at_first() {
        let own = removed([9000.0, 3000.0, 1000.0], 1000.0);
        assert!((own - 0.25).abs() < 1e-12);
        // of a gap that noise explains all is removed, or more
        assert!(removed([990.0, 990.0, 980.0], 1000.0) > 1.0);
    }

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
