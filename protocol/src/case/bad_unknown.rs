//! Validation of a list of unknowns before a search.
use super::unknown::{Scale, Unknown};
use std::fmt;

/// Unknown with a fault that prevents a search.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BadUnknown {
    /// Index of the faulty unknown in the list.
    pub position: usize,
    /// Name of the faulty unknown.
    pub name: String,
    /// Field of the unknown that has the fault, named as in case files.
    pub field: &'static str,
    /// Value found in the faulty field.
    pub found: String,
    /// Description of the values allowed in the faulty field.
    pub allowed: String,
    /// Action that corrects the fault.
    pub remedy: &'static str,
}

impl fmt::Display for BadUnknown {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            name,
            field,
            found,
            allowed,
            remedy,
            ..
        } = self;
        write!(
            to,
            "unknown {name}: {field} = {found}, but it must be {allowed}; {remedy}"
        )
    }
}

impl std::error::Error for BadUnknown {}

/// Checks a list of unknowns: names, bounds, starts, prior knowledge and references to each other.
///
/// Bounds are those of a search, so they are not checked for unknowns that are fixed or tied.
///
/// # Errors
/// The first fault found.
pub fn check_unknowns(unknowns: &[Unknown]) -> Result<(), BadUnknown> {
    let list = List { unknowns };
    for position in 0..unknowns.len() {
        list.name(position)?;
        list.values(position)?;
        list.knowledge(position)?;
    }
    // a tie is followed from name to name, so all names have to be sound
    (0..unknowns.len()).try_for_each(|position| list.tie(position))
}

struct List<'a> {
    unknowns: &'a [Unknown],
}

