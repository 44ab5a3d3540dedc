//! Drawing of the machine: side view to scale, 1 unit = 1 cm, y downwards.
//!
//! Arcs, anchors, pins, lengths and ropes are taken from the case; post, gearbox, well head and the outlines
//! of beam and heads away from the arcs are schematic, as the legend states.
use super::film::{Film, MM};
use super::rope;
use maud::{Markup, html};
use protocol::pumping_unit::Machine;

/// Formats a point, given in metres with y upwards, in drawing coordinates.
fn xy(x_m: f64, y_m: f64) -> String {
    format!("{:.1},{:.1}", 100.0 * x_m, -100.0 * y_m)
}

/// Formats a closed SVG path through points \[m\].
fn closed(points: &[(f64, f64)]) -> String {
    let corners: Vec<_> = points.iter().map(|&(x, y)| xy(x, y)).collect();
    format!("M{}Z", corners.join("L"))
}

/// Returns a point on a circle \[m\] at an angle in degrees.
fn on_circle((x, y): (f64, f64), radius: f64, deg: f64) -> (f64, f64) {
    let (sin, cos) = deg.to_radians().sin_cos();
    (x + radius * cos, y + radius * sin)
}

/// Returns 49 points along an arc \[m\].
fn arc(center: (f64, f64), radius: f64, from_deg: f64, to_deg: f64) -> Vec<(f64, f64)> {
    (0..=48)
        .map(|i| {
            on_circle(
                center,
                radius,
                from_deg + (to_deg - from_deg) * f64::from(i) / 48.0,
            )
        })
        .collect()
}

/// Extents of the machine drawing \[m\], and the lower end of the front head's arc \[deg\].
struct Frame {
    left: f64,
    right: f64,
    top: f64,
    ground: f64,
    lower_arc_deg: f64,
    well_head: f64,
}

impl Frame {
    fn new(machine: &Machine, film: &Film) -> Self {
        let most = film.beam.iter().copied().fold(0.0_f64, f64::max);
        let least = film.beam.iter().copied().fold(0.0_f64, f64::min);
        let crank = &machine.crank;
        let lowest = film
            .suspension
            .iter()
            .map(|point| 1e-3 * f64::from(point[1]))
            .fold(f64::INFINITY, f64::min);
        let sweep = crank.center_y_m - 1.5 * crank.radius_m;
        let ground = if lowest.is_finite() {
            sweep.min(lowest - 1.3)
        } else {
            sweep
        };
        let raised = machine.front_head.radius_m
            * (machine.front_head.rope_anchor_deg + most)
                .to_radians()
                .sin()
                .abs();
        let back = &machine.back_head;
        let back_reach = back.center_x_m.hypot(back.center_y_m) + back.radius_m;
        Self {
            left: (crank.center_x_m - 1.62 * crank.radius_m).min(-back_reach) - 0.35,
            right: machine.front_head.radius_m + 0.75,
            top: raised.max(0.8 * back_reach) + 0.35,
            ground,
            // the lowest place where the rope leaves the arc, and some plate below it
            lower_arc_deg: -most - 4.0 - 0.02 * least.abs(),
            well_head: ground + 0.75,
        }
    }
}

/// Draws the machine at the first frame of the animation; every moving part carries an id for the JavaScript
/// player.
pub(super) fn drawing(machine: &Machine, film: &Film) -> Markup {
    let frame = Frame::new(machine, film);
    let view = format!(
        "{:.0} {:.0} {:.0} {:.0}",
        100.0 * frame.left,
        -100.0 * frame.top,
        100.0 * (frame.right - frame.left),
        100.0 * (frame.top - frame.ground + 0.42)
    );
    let beam = film.beam.first().copied().unwrap_or(0.0);
    html! {
        svg.drawing xmlns="http://www.w3.org/2000/svg" viewBox=(view) role="img"
            stroke-linejoin="round" stroke-linecap="round" {
            title { "Side view of the pumping unit, in scale" }
            (hatch())
            (ground(machine, &frame))
            (post(&frame))
            (crank(machine, film))
            (rod(machine, film))
            g id="machine-beam" transform=(format!("rotate({:.3})", -beam)) {
                (beam_and_heads(machine, &frame))
            }
            (rope::pressure(film))
            (rope::ropes(film))
            (pivot())
            (suspension(film, &frame))
            (scale_bar(&frame))
        }
    }
}

