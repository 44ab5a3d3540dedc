//! Notes and warnings that the run left.
use super::{Rendered, Section, Subject};
use maud::html;

pub(super) const SECTION: Section = Section {
    id: "notes",
    title: "Notes",
    render,
};

#[expect(clippy::unnecessary_wraps, reason = "all sections share one signature")]
fn render(subject: Subject<'_>) -> Rendered {
    let notes = match subject {
        Subject::Calibration(calibration) => &calibration.notes,
        Subject::Single(run) => &run.notes,
    };
    Ok((!notes.is_empty()).then(|| html! { ul { @for note in notes { li { (note) } } } }))
}
