//! Sentences of an identification report.
use super::subject::Subject;
use crate::number::fixed;
use crate::words::listed;
use discrepancy::identify::{End, Seen, UnknownEstimate};
use discrepancy::record::noise::Known;

/// Returns the summary sentence: number of unknowns determined, and names of those that are not.
pub(super) fn lead(subject: &Subject<'_>) -> String {
    let all = &subject.identified.unknowns;
    let named = |wanted: Seen| -> Vec<String> {
        let own = all.iter().filter(|own| own.seen == wanted);
        own.map(|own| own.name.clone()).collect()
    };
    let both = named(Seen::Both);
    let sides = [named(Seen::LowerBound), named(Seen::UpperBound)].concat();
    let blind = named(Seen::NotSeen);
    let mut words = format!(
        "This record sees {} of {} unknowns from both sides",
        both.len(),
        all.len()
    );
    let mut more = Vec::new();
    if !both.is_empty() {
        words.extend([": ", &listed(&both, "and")]);
    }
    if !sides.is_empty() {
        more.push(format!("of {} it gives one bound", listed(&sides, "and")));
    }
    if !blind.is_empty() {
        more.push(format!("it does not see {}", listed(&blind, "and")));
    }
    if !more.is_empty() {
        words.extend(["; ", &more.join(", ")]);
    }
    words.push('.');
    words
}

/// Lists the sentences on noise and residual, including the advice to diagnose first where the residual
/// exceeds the noise.
pub(super) fn grounds(subject: &Subject<'_>) -> Vec<String> {
    let identified = subject.identified;
    let left = format!(
        "The fit leaves {} times the noise",
        fixed(identified.left.sqrt(), 2)
    );
    let mut all = vec![if identified.is_noise {
        format!("{left}: noise alone may leave that.")
    } else {
        format!(
            "{left}, which is more than noise: the model lacks something. Intervals are as wide as that makes them; \
             `horsehead diagnose CASE` comes first, and an effect that is missing may move every value here."
        )
    }];
    let noise = match identified.noise {
        Known::Seen => None,
        Known::Stated => Some(
            "The noise is stated: there was one cycle, so intervals are as good as that statement, or as what is left \
             where that is more.",
        ),
        Known::Guessed => Some(
            "The noise is neither seen nor stated: intervals take it from what the fit leaves.",
        ),
    };
    all.extend(noise.map(str::to_owned));
    all
}

/// Describes the open ends of an unknown's interval.
pub(super) fn open_ends(own: &UnknownEstimate) -> String {
    let sides = ["below", "above"].into_iter().zip(own.ends);
    let said = sides.filter_map(|(side, end)| match end {
        End::Rises => None,
        End::Bound => Some(format!("open {side} to the bound")),
        End::Fails => Some(format!("simulations fail {side}")),
        End::GivenUp => Some(format!("profile abandoned {side}")),
    });
    said.collect::<Vec<_>>().join(", ")
}
