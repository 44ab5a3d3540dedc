//! The kinds of models that reports know more of than their channels: one line each.
use super::chart::Axis;
use super::drawing::Drawing;
use super::general::General;
use crate::pumping_unit::report::Dhh;
use protocol::case::{Abscissa, Case};

const ALL: &[&dyn Drawing] = &[&Dhh];

/// How results of a case are shown.
pub(crate) fn of(case: &Case) -> &'static dyn Drawing {
    let mut all = ALL.iter().copied();
    let known = all.find(|drawing| drawing.kind() == case.model.kind);
    known.unwrap_or(&General)
}

/// The axis of a channel of a case.
pub(super) fn axis(case: &Case, abscissa: &Abscissa) -> Axis {
    Axis::of(abscissa, of(case).zero())
}
