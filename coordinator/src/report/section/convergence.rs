//! How the search approached its optimum.
use super::{Rendered, Section, Subject, figure};
use crate::report::{chart, words};

pub(super) const SECTION: Section = Section {
    id: "convergence",
    title: "Convergence of the population",
    render,
};

fn render(subject: Subject<'_>) -> Rendered {
    let Subject::Calibration(calibration) = subject else {
        return Ok(None);
    };
    if calibration.history.is_empty() {
        return Ok(None);
    }
    let recommended = calibration.calibrated().and_then(words::complete_objective);
    let drawn = chart::convergence(&calibration.history, recommended)?;
    Ok(Some(figure(&drawn)))
}
