//! Check that the fields of PEST templates are wide enough for the difference steps of the unknowns that they hold: a field
//! that shows the same text before and after a step hides the unknown from every search.
use exchange::{
    number,
    pest::{TemplateField, fit},
};
use protocol::{
    case::{Case, Scale, Unknown},
    external::Parameter,
};

/// Difference step of an unknown whose case states none (coordinate: decades, or halves of the search interval).
const STEP: f64 = 0.02;
/// Relative error of the step as read back from its field from which the field is too narrow for a derivative.
const STEP_ERROR: f64 = 0.1;
/// Width that holds every number with all its digits.
const FULL_WIDTH: usize = 24;
/// Number of values between the bounds at which the texts are compared.
const VALUES: u32 = 12;

/// Value of an unknown at which a field hides a difference step.
#[derive(Debug)]
pub(super) struct HiddenStep {
    /// Value of the unknown as it is written.
    pub(super) value: f64,
    /// Value after the step.
    pub(super) moved: f64,
    /// Least width of a field from which the step can be read with an error of at most [`STEP_ERROR`] (characters).
    pub(super) needed: usize,
}

/// Returns the value at which a field hides the difference step of the parameter at an index, if there is one; `None` also
/// for parameters that are not searched.
pub(super) fn hidden_step(
    case: &Case,
    index: usize,
    parameter: &Parameter,
    field: TemplateField,
) -> Option<HiddenStep> {
    let (unknown, ratio) = searched(case, index)?;
    let steps: Vec<[f64; 2]> = steps(unknown)
        .map(|pair| pair.map(|value| parameter.factor * ratio * value + parameter.offset))
        .collect();
    let shows = |width: usize, [value, moved]: [f64; 2]| {
        let texts = [value, moved].map(|value| fit(value, width));
        let [Some(before), Some(after)] = texts.each_ref().map(|text| number(text.as_deref()?))
        else {
            return false;
        };
        ((after - before) / (moved - value) - 1.0).abs() <= STEP_ERROR
    };
    // one digit that differs is enough for a search to see the unknown
    let hidden = steps.iter().find(|pair| {
        let texts = pair.map(|value| fit(value, field.width));
        texts[0].is_none() || texts[0] == texts[1]
    })?;
    let mut widths = field.width + 1..=FULL_WIDTH;
    let is_wide = |width: &usize| steps.iter().all(|pair| shows(*width, *pair));
    Some(HiddenStep {
        value: hidden[0],
        moved: hidden[1],
        needed: widths.find(is_wide).unwrap_or(FULL_WIDTH),
    })
}

/// Returns the unknown that is searched in place of that at an index (itself, or the one to which it is tied) and the ratio to
/// it.
fn searched(case: &Case, index: usize) -> Option<(&Unknown, f64)> {
    let mut unknown = case.unknowns.get(index)?;
    let mut ratio = 1.0;
    for _ in 0..case.unknowns.len() {
        let Some(tie) = &unknown.tie else { break };
        ratio *= tie.ratio;
        unknown = case.unknowns.iter().find(|other| other.name == tie.to)?;
    }
    (unknown.tie.is_none() && !unknown.fixed).then_some((unknown, ratio))
}

/// Returns pairs of values one difference step apart: at the start, the bounds and between them.
fn steps(unknown: &Unknown) -> impl Iterator<Item = [f64; 2]> + '_ {
    let step = unknown.step.unwrap_or(STEP);
    let half = 0.5 * (unknown.upper - unknown.lower);
    let is_logarithmic = unknown.scale == Scale::Logarithmic;
    let between = move |share: f64| {
        if is_logarithmic {
            unknown.lower * (unknown.upper / unknown.lower).powf(share)
        } else {
            unknown.lower + 2.0 * half * share
        }
    };
    let values = (0..=VALUES).map(move |at| between(f64::from(at) / f64::from(VALUES)));
    std::iter::once(unknown.start)
        .chain(values)
        .map(move |value| {
            let moved = if is_logarithmic {
                value * 10_f64.powf(step)
            } else {
                value + half * step
            };
            [value, moved]
        })
}
