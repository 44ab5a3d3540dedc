//! Speed-up of searches over the number of slots: one curve per search, beside the ideal line.
use super::canvas::{Canvas, Pen, TextStyle, WIDTH, render};
use super::panel::Panel;
use super::scale::AxisScale;
use crate::color::{BLUE, Color, GREEN, GREY, PURPLE, VERMILLION};
use crate::document::Figure;
use std::collections::BTreeMap;
use study::scaling::ScalingRow;

const LEFT: f64 = 62.0;
const RIGHT: f64 = 210.0;
const TOP: f64 = 16.0;
const HEIGHT: f64 = 280.0;
const FOOT: f64 = 52.0;
const COLORS: [Color; 4] = [BLUE, VERMILLION, GREEN, PURPLE];

/// Draws the speed-up of searches over the number of slots.
pub(crate) fn speed_up(rows: &[ScalingRow]) -> Figure {
    let mut curves: BTreeMap<String, Vec<(f64, f64)>> = BTreeMap::new();
    for row in rows {
        let name = format!("{} {}, {}", row.preset, row.population, row.how.as_str());
        let curve = curves.entry(name).or_default();
        curve.push((row.slots as f64, row.speed_up));
    }
    let panel = Panel {
        left: LEFT,
        top: TOP,
        width: WIDTH - LEFT - RIGHT,
        height: HEIGHT,
        x: AxisScale::logarithmic(rows.iter().map(|row| row.slots as f64)),
        y: AxisScale::logarithmic(rows.iter().flat_map(|row| [row.slots as f64, row.speed_up])),
    };
    let title = "Speed-up over the slots";
    let svg = render((WIDTH, TOP + HEIGHT + FOOT), title, |canvas| {
        panel.guides(canvas);
        let (low, high) = panel.x.ends();
        canvas.dashed(
            panel.at((low, low)),
            panel.at((high, high)),
            Pen::new(GREY, 1.0),
        );
        for (index, (name, curve)) in curves.iter_mut().enumerate() {
            curve.sort_by(|a, b| a.0.total_cmp(&b.0));
            draw(canvas, &panel, (index, name), curve);
        }
        panel.left_axis(canvas, true, "speed-up");
        panel.lower_axis(canvas, true, "slots");
    });
    Figure {
        name: "speed_up".to_owned(),
        caption: format!("{title}; the dashed line is what it would be if no slot were ever idle."),
        svg,
    }
}

fn draw(canvas: &mut Canvas, panel: &Panel, (index, name): (usize, &str), curve: &[(f64, f64)]) {
    let color = COLORS[index % COLORS.len()];
    panel.curve(canvas, curve, Pen::new(color, 1.4));
    for point in curve {
        canvas.dot(panel.at(*point), 3.0, color);
    }
    let beside = (panel.right() + 12.0, TOP + 12.0 + 16.0 * index as f64);
    canvas.text(beside, name, TextStyle::new(10.5, color));
}
