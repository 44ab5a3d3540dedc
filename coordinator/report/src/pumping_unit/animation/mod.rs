//! Animation of the machine: an inline SVG drawing to scale with a small player, from the snapshots of a
//! simulation.
//!
//! Without JavaScript or on paper the drawing shows the first snapshot; the player only moves its parts. No
//! library and no network access.
mod drawing;
mod film;
mod rope;

use super::revolution;
use maud::{Markup, PreEscaped, html};
use protocol::{
    case::Case,
    pumping_unit::{Machine, Simulation},
};

/// JavaScript player that reads the animation's data and moves the parts of the drawing.
pub(super) const PLAYER: &str = include_str!("player.js");
/// Style sheet of the machine parts, used by this section only.
const STYLE: &str = include_str!("film.css");

/// Draws the machine with its player; `None` if the simulation has no snapshots.
pub(super) fn machine(case: &Case, condition: usize, simulation: &Simulation) -> Option<Markup> {
    let machine = Machine::of(case).ok()?;
    let film = film::Film::new(case, &machine, condition, simulation)?;
    let (curves, span) = revolution::player(case, simulation);
    let [left, right, top, bottom] = span.map(|share| 100.0 * share);
    let span = format!(
        "left:{left:.3}%;width:{:.3}%;top:{top:.3}%;height:{:.3}%",
        right - left,
        bottom - top
    );
    Some(html! {
        div.machine id="machine" {
            style { (PreEscaped(STYLE)) }
            div.stage {
                (drawing::drawing(&machine, &film))
                div.desk {
                    div.controls {
                        button type="button" id="machine-play" { "Play" }
                        label {
                            "crank angle"
                            input id="machine-turn" type="range" min="0" max="360" step="0.5"
                                value="0";
                        }
                        label {
                            "speed"
                            select id="machine-speed" {
                                option value="0.25" { "¼" }
                                option value="1" selected="selected" { "real time" }
                                option value="4" { "4 ×" }
                            }
                        }
                    }
                    (film.readouts())
                    (drawing::legend(&film))
                }
            }
            figure.strips {
                div.under-cursor {
                    (PreEscaped(&curves.svg))
                    div.span style=(span) { div.cursor id="machine-cursor" {} }
                }
                figcaption { (curves.caption) }
            }
            script id="machine-film" type="application/json" { (PreEscaped(film.json())) }
        }
    })
}
