//! Map of the contact between back rope and head: force per length over crank angle and position on the arc.
use super::revolution;
use crate::chart::canvas::{Canvas, TextStyle, WIDTH, render};
use crate::chart::panel::Panel;
use crate::chart::points::thinned;
use crate::chart::scale::AxisScale;
use crate::color::{GREY, INK, STRENGTH};
use crate::document::Figure;
use protocol::pumping_unit::{Machine, MachineSnapshot, Simulation};
use support::quantile;

const HEIGHT: f64 = 330.0;
/// Maximum number of snapshots drawn; more would enlarge the file without visible benefit.
const COLUMNS: usize = 91;

/// Overlap of neighbouring cells of the contact map [px], which avoids visible seams.
const OVERLAP: f64 = 0.5;

/// Computes the angle of a point on the back head's arc, in the beam frame \[deg\].
fn arc_deg(machine: &Machine, motion: &MachineSnapshot, point: [f32; 2]) -> f64 {
    let beam = f64::from(motion.beam_deg).to_radians();
    let (sin, cos) = beam.sin_cos();
    let (x, y) = (f64::from(point[0]), f64::from(point[1]));
    // ground frame to beam frame, then as seen from the arc's centre
    let in_beam = (cos * x + sin * y, -sin * x + cos * y);
    let dx = in_beam.0 - machine.back_head.center_x_m;
    let dy = in_beam.1 - machine.back_head.center_y_m;
    dy.atan2(dx).to_degrees().rem_euclid(360.0)
}

/// Cell of the contact map: a rope cylinder in contact with the head in one snapshot.
struct Cell {
    /// Crank angles at the edges of the cell \[deg\].
    turn_deg: (f64, f64),
    /// Angular position of the cylinder on the head's arc \[deg\].
    psi_deg: f64,
    /// Contact force per length of rope [kN/m].
    force: f64,
}

/// Collects the rope cylinders in contact with the head, snapshot by snapshot.
fn cells(machine: &Machine, simulation: &Simulation) -> Vec<Cell> {
    let snapshots: Vec<&MachineSnapshot> = simulation.motion.iter().collect();
    let snapshots = thinned(&snapshots, COLUMNS);
    let mut cells = Vec::new();
    for (index, motion) in snapshots.iter().enumerate() {
        let before = index.checked_sub(1).map_or(motion, |i| &snapshots[i]);
        let after = snapshots.get(index + 1).unwrap_or(motion);
        let mut from = 0.5 * (before.turn_deg + motion.turn_deg);
        let mut to = 0.5 * (after.turn_deg + motion.turn_deg);
        // the first and last cell reach as far outwards as inwards
        if index == 0 {
            from = 2.0 * motion.turn_deg - to;
        }
        if index + 1 == snapshots.len() {
            to = 2.0 * motion.turn_deg - from;
        }
        for (&point, &force) in motion.back_rope_m.iter().zip(&motion.back_contact_n) {
            let force = f64::from(force);
            let psi_deg = arc_deg(machine, motion, point);
            if psi_deg.is_finite() && force.is_finite() && force > 0.0 {
                cells.push(Cell {
                    turn_deg: (from, to),
                    psi_deg,
                    force: 1e-3 * force / machine.ropes.cylinder_length_m,
                });
            }
        }
    }
    cells
}

/// Draws the contact map; `None` without snapshots or without contact.
pub(super) fn contact(machine: &Machine, simulation: &Simulation) -> Option<Figure> {
    let half_deg =
        0.5 * (machine.ropes.cylinder_length_m / machine.back_head.radius_m).to_degrees();
    let cells = cells(machine, simulation);
    let mut sorted: Vec<f64> = cells.iter().map(|cell| cell.force).collect();
    sorted.sort_by(f64::total_cmp);
    // a few cylinders may carry many times the rest: saturate, and say so
    let top = quantile::of(&sorted, 98).filter(|&top| top > 0.0)?;
    let angles = cells
        .iter()
        .flat_map(|cell| [cell.psi_deg - half_deg, cell.psi_deg + half_deg]);
    let axis = revolution::axis();
    let panel = Panel {
        left: 62.0,
        top: 14.0,
        width: WIDTH - 62.0 - 110.0,
        height: HEIGHT - 14.0 - 46.0,
        x: axis.scale,
        y: AxisScale::linear(angles, 6.0),
    };
    let title = "Contact of the back rope on its head";
    let svg = render((WIDTH, HEIGHT), title, |canvas| {
        for cell in &cells {
            let (left, upper) = panel.at((cell.turn_deg.0, cell.psi_deg + half_deg));
            let (right, lower) = panel.at((cell.turn_deg.1, cell.psi_deg - half_deg));
            // neighbours overlap a little: touching edges would let the paper shine through
            canvas.rectangle(
                (left, upper - OVERLAP),
                ((right + OVERLAP).min(panel.right()), lower),
                STRENGTH.at(cell.force / top),
            );
        }
        panel.left_axis(canvas, true, "angle on the arc, beam frame [deg]");
        panel.lower_axis(canvas, true, &axis.title);
        ramp(canvas, &panel, top);
    });
    Some(Figure {
        name: "contact".to_owned(),
        caption: format!(
            "{title}: force per length of rope over crank angle and place on the arc (as seen \
             from its centre, in the beam frame). The scale ends at the 98 % quantile; the darkest \
             cells may carry more."
        ),
        svg,
    })
}

/// Draws the colour scale next to the map.
fn ramp(canvas: &mut Canvas, panel: &Panel, top: f64) {
    const STEPS: i32 = 48;
    let bar = Panel {
        left: panel.right() + 22.0,
        width: 12.0,
        top: panel.top + 24.0,
        height: panel.height - 24.0,
        x: AxisScale::between(0.0, 1.0, 1.0),
        y: AxisScale::between(0.0, top, 5.0),
    };
    let step = 1.0 / f64::from(STEPS);
    for index in 0..STEPS {
        let share = f64::from(index) * step;
        let (left, upper) = bar.at((0.0, (share + step) * top));
        canvas.rectangle(
            (left, upper - OVERLAP),
            bar.at((1.0, share * top)),
            STRENGTH.at(share),
        );
    }
    let head = TextStyle::new(10.5, GREY);
    canvas.text((bar.left - 4.0, panel.top + 8.0), "kN per metre", head);
    let label = TextStyle::new(10.5, INK);
    for tick in bar.y.ticks() {
        canvas.text(
            (bar.right() + 5.0, bar.at_y(tick.value)),
            &tick.label,
            label,
        );
    }
}
