//! Sections of the reports of a calibration and of a simulation: one file each, one line in the list.
//!
//! A section turns data into blocks, or into none where the data have nothing for it. It does not know
//! its place or its neighbours, nor in which form its blocks are read.
mod agreement;
mod convergence;
mod curves;
mod derivative;
mod gap;
mod gene;
mod notes;
pub(super) mod origin;
mod parameters;
mod slowest;
mod summary;
mod worker;

use super::data::{Calibration, SingleRun};
use super::document::Section;
use super::kind;

pub use derivative::derivatives;
pub use gene::genes;
pub(super) use parameters::calibration as parameters;
pub use worker::{hosts, jobs, slot_time};

/// Every section about a calibration, in the order of the page.
pub(super) fn calibration(all: &Calibration) -> Vec<Section> {
    let mut sections = vec![
        summary::calibration(all),
        parameters::calibration(all),
        agreement::calibration(all),
        gap::calibration(all),
        curves::calibration(all),
        convergence::calibration(all),
        gene::calibration(all),
        worker::calibration(all),
        slowest::calibration(all),
    ];
    let own = kind::of(&all.case).sections("the optimised", all.optimum().as_ref());
    sections.extend(own);
    sections.extend([notes::calibration(all), origin::calibration(all)]);
    sections
}

/// Every section about one simulation, in the order of the page.
pub(super) fn simulation(run: &SingleRun) -> Vec<Section> {
    let mut sections = vec![
        summary::simulation(run),
        parameters::simulation(run),
        curves::simulation(run),
        derivative::simulation(run),
    ];
    let own = kind::of(&run.case).sections(&run.genes_name, Some(&run.shown()));
    sections.extend(own);
    sections.extend([notes::simulation(run), origin::simulation(run)]);
    sections
}
