//! Whether the likeliest suspect of a round is believed.
//!
//! It knows the round's tests and refits, not who made them; what a finer model says of the answer is
//! another matter.
use crate::cause::refit::Refitted;
use crate::cause::round::Round;
use crate::cause::together::Together;
use crate::ground::base::Base;
use crate::linear::evidence::ambiguity_set;
use crate::linear::isolability::likeness;
use crate::model::fit::Fit;
use crate::thresholds::Thresholds;

/// Whether the best refit is believed; then it is the next model.
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
    let further = !current.model.added.is_empty();
    if further && share(lengths[1] - lengths[2], lengths[1], base.noise()) < FURTHER {
        round.reason = Some(format!(
            "{} removes less than half of what is left beside what was found: as likely as it are laws of \
             another shape under the names that were found",
            best.id
        ));
        return None;
    }
    let (removed, trace) = trace(lengths, base.noise(), thresholds.practical);
    if trace {
        round.reason = Some(format!(
            "{} is there, but a trace: it removes {:.1} % of what is left above the noise",
            best.id,
            100.0 * removed
        ));
        return None;
    }
    let evidences: Vec<f64> = round.refits.iter().map(|r| r.log_evidence).collect();
    let equal = ambiguity_set(&evidences, round.phi).into_iter();
    round.set = equal.map(|i| round.refits[i].id.clone()).collect();
    round.added = Some(best.id.clone());
    Some(best.fit.clone())
}

/// Whether several effects at once are believed instead of the best one alone: the round becomes that of the
/// first, and once more itself for each of the others.
pub(crate) fn decide_together(
    round: &mut Round,
    current: &Fit,
    both: &Together,
    (base, thresholds): (&Base, &Thresholds),
) -> Option<Vec<Round>> {
    let best = round.refits.first();
    let left = best.map_or(current.chi_squared(), |best| best.fit.chi_squared());
    let left = left.min(current.chi_squared());
    let removed = left - both.fit.chi_squared();
    let phi = both.fit.misfit();
    let evidence = best.map_or(f64::NEG_INFINITY, |best| best.log_evidence);
    let gained = both.fit.log_evidence() - evidence.max(round.null_evidence);
    let clear = gained > thresholds.gain * phi * phi && round.p_value <= thresholds.alpha;
    if !clear || share(removed, left, base.noise()) < FURTHER {
        return None;
    }
    let tangent = current.tangent();
    let of_id = |id: &String| round.suspects.iter().find(|own| own.effect.id == *id);
    let set = |id: &String| -> Vec<String> {
        let own = of_id(id);
        let like = |other: &&Refitted| {
            let pair = own.zip(of_id(&other.id));
            !both.members.contains(&other.id)
                && pair.is_some_and(|(a, b)| likeness(&a.signature, &b.signature, &tangent) > ALIKE)
        };
        let rivals = round.refits.iter().filter(like);
        let rivals = rivals.map(|rival| rival.id.clone());
        std::iter::once(id.clone()).chain(rivals).collect()
    };
    let sets: Vec<Vec<String>> = both.members.iter().map(set).collect();
    round.phi = phi;
    let mut rounds = both.members.iter().zip(sets).map(|(id, set)| Round {
        added: Some(id.clone()),
        set,
        reason: None,
        ..round.clone()
    });
    let first = rounds.next()?;
    let beside = rounds.collect();
    *round = first;
    Some(beside)
}

/// Squared cosine of projected signatures from which one effect may stand in another's place beside a third.
const ALIKE: f64 = 0.5;

/// Share of what is left above the noise that an effect must remove which is not the first.
const FURTHER: f64 = 0.5;

/// What is removed, over what is left above the noise.
fn share(removed: f64, left: f64, noise: f64) -> f64 {
    removed / (left - noise).max(1.0)
}

/// Share of what is left above the noise whose removal is no trace, however large the gap was at first.
const NEARLY_ALL: f64 = 0.8;

/// The share that an effect removes of the gap that there was before anything was added, and whether that
/// is but a trace: beside a large effect a second one may be small and yet all that is missing. From the
/// squared lengths of the residual at first, now and with the effect, and what noise alone would leave.
fn trace([first, now, then]: [f64; 3], noise: f64, practical: f64) -> (f64, bool) {
    let share = |of: f64| share(now - then, of, noise);
    let rough = now >= ROUGH * noise;
    let rest = rough && share(now) >= NEARLY_ALL;
    (share(first), share(first) < practical && !rest)
}

/// From so many times the noise on, what an answer leaves shows that its law has not the machine's shape.
const ROUGH: f64 = 1.5;
/// How much more than the best a rival may then leave and still join its set, over what the answer
/// leaves above the noise.
const ALLOWANCE: f64 = 1.5;

/// Widens the sets of an answer that leaves clearly more than noise. Then no law that was tried has the
/// machine's shape; the law under the right name may be off as well, and may have lost to the law of a
/// wrong name by as much as laws are off here. So rivals that leave not much more than the best join its
/// set. `left` is what the answer leaves, `noise` what noise alone would (squared lengths of the whitened
/// residual). Says whether a set has grown.
pub(crate) fn widen(rounds: &mut [Round], left: f64, noise: f64) -> bool {
    let mut grown = false;
    for round in rounds.iter_mut().filter(|round| round.added.is_some()) {
        let lengths: Vec<f64> = round.refits.iter().map(|r| r.fit.chi_squared()).collect();
        for k in near(&lengths, left, noise) {
            let id = &round.refits[k].id;
            if !round.set.contains(id) {
                round.set.push(id.clone());
                grown = true;
            }
        }
    }
    grown
}

/// Positions of refits, the best first, that leave not much more than the best of them.
fn near(lengths: &[f64], left: f64, noise: f64) -> Vec<usize> {
    let rough = left >= ROUGH * noise;
    let best = lengths.first().copied().unwrap_or(f64::NAN);
    let more = |k: &usize| lengths[*k] - best <= ALLOWANCE * (left - noise);
    (0..lengths.len()).filter(|k| rough && more(k)).collect()
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

    /// Beside an answer that reaches the noise nobody joins; beside one that leaves three times the noise,
    /// whoever leaves not much more.
    #[test]
    fn rivals_join_where_no_law_has_the_right_shape() {
        let lengths = [3000.0, 5900.0, 6100.0, 40_000.0];
        assert_eq!(near(&lengths, 3000.0, 1000.0), [0, 1]);
        assert!(near(&lengths, 1100.0, 1000.0).is_empty());
        assert!(near(&[], 3000.0, 1000.0).is_empty());
        assert_eq!(near(&[3000.0, f64::NAN], 3000.0, 1000.0), [0]);
    }

    /// What removes little of the gap is a trace, unless it is nearly all that is left of a gap that shows.
    #[test]
    fn little_of_a_large_gap_may_be_all_that_is_missing() {
        let is_trace = |lengths| trace(lengths, 1000.0, 0.05).1;
        assert!(is_trace([9000.0, 1200.0, 1010.0]));
        assert!(!is_trace([9000.0, 1800.0, 1010.0]));
        assert!(!is_trace([90_000.0, 2500.0, 1060.0]));
        assert!(is_trace([90_000.0, 2500.0, 1400.0]));
        let (removed, _) = trace([9000.0, 3000.0, 1000.0], 1000.0, 0.05);
        assert!((removed - 0.25).abs() < 1e-12);
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
