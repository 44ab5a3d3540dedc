//! Sections of the reports of a calibration and of a simulation: one file each, one line in the list.
//!
//! A section turns data into blocks, or into none where the data have nothing for it. It does not know
//! its place or its neighbours, nor in which form its blocks are read.
mod agreement;
mod convergence;
mod curves;
mod gap;
mod gene;
mod machine;
mod notes;
pub(super) mod origin;
mod parameters;
mod slowest;
mod summary;
mod worker;

use super::data::{Calibration, SingleRun};
use super::document::Section;

pub(super) use parameters::calibration as parameters;

/// Every section about a calibration, in the order of the page.
pub(super) const CALIBRATION: &[fn(&Calibration) -> Section] = &[
    summary::calibration,
    parameters::calibration,
    agreement::calibration,
    gap::calibration,
    curves::calibration,
    convergence::calibration,
    gene::calibration,
    worker::calibration,
    slowest::calibration,
    machine::calibration,
    notes::calibration,
    origin::calibration,
];

/// Every section about one simulation, in the order of the page.
pub(super) const SIMULATION: &[fn(&SingleRun) -> Section] = &[
    summary::simulation,
    parameters::simulation,
    curves::simulation,
    machine::simulation,
    notes::simulation,
    origin::simulation,
];
