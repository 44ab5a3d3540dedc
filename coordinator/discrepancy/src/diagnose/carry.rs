//! Whether a name carries: what an answer must show beside its test before anything is named.
//!
//! A test says that something is there; how far the gap closes does not prove a name, either. But a name
//! whose size may be nothing, that stands at a bound, that does not close the gap where it was not fitted,
//! or that instruments are never more exact than, is none. One rule, a total function of what is known.
use crate::proof::weighed::Weighed;
use crate::record::nuisance::WITHIN;

/// So many times the noise may be left before a name needs nearly all of the gap.
const MUCH: f64 = 10.0;
/// Share of every gap that it must close then.
const NEARLY_ALL: f64 = 0.8;
/// A size within this share of its range from a bound stands at the bound.
const AT_BOUND: f64 = 1e-3;

/// A size of an effect that is about to be named.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Size {
    /// The effect.
    pub(crate) effect: String,
    /// The parameter.
    pub(crate) parameter: String,
    pub(crate) value: f64,
    /// 95 % interval.
    pub(crate) interval: [f64; 2],
    /// Least and greatest value.
    pub(crate) bounds: [f64; 2],
    /// The value at which it does nothing.
    pub(crate) absent: f64,
    /// One standard deviation of what it is without any effect, if it is never exact.
    pub(crate) tolerance: Option<f64>,
}

impl Size {
    /// Whether nothing is a likely value of it, or one that any instrument may have.
    fn may_be_nothing(&self) -> bool {
        let [low, high] = self.interval;
        let holds = low <= self.absent && self.absent <= high;
        let usual = |sd: f64| (self.value - self.absent).abs() <= WITHIN * sd;
        holds || self.tolerance.is_some_and(usual)
    }

    /// Whether it stands at a bound that is not its absent value.
    fn at_bound(&self) -> bool {
        let [lower, upper] = self.bounds;
        let near = |bound: f64| (self.value - bound).abs() <= AT_BOUND * (upper - lower);
        let free = |bound: f64| (bound - self.absent).abs() > AT_BOUND * (upper - lower);
        self.bounds
            .into_iter()
            .any(|bound| near(bound) && free(bound))
    }

    /// Whether its interval is as wide as its range.
    fn is_open(&self) -> bool {
        let [low, high] = self.interval;
        low <= self.bounds[0] && self.bounds[1] <= high
    }
}

/// How far a gap closes on a record that took no part in the fit, or nothing where that is not known.
#[derive(Clone, Debug)]
pub(crate) struct Elsewhere {
    /// In words.
    pub(crate) record: String,
    /// Whether an answer that is fitted to one condition alone claims it.
    pub(crate) claimed: bool,
    pub(crate) closed: Option<Weighed>,
}

/// All that speaks for an answer.
#[derive(Clone, Debug)]
pub(crate) struct Claim {
    /// Sizes of all its effects.
    pub(crate) sizes: Vec<Size>,
    /// The gap on what was fitted.
    pub(crate) fitted: Option<Weighed>,
    /// The gap on everything that was not.
    pub(crate) elsewhere: Vec<Elsewhere>,
    /// How many times the noise it leaves.
    pub(crate) left: f64,
}

/// Why an answer is no name, if it is none.
pub(crate) fn doubt(claim: &Claim) -> Option<String> {
    size_doubt(&claim.sizes).or_else(|| gap_doubt(claim))
}

/// What speaks against the sizes of effects.
pub(crate) fn size_doubt(sizes: &[Size]) -> Option<String> {
    for size in sizes {
        let Size {
            effect, parameter, ..
        } = size;
        let mut own = sizes.iter().filter(|other| other.effect == *effect);
        if own.all(Size::may_be_nothing) {
            let [low, high] = size.interval;
            return Some(match size.tolerance {
                Some(sd) if !(low..=high).contains(&size.absent) => format!(
                    "{effect}: its {parameter} of {:.3e} lies within {WITHIN} of what such an instrument \
                     is good to ({sd:.1e})",
                    size.value
                ),
                _ => format!(
                    "{effect}: the interval of its {parameter}, {low:.3e} to {high:.3e}, holds the value \
                     at which it does nothing"
                ),
            });
        }
        if size.at_bound() {
            return Some(format!(
                "{effect}: its {parameter} stands at a bound, {:.3e}",
                size.value
            ));
        }
        if size.is_open() {
            return Some(format!(
                "{effect}: the interval of its {parameter} is as wide as its whole range"
            ));
        }
    }
    None
}

