//! Plausibility of estimated effect sizes: conditions beyond the significance test that an effect must meet
//! before it is named.
//!
//! A test only shows that something is present. An effect is not named if its size is compatible with zero,
//! lies at a bound, or is within the tolerance of an instrument.
use crate::thresholds::{AT_BOUND, WITHIN};

/// Estimated size of an effect that is about to be named.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Size {
    /// Identifier of the effect.
    pub(crate) effect: String,
    /// Name of the parameter that sets the effect's size.
    pub(crate) parameter: String,
    pub(crate) value: f64,
    /// 95 % confidence interval of the size.
    pub(crate) interval: [f64; 2],
    /// Whether the joint 95 % confidence region of all sizes of the effect contains the point at which the effect
    /// vanishes. Sizes that stand for each other may each be absent, but not all of them.
    pub(crate) together_absent: bool,
    /// Lower and upper bound of the size in the search.
    pub(crate) bounds: [f64; 2],
    /// Value of the size at which the effect vanishes.
    pub(crate) absent: f64,
    /// Standard deviation of an instrument's error that is expected without any effect, for an effect that
    /// stands for such an error; otherwise `None`.
    pub(crate) tolerance: Option<f64>,
}

impl Size {
    /// Returns whether the size may be absent by its own interval, or is within the tolerance of an instrument.
    pub(crate) fn may_be_absent(&self) -> bool {
        let [low, high] = self.interval;
        (low <= self.absent && self.absent <= high) || self.is_within_tolerance()
    }

    /// Returns whether the size may be absent by its own interval and all sizes of the effect by their joint region, or
    /// the size is within the tolerance of an instrument.
    fn may_be_nothing(&self) -> bool {
        (self.may_be_absent() && self.together_absent) || self.is_within_tolerance()
    }

    /// Returns whether the size is within the tolerance of an instrument.
    fn is_within_tolerance(&self) -> bool {
        let usual = |sd: f64| (self.value - self.absent).abs() <= WITHIN * sd;
        self.tolerance.is_some_and(usual)
    }

    /// Returns whether the value lies at a bound other than its absent value.
    fn at_bound(&self) -> bool {
        let [lower, upper] = self.bounds;
        let near = |bound: f64| (self.value - bound).abs() <= AT_BOUND * (upper - lower);
        let free = |bound: f64| (bound - self.absent).abs() > AT_BOUND * (upper - lower);
        self.bounds
            .into_iter()
            .any(|bound| near(bound) && free(bound))
    }

    /// Returns whether the confidence interval of the size covers the whole allowed range, so that the record
    /// does not determine it.
    fn is_open(&self) -> bool {
        let [low, high] = self.interval;
        low <= self.bounds[0] && self.bounds[1] <= high
    }
}

/// Reason against naming one of several effects.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Doubt {
    /// Identifier of the effect.
    pub(crate) effect: String,
    pub(crate) reason: String,
}

/// Returns the first reason against naming effects of these sizes, if there is one.
pub(crate) fn doubt(sizes: &[Size]) -> Option<Doubt> {
    sizes.iter().find_map(|size| {
        Some(Doubt {
            effect: size.effect.clone(),
            reason: doubt_of(size, sizes)?,
        })
    })
}

/// Returns the reason against one of several sizes, if there is one.
fn doubt_of(size: &Size, sizes: &[Size]) -> Option<String> {
    let Size {
        effect, parameter, ..
    } = size;
    let mut own = sizes.iter().filter(|other| other.effect == *effect);
    // one size that is not nothing is enough
    if own.all(Size::may_be_nothing) {
        let [low, high] = size.interval;
        return Some(match size.tolerance {
            Some(sd) if !(low..=high).contains(&size.absent) => format!(
                "{effect}: its {parameter} of {:.3e} lies within {WITHIN} standard deviations of the \
                 instrument's tolerance ({sd:.1e})",
                size.value
            ),
            _ => format!(
                "{effect}: the interval of its {parameter}, {low:.3e} to {high:.3e}, contains the value \
                 at which the effect vanishes"
            ),
        });
    }
    if size.at_bound() {
        return Some(format!(
            "{effect}: its {parameter} lies at its bound of {:.3e}",
            size.value
        ));
    }
    size.is_open()
        .then(|| format!("{effect}: the interval of its {parameter} is as wide as its whole range"))
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
            together_absent: true,
            bounds: [-1.0, 1.0],
            absent: 0.0,
            tolerance: None,
        }
    }

    #[test]
    fn a_size_that_may_be_nothing_names_nothing() {
        let said = |sizes: &[Size]| doubt(sizes).map(|doubt| doubt.reason);
        assert_eq!(said(&[size(0.3, [0.2, 0.4])]), None);
        let nothing = size(0.1, [-0.1, 0.3]);
        assert!(
            said(std::slice::from_ref(&nothing))
                .unwrap()
                .contains("effect vanishes")
        );
        // one size of several is enough, and of another effect it is none
        assert_eq!(said(&[nothing.clone(), size(0.3, [0.2, 0.4])]), None);
        let other = Size {
            effect: "phase".to_owned(),
            ..size(0.3, [0.2, 0.4])
        };
        assert!(
            said(&[nothing.clone(), other.clone()])
                .unwrap()
                .starts_with("slip")
        );
        assert_eq!(doubt(&[other, nothing.clone()]).unwrap().effect, "slip");
        // two sizes that stand for each other are something where they cannot be absent together
        let one = Size {
            together_absent: false,
            ..nothing.clone()
        };
        assert!(doubt(&[nothing.clone(), nothing]).is_some());
        assert_eq!(doubt(&[one.clone(), one]), None);
    }

    #[test]
    fn an_instrument_is_no_discovery_within_three_of_what_it_is_good_to() {
        let toleranced = |value: f64| Size {
            tolerance: Some(0.1),
            ..size(value, [value - 0.01, value + 0.01])
        };
        assert!(
            doubt(&[toleranced(0.29)])
                .unwrap()
                .reason
                .contains("tolerance")
        );
        assert_eq!(doubt(&[toleranced(-0.31)]), None);
    }

    #[test]
    fn bounds_and_open_intervals_carry_nothing() {
        assert!(
            doubt(&[size(0.9999, [0.5, 1.0])])
                .unwrap()
                .reason
                .contains("bound")
        );
        let wide = Size {
            absent: -2.0,
            ..size(0.5, [-1.0, 1.0])
        };
        assert!(doubt(&[wide]).unwrap().reason.contains("whole range"));
    }
}
