//! Whether the likeliest suspect of a round is believed.
//!
//! It knows the round's tests and refits, not who made them; what a finer model says of the answer is
//! another matter (`stage/preflight`).
use crate::bench::Fit;
use crate::evidence::ambiguity_set;
use crate::rounds::Round;
use crate::settings::Settings;
use crate::stage::establish::Base;

/// Whether the best refit is believed; then it is the next model.
pub(crate) fn decide(
    round: &mut Round,
    current: &Fit,
    settings: &Settings,
    base: &Base,
) -> Option<Fit> {
    let best = round.refits.first()?;
    let scale = round.phi * round.phi;
    let gain = (best.log_evidence - round.null_evidence) / scale;
    let doubt = doubt((round.p_value, settings.alpha), (gain, settings.gain));
    if let Some(doubt) = doubt {
        round.reason = Some(format!("{} is the likeliest, but {doubt}", best.id));
        return None;
    }
    let evidences: Vec<f64> = round.refits.iter().map(|r| r.log_evidence).collect();
    round.set = ambiguity_set(&evidences, round.phi)
        .into_iter()
        .map(|i| round.refits[i].id.clone())
        .collect();
    // of the gap that there was before anything was added
    let removed = (current.chi_squared() - best.fit.chi_squared())
        / (base.fit.chi_squared() - base.bench.metric.len() as f64).max(1.0);
    if removed < settings.practical {
        round.reason = Some(format!(
            "{} is there, but a trace: it removes {:.1} % of what is left above the noise",
            best.id,
            100.0 * removed
        ));
        round.set.clear();
        return None;
    }
    round.added = Some(best.id.clone());
    Some(best.fit.clone())
}

/// Why a family's p-value and a gain of evidence (nats) are not enough, if they are not.
fn doubt((p_value, alpha): (f64, f64), (gain, needed): (f64, f64)) -> Option<String> {
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
    fn a_doubt_names_what_is_missing_and_only_that() {
        let said = |p, gain| doubt((p, 0.01), (gain, 3.0));
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
