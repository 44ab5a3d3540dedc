//! Sections of an identification's report: one file each, one line in the [`SECTIONS`] list.
mod apart;
mod further;
mod origin;
mod prediction;
mod seen;

use super::subject::Subject;
use crate::document::Section;

/// Every section, in the order of the page.
pub(super) const SECTIONS: &[fn(&Subject<'_>) -> Section] = &[
    seen::section,
    apart::section,
    prediction::section,
    further::section,
    origin::section,
];
