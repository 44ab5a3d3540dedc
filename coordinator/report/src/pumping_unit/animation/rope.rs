//! Drawing of the ropes and the contact force in the first frame; the player redraws them for the other
//! frames.
use super::film::{Film, MM, RopeFrame, TENSION};
use maud::{Markup, html};

/// Draws both ropes.
pub(super) fn ropes(film: &Film) -> Markup {
    html! {
        (rope("machine-back", &film.back[0], &rope_ends(film, true), film))
        (rope("machine-front", &film.front[0], &rope_ends(film, false), film))
    }
}

/// Returns the ends of a rope in the first frame \[mm\]: crossbeam or suspension point, and the anchor on the
/// head.
fn rope_ends(film: &Film, back: bool) -> [[f64; 2]; 2] {
    let (start, head) = if back {
        (film.crossbeam[0], film.back_head)
    } else {
        (film.suspension[0], film.front_head)
    };
    let beam = film.beam.first().copied().unwrap_or(0.0).to_radians();
    let (sin, cos) = beam.sin_cos();
    let (x, y) = (f64::from(head[2]), f64::from(head[3]));
    [start.map(f64::from), [cos * x - sin * y, sin * x + cos * y]]
}

/// Draws a rope as one line per joint, coloured by its tension; the last line ends at the anchor.
fn rope(id: &str, frame: &RopeFrame, ends: &[[f64; 2]; 2], film: &Film) -> Markup {
    let mut points = vec![ends[0]];
    points.extend(frame.points().iter().map(|point| point.map(f64::from)));
    points.push(ends[1]);
    let [low, high] = film.tension_range;
    let tension = |index: usize| {
        let known = frame.tension.get(index).or(frame.tension.last());
        (known.copied().map_or(low, f64::from) - low) / (high - low)
    };
    html! {
        g.rope id=(id) {
            @for (index, pair) in points.windows(2).enumerate() {
                line x1=(format!("{:.1}", pair[0][0] / MM)) y1=(format!("{:.1}", -pair[0][1] / MM))
                    x2=(format!("{:.1}", pair[1][0] / MM)) y2=(format!("{:.1}", -pair[1][1] / MM))
                    stroke=(TENSION.at(tension(index))) {}
            }
        }
    }
}

/// Draws the contact force along both ropes as diagrams outside the arcs, for the first frame.
pub(super) fn pressure(film: &Film) -> Markup {
    let beam = film.beam.first().copied().unwrap_or(0.0).to_radians();
    let (sin, cos) = beam.sin_cos();
    let path = |frame: &RopeFrame, head: [i32; 4]| {
        let (x, y) = (f64::from(head[0]), f64::from(head[1]));
        diagram(frame, [cos * x - sin * y, sin * x + cos * y])
    };
    html! {
        path.pressure id="machine-back-contact" d=(path(&film.back[0], film.back_head)) {}
        path.pressure id="machine-front-contact" d=(path(&film.front[0], film.front_head)) {}
    }
}

/// Returns the path of one rope's contact force diagram: along the tips of the forces, drawn normal to the
/// arc, and back along the rope.
fn diagram(frame: &RopeFrame, center_mm: [f64; 2]) -> String {
    let mut outer = Vec::new();
    let mut inner = Vec::new();
    for (point, &height) in frame.points().iter().zip(&frame.contact) {
        if height <= 0 && outer.is_empty() {
            continue;
        }
        let [x, y] = point.map(f64::from);
        let (dx, dy) = (x - center_mm[0], y - center_mm[1]);
        let reach = 1.0 + f64::from(height) / dx.hypot(dy).max(1.0);
        let (x1, y1) = (center_mm[0] + reach * dx, center_mm[1] + reach * dy);
        outer.push(format!("{:.1},{:.1}", x1 / MM, -y1 / MM));
        inner.push(format!("{:.1},{:.1}", x / MM, -y / MM));
    }
    if outer.is_empty() {
        return "M0,0".to_owned();
    }
    inner.reverse();
    format!("M{}L{}Z", outer.join("L"), inner.join("L"))
}