impl List<'_> {
    fn bad(
        &self,
        position: usize,
        field: &'static str,
        (found, allowed): (impl fmt::Display, impl fmt::Display),
        remedy: &'static str,
    ) -> BadUnknown {
        BadUnknown {
            position,
            name: self.unknowns[position].name.clone(),
            field,
            found: found.to_string(),
            allowed: allowed.to_string(),
            remedy,
        }
    }

    fn find(&self, name: &str) -> Option<&Unknown> {
        self.unknowns.iter().find(|unknown| unknown.name == name)
    }

    fn name(&self, position: usize) -> Result<(), BadUnknown> {
        let (before, from_here) = self.unknowns.split_at(position);
        let name = &from_here[0].name;
        let taken = before.iter().any(|other| other.name == *name);
        if name.is_empty() || taken {
            let allowed = "a name that no other unknown has";
            let remedy = "give each unknown a name of its own";
            let found = format!("\"{name}\"");
            return Err(self.bad(position, "name", (found, allowed), remedy));
        }
        Ok(())
    }

    /// Checks that start and bounds are finite, in order, and positive on a logarithmic scale.
    fn values(&self, position: usize) -> Result<(), BadUnknown> {
        let unknown = &self.unknowns[position];
        let Unknown {
            start,
            lower,
            upper,
            scale,
            ..
        } = *unknown;
        let stated = [("start", start), ("lower", lower), ("upper", upper)];
        let moves = !unknown.fixed && unknown.tie.is_none();
        for (field, value) in stated.into_iter().take(if moves { 3 } else { 1 }) {
            if !value.is_finite() {
                let remedy = "state a number";
                return Err(self.bad(position, field, (value, "finite"), remedy));
            }
            if scale == Scale::Logarithmic && value <= 0.0 {
                let allowed = "above 0 on a logarithmic scale";
                let remedy = "state a positive number, or a linear scale";
                return Err(self.bad(position, field, (value, allowed), remedy));
            }
        }
        if moves && (lower >= upper || !(upper - lower).is_finite()) {
            let allowed = format!("below upper = {upper}");
            let remedy = "exchange or widen the bounds; `fixed` holds an unknown at its start";
            return Err(self.bad(position, "lower", (lower, allowed), remedy));
        }
        if moves && !(lower..=upper).contains(&start) {
            let allowed = format!("{lower} to {upper}");
            let remedy = "the bounds exclude the start: widen them, or correct it";
            return Err(self.bad(position, "start", (start, allowed), remedy));
        }
        Ok(())
    }

    /// Checks the optional information of an unknown: trusted interval, prior, absent value, difference step,
    /// suspected cause, and scan of a narrow minimum.
    fn knowledge(&self, position: usize) -> Result<(), BadUnknown> {
        let unknown = &self.unknowns[position];
        if let Some([from, to]) = unknown.trust
            && !(from <= 0.0 && 0.0 <= to && from < to)
        {
            let found = format!("[{from}, {to}]");
            let allowed = "an interval that contains 0, the start";
            let remedy = "widen it, or leave it out";
            return Err(self.bad(position, "trust", (found, allowed), remedy));
        }
        if let Some(prior) = unknown.prior {
            let value = match unknown.scale {
                Scale::Logarithmic => prior.value > 0.0 && prior.value.is_finite(),
                Scale::Linear => prior.value.is_finite(),
            };
            if !(value && prior.deviation > 0.0 && prior.deviation.is_finite()) {
                let found = format!("{} by {}", prior.value, prior.deviation);
                let allowed = "a value on the unknown's scale and a positive deviation";
                let remedy = "correct it, or leave it out";
                return Err(self.bad(position, "prior", (found, allowed), remedy));
            }
        }
        if let Some(absent) = unknown.absent.filter(|absent| !absent.is_finite()) {
            let remedy = "state the value at which the unknown does nothing, or leave it out";
            return Err(self.bad(position, "absent", (absent, "finite"), remedy));
        }
        let step = unknown
            .step
            .filter(|_| !unknown.fixed && unknown.tie.is_none());
        if let Some(step) = step.filter(|step| !(*step > 0.0 && *step <= 1.0)) {
            let found = format!("{step} decades, or halves of the interval");
            let allowed = "above 0, and no more than 1";
            let remedy = "state a small share of the value, or leave it out";
            return Err(self.bad(position, "difference", (found, allowed), remedy));
        }
        if unknown.suspect.is_some() && unknown.absent.is_none() {
            let found = "without `absent`";
            let allowed = "given only together with `absent`";
            let remedy = "state `absent`, or leave it out";
            return Err(self.bad(position, "suspect", (found, allowed), remedy));
        }
        let Some(valley) = &unknown.valley else {
            return Ok(());
        };
        if !(valley.from < valley.to && valley.step > 0.0 && (valley.to - valley.from).is_finite())
        {
            let found = format!("{} to {} by {}", valley.from, valley.to, valley.step);
            let allowed = "a grid that goes up in positive steps";
            let remedy = "exchange its ends, or state a positive step";
            return Err(self.bad(position, "valley", (found, allowed), remedy));
        }
        let shifts = valley.uncovered_by.iter().chain(&valley.stand_ins);
        let shifted = shifts.map(|shift| &shift.unknown);
        let named = shifted.chain(valley.shares.iter().map(|shares| &shares.unknown));
        for other in named {
            if *other == unknown.name || self.find(other).is_none() {
                let found = format!("\"{other}\"");
                let allowed = "the name of another unknown";
                let remedy = "correct the name";
                return Err(self.bad(position, "valley", (found, allowed), remedy));
            }
        }
        Ok(())
    }

    /// Checks that a tie leads, directly or through other ties, to an unknown that is neither fixed nor tied.
    fn tie(&self, position: usize) -> Result<(), BadUnknown> {
        let unknown = &self.unknowns[position];
        let Some(tie) = &unknown.tie else {
            return Ok(());
        };
        let bad = |allowed: &str, remedy| {
            let found = format!("{} times \"{}\"", tie.ratio, tie.to);
            Err(self.bad(position, "tie", (found, allowed), remedy))
        };
        let positive = unknown.scale == Scale::Linear || tie.ratio > 0.0;
        if tie.ratio == 0.0 || !tie.ratio.is_finite() || !positive {
            let allowed = "a ratio that is not 0, and positive on a logarithmic scale";
            return bad(allowed, "correct the ratio");
        }
        if unknown.fixed {
            let allowed = "left out of an unknown that is fixed";
            return bad(allowed, "either fix it or tie it");
        }
        let mut at = tie;
        for _ in self.unknowns {
            let Some(other) = self.find(&at.to) else {
                return bad("a tie to another unknown of the case", "correct the name");
            };
            if other.fixed {
                let remedy = "fix this one too, or free the other";
                return bad("a tie to an unknown that is not fixed", remedy);
            }
            match &other.tie {
                Some(next) => at = next,
                None => return self.tied_start(position),
            }
        }
        bad(
            "a tie that does not come back to itself",
            "break the circle",
        )
    }

    /// Checks that the start of a tied unknown equals the value given by its tie.
    fn tied_start(&self, position: usize) -> Result<(), BadUnknown> {
        let unknown = &self.unknowns[position];
        let tie = unknown.tie.as_ref();
        let Some((tie, other)) = tie.and_then(|tie| Some((tie, self.find(&tie.to)?))) else {
            return Ok(());
        };
        let follows = tie.ratio * other.start;
        if (unknown.start - follows).abs() <= 1e-9 * follows.abs() {
            return Ok(());
        }
        let allowed = format!("{follows}, {} times the start of {}", tie.ratio, tie.to);
        let remedy = "leave it out: the tie gives it";
        Err(self.bad(position, "start", (unknown.start, allowed), remedy))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{Prior, Shift, Tie, Valley};

    fn stiffness(name: &str) -> Unknown {
        Unknown::new(name, "N/mm", Scale::Logarithmic, 2.0, [0.1, 30.0])
    }

    fn tied(name: &str, to: &str, ratio: f64) -> Unknown {
        Unknown {
            tie: Some(Tie {
                to: to.to_owned(),
                ratio,
            }),
            start: ratio.abs() * 2.0,
            ..stiffness(name)
        }
    }

    fn fixed(name: &str) -> Unknown {
        Unknown {
            fixed: true,
            ..stiffness(name)
        }
    }

    /// Returns the field and the error message of the first fault in a list of unknowns.
    fn refused(unknowns: &[Unknown]) -> (&'static str, String) {
        let bad = check_unknowns(unknowns).unwrap_err();
        (bad.field, bad.to_string())
    }

    #[test]
    fn sound_lists_pass() {
        let mut chain = [tied("c", "b", 0.5), tied("b", "a", 3.0), stiffness("a")];
        chain[0].start = 3.0;
        assert_eq!(check_unknowns(&chain), Ok(()));
        chain[0].start = 2.0;
        assert_eq!(refused(&chain).0, "start");
        let offset = Unknown::new("offset", "furlong", Scale::Linear, 0.0, [-1.0, 1.0]);
        assert_eq!(check_unknowns(&[fixed("a"), offset]), Ok(()));
        let mut held = fixed("a");
        (held.lower, held.upper) = (2.0, 2.0);
        assert_eq!(check_unknowns(&[held]), Ok(()));
    }

    #[test]
    fn bounds_and_starts_are_ordered_and_on_the_scale() {
        let with = |start, bounds| Unknown::new("k", "N/mm", Scale::Logarithmic, start, bounds);
        for (start, bounds, field) in [
            (2.0, [30.0, 0.1], "lower"),
            (2.0, [2.0, 2.0], "lower"),
            (50.0, [0.1, 30.0], "start"),
            (2.0, [0.0, 30.0], "lower"),
            (-2.0, [0.1, 30.0], "start"),
            (2.0, [0.1, f64::INFINITY], "upper"),
            (f64::NAN, [0.1, 30.0], "start"),
        ] {
            let (found, text) = refused(&[with(start, bounds)]);
            assert_eq!(found, field, "{text}");
            assert!(text.starts_with("unknown k: "), "{text}");
        }
        let linear = Unknown::new("x", "mm", Scale::Linear, 0.0, [1.0, 1.0]);
        assert_eq!(refused(&[linear]).0, "lower");
        let huge = Unknown::new("x", "mm", Scale::Linear, 0.0, [-1.7e308, 1.7e308]);
        assert_eq!(refused(&[huge]).0, "lower");
    }

    #[test]
    fn names_are_unique_and_ties_lead_to_what_moves() {
        for (unknowns, field, words) in [
            (vec![stiffness("a"), stiffness("a")], "name", "\"a\""),
            (vec![stiffness("")], "name", "of its own"),
            (vec![tied("a", "a", 1.0)], "tie", "circle"),
            (
                vec![tied("a", "b", 1.0), tied("b", "a", 1.0)],
                "tie",
                "circle",
            ),
            (vec![tied("a", "b", 1.0), fixed("b")], "tie", "not fixed"),
            (
                vec![tied("a", "b", 1.0), tied("b", "c", 1.0), fixed("c")],
                "tie",
                "not fixed",
            ),
            (vec![tied("a", "z", 1.0)], "tie", "correct the name"),
            (vec![tied("a", "b", -1.0), stiffness("b")], "tie", "ratio"),
        ] {
            let (found, text) = refused(&unknowns);
            assert_eq!(found, field, "{text}");
            assert!(text.contains(words), "{text}");
        }
    }

    #[test]
    fn what_is_known_of_one_must_make_sense() {
        let mut unknown = stiffness("a");
        unknown.trust = Some([0.5, 1.0]);
        assert_eq!(refused(&[unknown.clone()]).0, "trust");
        unknown.trust = Some([-1.0, 1.0]);
        unknown.prior = Some(Prior {
            value: 0.0,
            deviation: 1.0,
        });
        assert_eq!(refused(&[unknown.clone()]).0, "prior");
        unknown.prior = None;
        unknown.absent = Some(f64::NAN);
        assert_eq!(refused(&[unknown.clone()]).0, "absent");
        unknown.absent = None;
        let by = Shift {
            unknown: "b".to_owned(),
            by: 1.0,
        };
        unknown.valley = Some(Valley {
            from: -0.3,
            to: 1.1,
            step: 0.02,
            uncovered_by: vec![by],
            shares: None,
            stand_ins: Vec::new(),
        });
        assert_eq!(refused(&[unknown.clone()]).0, "valley");
        assert_eq!(check_unknowns(&[unknown, stiffness("b")]), Ok(()));
    }
}
