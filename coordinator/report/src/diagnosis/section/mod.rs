//! Sections of the diagnosis report: one file each, one line in the [`SECTIONS`] list.
//!
//! A section turns the diagnosis into blocks, or returns no blocks where the diagnosis holds no data for it.
//! A section depends neither on its position, nor on other sections, nor on the output format.
mod addition;
mod certainty;
mod origin;
mod place;
mod proof;
mod suspect;
mod verdict;
mod wander;

use super::subject::Subject;
use crate::document::Section;

/// All sections of the diagnosis report, in the order of the argument.
pub(super) const SECTIONS: &[fn(&Subject<'_>) -> Section] = &[
    verdict::section,
    place::section,
    wander::section,
    suspect::section,
    addition::section,
    proof::section,
    certainty::section,
    origin::section,
];
