//! HTML page around the rendered sections.
use super::board::PageState;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use report::document::STYLE;

/// Style sheet of the page's state line and of messages about the connection.
const LIVE_STYLE: &str = include_str!("live.css");

/// Renders a page whose sections the script keeps up to date; `above` is the path of the page from which it was
/// reached, if there is one.
pub(super) fn page(snapshot: &PageState, above: Option<&str>) -> String {
    let page: Markup = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (snapshot.title) }
                style { (PreEscaped(STYLE)) }
                style { (PreEscaped(LIVE_STYLE)) }
                // replaced by nothing: browsers ask for one by themselves
                link rel="icon" href="data:,";
            }
            body data-live="events" data-version=(snapshot.version) {
                header {
                    p.kind {
                        @if let Some(above) = above { a href=(above) { "All runs" } " · " }
                        "Horsehead · " span id="run" { (snapshot.run) }
                        " · " span.state id="state" role="status" { (snapshot.state) }
                    }
                    p.lost id="lost" hidden { "The connection is lost; trying again." }
                    h1 id="title" { (snapshot.title) }
                    nav id="contents" {
                        @for section in &snapshot.sections {
                            a href=(format!("#{}", section.id)) { (section.title) }
                        }
                    }
                }
                main id="sections" {
                    @for section in &snapshot.sections { (PreEscaped(&section.html)) }
                }
                script src="/page.js" {}
            }
        }
    };
    page.into_string()
}

/// Renders the page for a path at which there is no run.
pub(super) fn missing(message: &str) -> String {
    let page: Markup = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                title { "Not found" }
                style { (PreEscaped(STYLE)) }
                link rel="icon" href="data:,";
            }
            body {
                header { p.kind { "Horsehead" } h1 { "Not found" } }
                main { p.verdict { (message) } p { a href="/" { "Start page" } } }
            }
        }
    };
    page.into_string()
}
