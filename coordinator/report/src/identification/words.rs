//! Sentences of an identification report.
use super::subject::IdentificationInput;
use crate::number::fixed;
use crate::words::{join_words, no_intervals};
use discrepancy::identify::{Determination, IntervalEnd, UnknownEstimate};
use record::noise::NoiseSource;

/// Returns the summary sentence: number of unknowns determined, and names of those that are not; the remedy
/// where the fit leaves a multiple of the noise.
pub(super) fn lead(subject: &IdentificationInput<'_>) -> String {
    if !subject.identified.has_intervals {
        return no_intervals(subject.identified.left.sqrt());
    }
    let all = &subject.identified.unknowns;
    let named = |wanted: Determination| -> Vec<String> {
        let own = all.iter().filter(|own| own.seen == wanted);
        own.map(|own| own.name.clone()).collect()
    };
    let both = named(Determination::Both);
    let sides = [
        named(Determination::LowerBound),
        named(Determination::UpperBound),
    ]
    .concat();
    let blind = named(Determination::NotSeen);
    let mut words = format!(
        "This record sees {} of {} unknowns from both sides",
        both.len(),
        all.len()
    );
    let mut more = Vec::new();
    if !both.is_empty() {
        words.extend([": ", &join_words(&both, "and")]);
    }
    if !sides.is_empty() {
        more.push(format!(
            "of {} it gives one bound",
            join_words(&sides, "and")
        ));
    }
    if !blind.is_empty() {
        more.push(format!("it does not see {}", join_words(&blind, "and")));
    }
    if !more.is_empty() {
        words.extend(["; ", &more.join(", ")]);
    }
    words.push('.');
    words
}

/// Lists the sentences on measurement noise and residual of an identification, including the advice to
/// diagnose first where the residual exceeds the noise.
pub(super) fn grounds(subject: &IdentificationInput<'_>) -> Vec<String> {
    let identified = subject.identified;
    let left = format!(
        "The fit leaves {} times the noise",
        fixed(identified.left.sqrt(), 2)
    );
    let mut all = if identified.is_noise {
        vec![format!("{left}: noise alone may leave that.")]
    } else if identified.has_intervals {
        vec![format!(
            "{left}, which is more than noise: the model lacks something. Intervals are as wide as that makes them; \
             `horsehead diagnose CASE` comes first, and an effect that is missing may move every value here."
        )]
    } else {
        vec![
            "`horsehead diagnose CASE` names what is missing; `horsehead identify CASE --genes DIAGNOSIS/calibrated.toml` \
             then gives intervals with it."
                .to_owned(),
        ]
    };
    let noise = match identified.noise {
        NoiseSource::Measured => None,
        NoiseSource::Stated => Some(
            "The noise is stated: there was one cycle, so intervals are as good as that statement, or as what is left \
             where that is more.",
        ),
        NoiseSource::Estimated => Some(
            "The noise is neither seen nor stated: intervals take it from what the fit leaves.",
        ),
    };
    all.extend(noise.map(str::to_owned));
    all
}

/// Describes the sides on which the interval of an unknown is unbounded.
pub(super) fn open_ends(own: &UnknownEstimate) -> String {
    let sides = ["below", "above"].into_iter().zip(own.ends);
    let said = sides.filter_map(|(side, end)| match end {
        IntervalEnd::Rises | IntervalEnd::NotFollowed => None,
        IntervalEnd::Bound => Some(format!("open {side} to the bound")),
        IntervalEnd::Fails => Some(format!("simulations fail {side}")),
        IntervalEnd::GivenUp => Some(format!("profile abandoned {side}")),
    });
    said.collect::<Vec<_>>().join(", ")
}
