//! How the search approached its optimum.
use crate::data::Calibration;
use crate::document::{Section, figures};
use crate::{chart, words};

pub(super) fn calibration(calibration: &Calibration) -> Section {
    let recommended = words::complete_objective(calibration);
    let searched = !calibration.history.is_empty();
    let drawn = searched.then(|| chart::convergence(calibration, recommended));
    Section {
        id: "convergence",
        title: "Convergence of the population",
        blocks: figures(drawn),
    }
}
