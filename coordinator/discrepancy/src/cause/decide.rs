//! Whether the likeliest suspect of a round is believed.
//!
//! It knows the round's tests and refits, not who made them; what a finer model says of the answer is
//! another matter.
use crate::cause::round::Round;
use crate::cause::together::Together;
use crate::ground::base::Base;
use crate::model::fit::Fit;
use crate::thresholds::Thresholds;

/// Whether the best refit is believed; then it is the next model. Who may stand in its place is asked when all is found.
pub(crate) fn decide(
    round: &mut Round,
    current: &Fit,
    base: &Base,
    thresholds: &Thresholds,
) -> Option<Fit> {
    let best = round.refits.first()?;
    if let Some(doubt) = doubt(round.p_value, round.nats(best.log_evidence), thresholds) {
        round.reason = Some(format!("{} is the likeliest, but {doubt}", best.id));
        return None;
    }
    let lengths = [&base.fit, current, &best.fit].map(Fit::chi_squared);
    // beside what was found: what leaves no more than noise lacks nothing that matters
    let adequate = base.explains(current, thresholds.adequacy);
    let removed = removed(lengths, base.noise());
    if adequate && removed < thresholds.practical {
        round.reason = Some(format!(
            "{} is there, but a trace: it removes {:.1} % of what was above the noise, and without it no more than noise \
             is left",
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

/// Whether several effects at once are believed instead of the best one alone: the round becomes that of the
/// first, and once more itself for each of the others.
pub(crate) fn decide_together(
    round: &mut Round,
    both: &Together,
    thresholds: &Thresholds,
) -> Option<Vec<Round>> {
    let best = round.refits.first();
    let dispersion = both.fit.dispersion();
    let evidence = best.map_or(f64::NEG_INFINITY, |best| best.log_evidence);
    let gained = both.fit.log_evidence() - evidence.max(round.null_evidence);
    if gained <= thresholds.gain * dispersion || round.p_value > thresholds.alpha {
        return None;
    }
    round.dispersion = dispersion;
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

/// The share that an effect removes of the gap that there was before anything was added, from the squared lengths of the
/// residual at first, now and with the effect, and what noise alone would leave.
fn removed([first, now, then]: [f64; 3], noise: f64) -> f64 {
    (now - then) / (first - noise).max(1.0)
}

/// Why a family's p-value and a gain of evidence (nats) are not enough, if they are not.
fn doubt(p_value: f64, gain: f64, thresholds: &Thresholds) -> Option<String> {
    let (alpha, needed) = (thresholds.alpha, thresholds.gain);
    let chance = format!("over the family p = {p_value:.1e}, above {alpha}");
    let poor = format!("it gains {gain:.1} nats and {needed:.0} are needed");
    match (p_value > alpha, gain < needed) {
        (false, false) => None,
        (true, false) => Some(chance),
        (false, true) => Some(format!("{poor}, at p = {p_value:.1e} over the family")),
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
            "over the family p = 4.3e-2, above 0.01"
        );
        assert_eq!(
            said(6.4e-5, 1.74).unwrap(),
            "it gains 1.7 nats and 3 are needed, at p = 6.4e-5 over the family"
        );
        let both = said(0.5, -2.0).unwrap();
        assert!(
            both.contains("5.0e-1") && both.contains("-2.0 nats"),
            "{both}"
        );
    }
}
