//! Sections of the reports of a calibration and of a simulation: one file each, listed once in this module.
//!
//! A section turns data into blocks, or returns no blocks where there are no data for it. A section depends
//! neither on its position, nor on other sections, nor on the output format.
mod agreement;
mod convergence;
mod curves;
mod derivative;
mod gap;
mod gene;
mod individual;
mod machine;
mod notes;
pub(super) mod origin;
mod parameters;
mod slowest;
mod summary;
mod worker;

use super::assessment::MachineAssessment;
use super::data::{Calibration, SingleRun};
use super::document::Section;
use super::kind;

pub use derivative::derivatives;
pub use gene::genes;
pub(super) use individual::one as individual;
pub(super) use machine::{
    blocks as machine_blocks, calibration as machine, table as machine_table,
};
pub use machine::{checks, condition_checks, flags};
pub(super) use parameters::calibration as parameters;
use summary::changes;
pub(super) use summary::headline;
pub use worker::{hosts, jobs, slot_time};

/// Builds all sections of a calibration report, in page order.
pub(super) fn calibration(all: &Calibration) -> Vec<Section> {
    let mut sections = vec![
        summary::calibration(all),
        changes(all),
        agreement::calibration(all),
        curves::calibration(all),
    ];
    let own = kind::of(&all.case).sections("the optimised", all.optimum().as_ref());
    sections.extend(own);
    sections.extend(all.assessments.iter().map(MachineAssessment::section));
    sections.extend([
        parameters::calibration(all),
        gap::calibration(all),
        convergence::calibration(all),
        gene::calibration(all),
        individual::calibration(all),
        worker::calibration(all),
        slowest::calibration(all),
        notes::calibration(all),
        origin::calibration(all),
    ]);
    sections
}

/// Builds the sections of a calibration that goes on, in page order: without those about its end.
pub(super) fn running_calibration(all: &Calibration) -> Vec<Section> {
    let mut sections = vec![
        summary::running(all),
        agreement::calibration(all),
        curves::calibration(all),
    ];
    let own = kind::of(&all.case).sections("the best", all.optimum().as_ref());
    sections.extend(own);
    sections.extend([
        parameters::calibration(all),
        gap::calibration(all),
        convergence::calibration(all),
        gene::calibration(all),
        individual::calibration(all),
        slowest::calibration(all),
        notes::calibration(all),
    ]);
    sections
}

/// Builds all sections of a simulation report, in page order.
pub(super) fn simulation(run: &SingleRun) -> Vec<Section> {
    let mut sections = vec![summary::simulation(run), curves::simulation(run)];
    let own = kind::of(&run.case).sections(&run.genes_name, Some(&run.shown()));
    sections.extend(own);
    sections.extend([
        parameters::simulation(run),
        derivative::simulation(run),
        notes::simulation(run),
        origin::simulation(run),
    ]);
    sections
}