fn hatch() -> Markup {
    html! {
        defs {
            pattern id="machine-hatch" width="9" height="9" patternUnits="userSpaceOnUse"
                patternTransform="rotate(45)" {
                line x1="0" y1="0" x2="0" y2="9" stroke="#8a8d90" stroke-width="1.4" {}
            }
        }
    }
}

/// Draws ground, gearbox foundation and well head (schematic).
fn ground(machine: &Machine, frame: &Frame) -> Markup {
    let crank = &machine.crank;
    let (x, y) = (crank.center_x_m, crank.center_y_m);
    let r = crank.radius_m;
    let well = machine.front_head.radius_m;
    let level = -100.0 * frame.ground;
    html! {
        rect x=(format!("{:.1}", 100.0 * frame.left)) y=(format!("{level:.1}"))
            width=(format!("{:.1}", 100.0 * (frame.right - frame.left))) height="20"
            fill="url(#machine-hatch)" {}
        path.edge d=(format!("M{}L{}", xy(frame.left, frame.ground), xy(frame.right, frame.ground))) {}
        path.back-part d=(closed(&[
            (x - 0.62 * r, frame.ground),
            (x - 0.5 * r, y - 0.42 * r),
            (x - 0.5 * r, y + 0.36 * r),
            (x + 0.5 * r, y + 0.36 * r),
            (x + 0.5 * r, y - 0.42 * r),
            (x + 0.62 * r, frame.ground),
        ])) {}
        path.back-part d=(closed(&[
            (well - 0.11, frame.ground),
            (well - 0.11, frame.well_head - 0.2),
            (well - 0.055, frame.well_head - 0.2),
            (well - 0.055, frame.well_head),
            (well + 0.055, frame.well_head),
            (well + 0.055, frame.well_head - 0.2),
            (well + 0.11, frame.well_head - 0.2),
            (well + 0.11, frame.ground),
        ])) {}
        path.thin d=(format!("M{}L{}", xy(well - 0.2, frame.ground + 0.3), xy(well + 0.2, frame.ground + 0.3))) {}
    }
}

/// Draws the post from the pivot to the ground (schematic).
fn post(frame: &Frame) -> Markup {
    let foot = frame.ground;
    let (front, back) = (0.2 * -foot, -0.13 * -foot);
    let brace = |share: f64| {
        let y = foot * share;
        format!("M{}L{}", xy(back * share, y), xy(front * share, y))
    };
    html! {
        path.post d=(closed(&[
            (-0.1, -0.05), (0.1, -0.05), (front + 0.14, foot), (front - 0.1, foot),
            (0.0, -0.75), (back + 0.1, foot), (back - 0.14, foot),
        ])) {}
        @for share in [0.35, 0.58, 0.82] { path.thin d=(brace(share)) {} }
    }
}

fn crank(machine: &Machine, film: &Film) -> Markup {
    let r = machine.crank.radius_m;
    let (cx, cy) = (machine.crank.center_x_m, machine.crank.center_y_m);
    let pin = film.pin[0];
    let pin_deg = (f64::from(pin[1]) / 1e3 - cy)
        .atan2(f64::from(pin[0]) / 1e3 - cx)
        .to_degrees();
    let to_crank = format!("translate({}) rotate({:.3})", xy(cx, cy), -pin_deg);
    let to_weight = format!("rotate({:.3})", -film.crank[2]);
    html! {
        circle.center-line cx=(format!("{:.1}", 100.0 * cx)) cy=(format!("{:.1}", -100.0 * cy))
            r=(format!("{:.1}", 100.0 * r)) {}
        path.center-line d=(format!(
            "M{}L{}M{}L{}",
            xy(cx - 1.25 * r, cy), xy(cx + 1.25 * r, cy), xy(cx, cy - 1.25 * r), xy(cx, cy + 1.25 * r)
        )) {}
        (dimension(cx - 1.36 * r, cy - 0.72 * r, 0.0, &format!("r {r:.3} m")))
        g id="machine-crank" transform=(to_crank) {
            g transform=(to_weight) {
                path.part d=(closed(&[
                    (0.72 * r, 0.4 * r), (1.36 * r, 0.4 * r), (1.46 * r, 0.25 * r),
                    (1.46 * r, -0.25 * r), (1.36 * r, -0.4 * r), (0.72 * r, -0.4 * r),
                ])) {}
            }
            path.part d=(closed(&[
                (-0.24 * r, 0.14 * r), (-0.24 * r, -0.14 * r), (1.4 * r, -0.085 * r),
                (1.4 * r, 0.085 * r),
            ])) {}
            circle.part cx="0" cy="0" r=(format!("{:.1}", 16.0 * r)) {}
            circle.bore cx="0" cy="0" r=(format!("{:.1}", 6.5 * r)) {}
            circle.bore cx=(format!("{:.1}", 100.0 * r)) cy="0" r="5.5" {}
        }
    }
}

