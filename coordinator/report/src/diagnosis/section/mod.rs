//! Sections of a diagnosis' report: one file each, one line in the [`SECTIONS`] list.
//!
//! A section turns the diagnosis into blocks, or into none where it has nothing for it. It does not
//! know its place or its neighbours, nor in which form its blocks are read.
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

/// Every section, in the order of the argument.
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
