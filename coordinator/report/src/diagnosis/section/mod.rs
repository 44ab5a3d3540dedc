//! Sections of the diagnosis report: one file each, one line in the [`SECTIONS`] list.
//!
//! A section turns the diagnosis into blocks, or returns no blocks where the diagnosis holds no data for it.
//! A section depends neither on its position, nor on other sections, nor on the output format.
mod addition;
mod candidates;
mod certainty;
mod localisation;
mod origin;
mod parameter_drift;
mod validation;
mod verdict;

use super::subject::DiagnosisInput;
use crate::document::Section;

/// All sections of the diagnosis report in page order: from the verdict to its evidence and provenance.
pub(super) const SECTIONS: &[fn(&DiagnosisInput<'_>) -> Section] = &[
    verdict::section,
    localisation::section,
    parameter_drift::section,
    candidates::section,
    addition::section,
    validation::section,
    certainty::section,
    origin::section,
];
