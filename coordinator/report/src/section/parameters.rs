//! Report section with the parameters and errors of a calibration in numbers (reference paper, Tables 3 and
//! 4).
use crate::data::{Calibration, SingleRun};
use crate::document::{Section, Table, tables};
use crate::{kind, table};

pub(crate) fn calibration(calibration: &Calibration) -> Section {
    let case = &calibration.case;
    let others = calibration.conditions.iter();
    let others = others.filter(|result| result.condition != case.objective.condition);
    let others = others.map(|result| table::table_4(case, result));
    let first = std::iter::once(table::table_3(calibration)).chain(table::rivals(calibration));
    section(first.chain(others))
}

pub(super) fn simulation(run: &SingleRun) -> Section {
    let own = kind::of(&run.case).tables(run).into_iter();
    section(own.chain([table::genes(run)]))
}

fn section(all: impl IntoIterator<Item = Table>) -> Section {
    Section {
        id: "tables",
        title: "Parameters and errors",
        blocks: tables(all),
    }
}
