//! Parameters and errors in numbers (paper, Tables 3 and 4).
use super::{Rendered, Section, Subject};
use crate::report::table;
use maud::html;

pub(super) const SECTION: Section = Section {
    id: "tables",
    title: "Parameters and errors",
    render,
};

#[expect(clippy::unnecessary_wraps, reason = "all sections share one signature")]
fn render(subject: Subject<'_>) -> Rendered {
    Ok(Some(match subject {
        Subject::Calibration(calibration) => {
            let case = &calibration.case;
            let others = calibration
                .conditions
                .iter()
                .filter(|result| result.condition != case.objective.condition);
            html! {
                (table::markup(&table::table_3(calibration)))
                @for result in others { (table::markup(&table::table_4(case, result))) }
            }
        }
        Subject::Single(run) => html! {
            (table::markup(&table::simulation(run)))
            (table::markup(&table::balance(run)))
            (table::markup(&table::genes(run)))
        },
    }))
}