fn rod(machine: &Machine, film: &Film) -> Markup {
    let (pin, end) = (film.pin[0], film.crossbeam[0]);
    let (dx, dy) = (f64::from(end[0] - pin[0]), f64::from(end[1] - pin[1]));
    let place = format!(
        "translate({:.1},{:.1}) rotate({:.3})",
        f64::from(pin[0]) / MM,
        -f64::from(pin[1]) / MM,
        -dy.atan2(dx).to_degrees()
    );
    let length = machine.rod.length_m;
    html! {
        g id="machine-rod" transform=(place) {
            path.part d=(closed(&[
                (0.0, 0.055), (length - 0.12, 0.045), (length - 0.12, -0.045), (0.0, -0.055),
            ])) {}
            path.part d=(closed(&[
                (length - 0.14, 0.2), (length, 0.12), (length, -0.12), (length - 0.14, -0.2),
            ])) {}
            circle.part cx="0" cy="0" r="10" {}
            circle.bore cx="0" cy="0" r="4.5" {}
        }
    }
}

/// Draws beam and both heads, in the beam frame.
fn beam_and_heads(machine: &Machine, frame: &Frame) -> Markup {
    let half_rope = 0.5 * machine.ropes.diameter_m;
    let front = &machine.front_head;
    let back = &machine.back_head;
    let radius = front.radius_m - half_rope;
    let (lower, upper) = (frame.lower_arc_deg, front.rope_anchor_deg + 1.0);
    let waist = 0.6 * front.radius_m;
    let mut front_plate = arc((0.0, 0.0), radius, lower, upper);
    front_plate.extend([(waist, 0.30), (waist, -0.27)]);
    let mut front_rib = arc((0.0, 0.0), radius - 0.14, lower + 3.0, upper - 3.0);
    front_rib.extend([(waist + 0.14, 0.2), (waist + 0.14, -0.17)]);
    let center = (back.center_x_m, back.center_y_m);
    let radius = back.radius_m - half_rope;
    let arcs = &machine.modal_head.arc_deg;
    let first = arcs.first().copied().unwrap_or(back.rope_anchor_deg);
    let last = arcs.last().copied().unwrap_or(back.rope_anchor_deg + 90.0);
    let root = 0.3 * (back.center_x_m - back.radius_m);
    let (root_top, root_low) = (0.30, -0.30 - 0.12 * back.radius_m);
    let mut back_plate = arc(center, radius, first, last);
    back_plate.extend([(root, root_low), (root, root_top)]);
    let mut back_rib = arc(center, radius - 0.14, first + 5.0, last - 5.0);
    back_rib.extend([
        (root - 0.14, root_low + 0.1),
        (root - 0.14, root_top - 0.08),
    ]);
    let web = closed(&[
        (root, 0.21),
        (-0.3, 0.26),
        (0.3, 0.26),
        (waist, 0.21),
        (waist, -0.18),
        (0.3, -0.24),
        (-0.3, -0.24),
        (root, -0.24),
    ]);
    let middle = on_circle((0.0, 0.0), 1.0, 0.5 * (first + last));
    let anchor_front = on_circle((0.0, 0.0), front.radius_m, front.rope_anchor_deg);
    let anchor_back = on_circle(center, back.radius_m, back.rope_anchor_deg);
    html! {
        path.part d=(closed(&front_plate)) {}
        path.thin d=(closed(&front_rib)) {}
        path.part d=(closed(&back_plate)) {}
        path.thin d=(closed(&back_rib)) {}
        path.part d=(web) {}
        path.thin d=(format!(
            "M{}L{}L{}M{}L{}L{}",
            xy(root, 0.17), xy(0.0, 0.22), xy(waist, 0.17),
            xy(root, -0.2), xy(0.0, -0.2), xy(waist, -0.14)
        )) {}
        path.center-line d=(format!(
            "M{}L{}M{}L{}",
            xy(center.0 - 0.12, center.1), xy(center.0 + 0.12, center.1),
            xy(center.0, center.1 - 0.12), xy(center.0, center.1 + 0.12)
        )) {}
        (dimension(0.83 * front.radius_m, 0.0, 90.0, &format!("R {:.2} m", front.radius_m)))
        (dimension(
            center.0 + 0.62 * back.radius_m * middle.0,
            center.1 + 0.62 * back.radius_m * middle.1,
            90.0,
            &format!("R {:.2} m", back.radius_m)
        ))
        @for (x, y) in [anchor_front, anchor_back] {
            circle.anchor cx=(format!("{:.1}", 100.0 * x)) cy=(format!("{:.1}", -100.0 * y)) r="6" {}
        }
    }
}

