//! The kinds of models that reports know more of than their channels: one line each.
use super::drawing::Drawing;
use crate::pumping_unit::report::Dhh;
use protocol::case::Case;

const ALL: &[&dyn Drawing] = &[&Dhh];

/// The kind of a case; none where there is nothing to show but channels.
pub(crate) fn of(case: &Case) -> Option<&'static dyn Drawing> {
    let mut all = ALL.iter().copied();
    all.find(|drawing| drawing.kind() == case.model.kind)
}
