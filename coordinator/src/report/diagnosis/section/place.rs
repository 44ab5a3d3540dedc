//! Where the recalibrated simulation and the record part: crank angle, order, joint.
use super::{Figures, Section};
use crate::report::diagnosis::{Subject, words};
use crate::report::number::{figure, fixed};
use crate::report::section::figure as framed;
use discrepancy::locate::angle::Window;
use discrepancy::stage::whereabouts::Where;
use maud::{Markup, html};

pub(super) const SECTION: Section = Section {
    id: "where",
    title: "Where the curves part",
    render,
};

/// Windows and entries that are named in words.
const NAMED: usize = 6;

fn render(subject: &Subject<'_>, figures: &Figures) -> Option<Markup> {
    let seen = subject.diagnosed.diagnosis.whereabouts.as_ref()?;
    let channels: Vec<String> = words::calibrated(subject)
        .map(|record| record.channels.iter().map(|c| c.name()).collect())
        .unwrap_or_default();
    Some(html! {
        p {
            "Everything here is what the recalibrated model, without any further effect, leaves of the \
             record; what another set of parameters could take up does not show."
        }
        (windows(seen, &channels))
        (peaks(seen, &channels))
        @for one in &figures.place { (framed(one)) }
    })
}

fn windows(seen: &Where, channels: &[String]) -> Markup {
    let name = |c: usize| channels.get(c).map_or("", String::as_str);
    let all = &seen.angle.windows;
    html! {
        @if all.is_empty() {
            p { "By crank angle: no window of the revolution stands out of the noise." }
        } @else {
            p { "By crank angle, the strongest first:" }
            ul {
                @for window in all.iter().take(NAMED) {
                    li {
                        (name(window.channel)) ", " (fixed(window.from_deg, 0)) " to "
                        (fixed(end_deg(window), 0)) " deg: the simulation is too "
                        @if window.strength > 0.0 { "low" } @else { "high" }
                        " by " (fixed(window.strength.abs(), 1)) " standard deviations"
                    }
                }
            }
            @if all.len() > NAMED { p { "and " (all.len() - NAMED) " more windows." } }
        }
    }
}

/// Where a window ends, within the revolution.
fn end_deg(window: &Window) -> f64 {
    if window.to_deg > 360.0 {
        window.to_deg - 360.0
    } else {
        window.to_deg
    }
}

fn peaks(seen: &Where, channels: &[String]) -> Markup {
    let name = |c: usize| channels.get(c).map_or("", String::as_str);
    let all = &seen.order.peaks;
    let named: Vec<String> = all
        .iter()
        .take(NAMED)
        .map(|peak| {
            format!(
                "order {} at {} ({}\u{a0}× noise)",
                peak.order,
                name(peak.channel),
                figure(peak.ratio)
            )
        })
        .collect();
    html! {
        @if named.is_empty() {
            p { "By order of the crank: no entry stands out of the noise." }
        } @else {
            p {
                "By order of the crank, " (all.len()) " entries stand out, most of all "
                (words::listed(&named, "and")) "."
            }
        }
    }
}