/// Draws a text label on a part of the machine, rotated counter-clockwise by an angle in degrees.
fn dimension(x_m: f64, y_m: f64, turned_deg: f64, text: &str) -> Markup {
    let place = format!("translate({}) rotate({:.0})", xy(x_m, y_m), -turned_deg);
    html! { text transform=(place) text-anchor="middle" dominant-baseline="middle" { (text) } }
}

fn pivot() -> Markup {
    html! {
        circle.part cx="0" cy="0" r="13" {}
        path.quarter d="M0,0L8,0A8,8 0 0 1 0,8ZM0,0L-8,0A8,8 0 0 1 0,-8Z" {}
        circle.ring cx="0" cy="0" r="8" {}
    }
}

fn suspension(film: &Film, frame: &Frame) -> Markup {
    let [x, y] = film.suspension[0].map(|mm| f64::from(mm) / MM);
    let rod_end = -100.0 * frame.well_head;
    html! {
        line.rod id="machine-polished-rod" x1=(format!("{x:.1}")) y1=(format!("{:.1}", -y))
            x2=(format!("{x:.1}")) y2=(format!("{rod_end:.1}")) {}
        g id="machine-suspension" transform=(format!("translate({x:.1},{:.1})", -y)) {
            path.part d="M-26,-3L26,-3L26,6L-26,6Z" {}
            path.part d="M-7,6L7,6L5,16L-5,16Z" {}
        }
    }
}

fn scale_bar(frame: &Frame) -> Markup {
    let (x, y) = (100.0 * (frame.right - 1.3), -100.0 * frame.top + 26.0);
    html! {
        path.edge d=(format!("M{x:.0},{:.0}v8M{x:.0},{y:.0}h100M{:.0},{:.0}v8", y - 4.0, x + 100.0, y - 4.0)) {}
        text x=(format!("{:.0}", x + 50.0)) y=(format!("{:.0}", y + 22.0)) text-anchor="middle" { "1 m" }
    }
}

/// Draws the legend: colour scale of the tension, length scale of the contact force, and a note on the
/// schematic parts.
pub(super) fn legend(film: &Film) -> Markup {
    let [low, high] = film.tension_range.map(|tenths| 0.1 * tenths);
    let gradient = format!("background:linear-gradient(90deg,{})", film.stops.join(","));
    // a length of a quarter of a metre, as the drawing shows it
    let quarter = 0.25 * film.pressure_kn_per_m;
    html! {
        div.legend {
            p { "rope tension [kN]" }
            div.ramp style=(gradient) {}
            div.ramp-ends { span { (format!("{low:.0}")) } span { (format!("{high:.0}")) } }
            p {
                span.swatch {} " contact force per length, drawn outwards: "
                (format!("{quarter:.0}")) " kN/m is 0.25 m on the scale of the machine"
            }
            p.note {
                "Arcs, anchors, crank, rod and ropes are in scale from the machine, ropes drawn \
                 thicker. Post, gearbox, well head and the outlines of beam and heads away from \
                 the arcs are schematic."
            }
        }
    }
}
