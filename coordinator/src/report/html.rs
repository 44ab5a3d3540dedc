//! The report as one HTML file: everything inline, nothing fetched, readable on paper.
use super::ReportError;
use super::data::{Calibration, SingleRun};
use super::section::{SECTIONS, Subject};
use maud::{DOCTYPE, Markup, PreEscaped, html};

const STYLE: &str = include_str!("style.css");

/// The report of a calibration.
///
/// # Errors
/// [`ReportError::Chart`] when a figure cannot be drawn.
pub fn calibration(calibration: &Calibration) -> Result<String, ReportError> {
    let title = format!("Calibration of {}", calibration.case.name);
    page(
        &title,
        &calibration.provenance.run,
        Subject::Calibration(calibration),
    )
}

/// The report of one simulation.
///
/// # Errors
/// [`ReportError::Chart`] when a figure cannot be drawn.
pub fn simulation(run: &SingleRun) -> Result<String, ReportError> {
    let title = format!("Simulation of {}", run.case.name);
    page(&title, &run.provenance.run, Subject::Single(run))
}

fn page(title: &str, run: &str, subject: Subject<'_>) -> Result<String, ReportError> {
    let mut parts = Vec::new();
    for section in SECTIONS {
        if let Some(body) = (section.render)(subject)? {
            parts.push(Part {
                id: section.id,
                title: section.title,
                body,
            });
        }
    }
    Ok(assemble(title, run, &parts))
}

/// One rendered section.
pub(super) struct Part {
    /// Anchor in the page.
    pub id: &'static str,
    /// Heading.
    pub title: &'static str,
    /// What stands below it.
    pub body: Markup,
}

/// Sections as one page.
pub(super) fn assemble(title: &str, run: &str, parts: &[Part]) -> String {
    let page: Markup = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                header {
                    p.kind { "Horsehead" @if !run.is_empty() { " · " (run) } }
                    h1 { (title) }
                    nav {
                        @for part in parts {
                            a href=(format!("#{}", part.id)) { (part.title) }
                        }
                    }
                }
                main {
                    @for part in parts {
                        section id=(part.id) {
                            h2 { (part.title) }
                            (part.body)
                        }
                    }
                }
            }
        }
    };
    page.into_string()
}
