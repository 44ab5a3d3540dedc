//! What reports show of a case's kind of model.
use super::chart::Axis;
use super::drawing::Drawing;
use protocol::case::{Abscissa, Case};

/// How results of a case are shown.
pub(crate) fn of(case: &Case) -> &'static dyn Drawing {
    crate::kind::of(case).drawing()
}

/// The axis of a channel of a case.
pub(super) fn axis(case: &Case, abscissa: &Abscissa) -> Axis {
    Axis::of(abscissa, of(case).zero())
}
