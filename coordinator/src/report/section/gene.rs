//! Where the search looked, between the bounds of every gene.
use super::{Rendered, Section, Subject, figure};
use crate::report::chart;

pub(super) const SECTION: Section = Section {
    id: "genes",
    title: "Genes between their bounds",
    render,
};

fn render(subject: Subject<'_>) -> Rendered {
    let Subject::Calibration(calibration) = subject else {
        return Ok(None);
    };
    if calibration.history.is_empty() {
        return Ok(None);
    }
    Ok(Some(figure(&chart::genes(calibration)?)))
}
