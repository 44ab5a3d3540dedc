//! Dynamometer card: load at the suspension point over its simulated position.
use crate::chart::canvas::{Pen, TextStyle, render};
use crate::chart::panel::Panel;
use crate::chart::scale::AxisScale;
use crate::color::{GREY, INK, VERMILLION};
use crate::document::Figure;
use crate::words::condition_name;
use protocol::{
    case::Case,
    pumping_unit::{LoadCard, Machine, Simulation},
};
use support::interpolation::periodic;

const SIZE: (f64, f64) = (620.0, 330.0);

/// Interpolates the load of a periodic dynamometer card at a crank angle \[N\].
fn load_n(card: &LoadCard, turn_deg: f64) -> Option<f64> {
    periodic(&card.turn_deg, &card.load_n, turn_deg, 360.0)
}

/// Draws the dynamometer card; `None` if the simulation has fewer than two positions of the suspension point.
pub(super) fn card(
    (case, machine): (&Case, &Machine),
    condition: usize,
    simulation: &Simulation,
) -> Option<Figure> {
    let found = machine.conditions.get(condition)?;
    let rows: Vec<_> = simulation
        .turn_deg
        .iter()
        .zip(&simulation.suspension_m)
        .filter_map(|(&turn, &height)| {
            let load = load_n(&found.card, turn)?;
            height.is_finite().then_some((turn, height, 1e-3 * load))
        })
        .collect();
    if rows.len() < 2 {
        return None;
    }
    let name = condition_name(case, condition);
    let title = format!("Dynamometer card, condition {name}");
    let panel = Panel {
        left: 62.0,
        top: 16.0,
        width: SIZE.0 - 62.0 - 24.0,
        height: SIZE.1 - 16.0 - 46.0,
        x: AxisScale::linear(rows.iter().map(|row| row.1), 6.0),
        y: AxisScale::linear(rows.iter().map(|row| row.2), 5.0),
    };
    let svg = render(SIZE, &title, |canvas| {
        panel.guides(canvas);
        let mut path: Vec<_> = rows.iter().map(|row| (row.1, row.2)).collect();
        let whole = rows.last().is_some_and(|row| row.0 > 355.0);
        if whole && let Some(&first) = path.first() {
            path.push(first);
        }
        let pen = Pen::new(VERMILLION, 1.4);
        panel.curve(canvas, &path, pen);
        let (x0, x1) = panel.x.ends();
        let (y0, y1) = panel.y.ends();
        let middle = panel.at((0.5 * (x0 + x1), 0.5 * (y0 + y1)));
        for mark in [0.0, 60.0, 120.0, 180.0, 240.0, 300.0] {
            let Some(row) = rows.iter().find(|row| row.0 >= mark) else {
                continue;
            };
            let (x, y) = panel.at((row.1, row.2));
            canvas.dot((x, y), 2.6, INK);
            // outside the loop, away from its middle
            let (dx, dy) = (x - middle.0, y - middle.1);
            let away = 15.0 / dx.hypot(dy).max(1.0);
            let lettering = TextStyle::new(10.0, GREY).centered();
            let at = (x + away * dx, y + away * dy);
            canvas.text(at, &format!("{mark:.0}°"), lettering);
        }
        panel.left_axis(canvas, true, "load [kN]");
        panel.lower_axis(canvas, true, "position of the suspension [m]");
    });
    Some(Figure {
        name: format!("card_{name}"),
        caption: format!(
            "{title}: prescribed load over the simulated position of the suspension; marks at \
             crank angles."
        ),
        svg,
    })
}