/// What speaks against an answer where it was not fitted.
fn gap_doubt(claim: &Claim) -> Option<String> {
    for Elsewhere { record, closed, .. } in claim.elsewhere.iter().filter(|one| one.claimed) {
        let Some(closed) = closed else {
            return Some(format!("it does not run under {record}"));
        };
        let [low, high] = closed.interval;
        if closed.speaks_against() {
            return Some(format!(
                "it closes {:.0} % of the gap on {record}, with an interval from {:.0} to {:.0} %: it may \
                 close none of it",
                100.0 * closed.closed,
                100.0 * low,
                100.0 * high
            ));
        }
    }
    if claim.left <= MUCH {
        return None;
    }
    let elsewhere = claim.elsewhere.iter().filter(|one| one.claimed);
    let elsewhere = elsewhere.map(|one| (&*one.record, one.closed));
    let fitted = std::iter::once(("the cycles that were fitted", claim.fitted));
    let mut all = fitted.chain(elsewhere);
    let (record, poor) = all.find_map(|(record, closed)| {
        let closed = closed?.closed;
        (closed <= NEARLY_ALL).then_some((record, closed))
    })?;
    Some(format!(
        "it leaves {:.0} times the noise and closes only {:.0} % of the gap on {record}, where more than \
         {:.0} % would show that its law is another's in shape alone",
        claim.left,
        100.0 * poor,
        100.0 * NEARLY_ALL
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn size(value: f64, interval: [f64; 2]) -> Size {
        Size {
            effect: "slip".to_owned(),
            parameter: "share".to_owned(),
            value,
            interval,
            bounds: [-1.0, 1.0],
            absent: 0.0,
            tolerance: None,
        }
    }

    const fn closed(closed: f64, interval: [f64; 2]) -> Weighed {
        Weighed {
            closed,
            interval,
            shows: true,
        }
    }

    fn claim(elsewhere: Weighed, left: f64) -> Claim {
        Claim {
            sizes: vec![size(0.3, [0.2, 0.4])],
            fitted: Some(closed(0.95, [0.9, 1.0])),
            elsewhere: vec![Elsewhere {
                record: "the other speed".to_owned(),
                claimed: true,
                closed: Some(elsewhere),
            }],
            left,
        }
    }

    #[test]
    fn a_size_that_may_be_nothing_names_nothing() {
        let said = |sizes: &[Size]| size_doubt(sizes);
        assert_eq!(said(&[size(0.3, [0.2, 0.4])]), None);
        let nothing = size(0.1, [-0.1, 0.3]);
        assert!(
            said(std::slice::from_ref(&nothing))
                .unwrap()
                .contains("does nothing")
        );
        // one size of several is enough, and of another effect it is none
        assert_eq!(said(&[nothing.clone(), size(0.3, [0.2, 0.4])]), None);
        let other = Size {
            effect: "phase".to_owned(),
            ..size(0.3, [0.2, 0.4])
        };
        assert!(said(&[nothing, other]).unwrap().starts_with("slip"));
    }

    #[test]
    fn an_instrument_is_no_discovery_within_three_of_what_it_is_good_to() {
        let toleranced = |value: f64| Size {
            tolerance: Some(0.1),
            ..size(value, [value - 0.01, value + 0.01])
        };
        assert!(size_doubt(&[toleranced(0.29)]).unwrap().contains("good to"));
        assert_eq!(size_doubt(&[toleranced(-0.31)]), None);
    }

    #[test]
    fn bounds_and_open_intervals_carry_nothing() {
        assert!(
            size_doubt(&[size(0.9999, [0.5, 1.0])])
                .unwrap()
                .contains("bound")
        );
        let wide = Size {
            absent: -2.0,
            ..size(0.5, [-1.0, 1.0])
        };
        assert!(size_doubt(&[wide]).unwrap().contains("whole range"));
    }

    #[test]
    fn a_gap_must_close_where_nothing_was_fitted() {
        assert_eq!(doubt(&claim(closed(0.4, [0.1, 0.6]), 1.0)), None);
        let may_not = doubt(&claim(closed(0.4, [-0.1, 0.6]), 1.0)).unwrap();
        assert!(may_not.contains("may close none"), "{may_not}");
        // a record that could not show it says nothing, unless it speaks against it
        let hidden = |interval: [f64; 2]| Weighed {
            shows: false,
            ..closed(0.4, interval)
        };
        assert_eq!(doubt(&claim(hidden([-2.0, 0.9]), 1.0)), None);
        assert!(doubt(&claim(hidden([-2.0, -0.1]), 1.0)).is_some());
        let mut gone = claim(closed(0.4, [0.1, 0.6]), 1.0);
        gone.elsewhere[0].closed = None;
        assert!(doubt(&gone).unwrap().contains("does not run"));
        gone.elsewhere[0].claimed = false;
        assert_eq!(doubt(&gone), None);
    }

    /// Where much is left, the law is not the machine's: then nearly all must close everywhere.
    #[test]
    fn much_that_is_left_asks_for_more() {
        assert_eq!(doubt(&claim(closed(0.85, [0.8, 0.9]), 79.0)), None);
        let poor = doubt(&claim(closed(0.6, [0.5, 0.7]), 79.0)).unwrap();
        assert!(poor.contains("79 times") && poor.contains("60 %"), "{poor}");
    }
}
