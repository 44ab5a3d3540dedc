//! Description in words of the differences between two versions of a case.
use protocol::case::{Case, Channel, Unknown};

/// Maximum number of differences between two versions of a case that are listed in a message.
const MOST: usize = 4;

/// Returns a description of the differences of a case from an earlier version; empty if there are none.
pub fn differences(earlier: &Case, now: &Case) -> String {
    let mut all = Vec::new();
    for unknown in &now.unknowns {
        match earlier.unknowns.iter().find(|own| own.name == unknown.name) {
            None => all.push(format!("the unknown {} is new", unknown.name)),
            Some(own) if own != unknown => all.push(of_unknown(own, unknown)),
            Some(_) => {}
        }
    }
    for own in &earlier.unknowns {
        if now.unknowns.iter().all(|unknown| unknown.name != own.name) {
            all.push(format!("the unknown {} is gone", own.name));
        }
    }
    if earlier.objective != now.objective {
        all.push("the objective".to_owned());
    }
    if earlier.effects != now.effects || earlier.effect_units != now.effect_units {
        all.push("the effects".to_owned());
    }
    let name = |case: &Case, at: usize| {
        let condition = case.conditions.get(at);
        condition.map_or_else(String::new, |own| own.name.clone())
    };
    if earlier.conditions != now.conditions {
        all.push("the conditions".to_owned());
    }
    let same = |own: &&Channel, channel: &Channel| {
        own.name == channel.name && own.condition == channel.condition
    };
    for channel in &now.channels {
        let own = earlier.channels.iter().find(|own| same(own, channel));
        if own.is_some_and(|own| own.record != channel.record) {
            let condition = name(now, channel.condition);
            all.push(format!("the record of {} at {condition}", channel.title));
        } else if own != Some(channel) {
            let condition = name(now, channel.condition);
            all.push(format!("the settings of {} at {condition}", channel.title));
        }
    }
    if earlier.model != now.model {
        all.push("the model (its tables or numbers)".to_owned());
    }
    if all.is_empty() && earlier != now {
        all.push("its name or its channels".to_owned());
    }
    let more = all.len().saturating_sub(MOST);
    all.truncate(MOST);
    if more > 0 {
        all.push(format!("and {more} more"));
    }
    all.join(", ")
}

fn of_unknown(was: &Unknown, is: &Unknown) -> String {
    let numbers = [
        ("starts at", was.start, is.start),
        ("begins at", was.lower, is.lower),
        ("ends at", was.upper, is.upper),
    ];
    let changed = numbers
        .iter()
        .find(|(_, was, is)| was.total_cmp(is).is_ne());
    let name = &is.name;
    match changed {
        Some((what, was, is)) => format!("{name} {what} {is:e}, not {was:e}"),
        None => format!("the settings of {name}"),
    }
}

#[cfg(test)]
mod tests {
    use super::differences;
    use crate::{Overrides, load};
    use std::path::Path;

    #[test]
    fn each_change_is_named() {
        let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/cyjs10-5-37hb");
        let case = load(&shipped, &Overrides::default()).unwrap();
        assert_eq!(differences(&case, &case), "");
        let mut other = case.clone();
        other.unknowns[0].start *= 2.0;
        let record = other.channels[2].record.as_mut().unwrap();
        record.mean[7] += 1.0;
        other.model.settings[9] ^= 1;
        let (first, third) = (&case.unknowns[0], &case.channels[2]);
        assert_eq!(
            differences(&case, &other),
            format!(
                "{} starts at 6.28e8, not 3.14e8, the record of {} at {}, the model (its tables or numbers)",
                first.name, third.title, case.conditions[0].name
            )
        );
        let mut other = case.clone();
        other.unknowns.truncate(4);
        let said = differences(&case, &other);
        let gone = format!("the unknown {} is gone, ", case.unknowns[4].name);
        assert!(said.starts_with(&gone), "{said}");
        assert!(said.ends_with(", and 2 more"), "{said}");
        let mut other = case.clone();
        other.objective.terms.pop();
        assert_eq!(differences(&case, &other), "the objective");
    }
}
