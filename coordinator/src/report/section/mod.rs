//! Sections of the report: one file each, one line in the [`SECTIONS`] catalogue.
//!
//! A section turns data into markup, or into nothing where the data have nothing for it. It does
//! not know its place or its neighbours.
mod agreement;
mod convergence;
mod curves;
mod gap;
mod gene;
mod machine;
mod notes;
pub(super) mod provenance;
mod summary;
mod table;
mod worker;

use super::ReportError;
use super::chart::Figure;
use super::data::{Calibration, SingleRun};
use maud::{Markup, PreEscaped, html};

/// What a report is about.
#[derive(Clone, Copy)]
pub(super) enum Subject<'a> {
    /// A calibration.
    Calibration(&'a Calibration),
    /// One simulation.
    Single(&'a SingleRun),
}

/// What a section returns: markup, nothing, or an error.
type Rendered = Result<Option<Markup>, ReportError>;

/// One section.
pub(super) struct Section {
    /// Anchor in the page.
    pub id: &'static str,
    /// Heading.
    pub title: &'static str,
    /// Makes the body; nothing leaves the section out.
    pub render: fn(Subject<'_>) -> Rendered,
}

/// Every section, in the order of the page.
pub(super) const SECTIONS: &[Section] = &[
    summary::SECTION,
    table::SECTION,
    agreement::SECTION,
    gap::SECTION,
    curves::SECTION,
    convergence::SECTION,
    gene::SECTION,
    worker::SECTION,
    machine::SECTION,
    notes::SECTION,
    provenance::SECTION,
];

/// A figure with its caption.
pub(super) fn figure(figure: &Figure) -> Markup {
    html! {
        figure id=(format!("figure-{}", figure.name)) {
            (PreEscaped(&figure.svg))
            figcaption { (figure.caption) }
        }
    }
}
