//! Speed-up of searches over the number of slots: one curve per search, beside the ideal line.
use super::canvas::{Pen, TextStyle, WIDTH, render};
use super::panel::Panel;
use super::scale::AxisScale;
use crate::color::{BLUE, Color, GREEN, GREY, INK, PURPLE, VERMILLION};
use crate::document::Figure;
use std::collections::BTreeMap;
use study::scaling::{ScalingRow, SlotMode};

const LEFT: f64 = 62.0;
const RIGHT: f64 = 210.0;
const TOP: f64 = 16.0;
const HEIGHT: f64 = 280.0;
const FOOT: f64 = 52.0;
const COLORS: [Color; 5] = [BLUE, VERMILLION, GREEN, PURPLE, INK];

/// Curves of a figure by search and workers.
type Curves = BTreeMap<(String, SlotMode), Vec<(f64, f64)>>;

/// Draws the speed-up of searches over the number of slots.
pub(crate) fn speed_up(rows: &[ScalingRow]) -> Figure {
    let mut curves = Curves::new();
    for row in rows {
        let curve = curves.entry((row.search(), row.how)).or_default();
        curve.push((row.slots as f64, row.speed_up));
    }
    let mut searches: Vec<String> = curves.keys().map(|(search, _)| search.clone()).collect();
    searches.dedup();
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
        for (index, ((search, how), curve)) in curves.iter_mut().enumerate() {
            curve.sort_by(|a, b| a.0.total_cmp(&b.0));
            let of = searches.iter().position(|own| own == search);
            let color = COLORS[of.unwrap_or(0) % COLORS.len()];
            let name = format!("{search}, {}", how.as_str());
            panel.curve(canvas, curve, Pen::new(color, 1.4));
            for point in curve.iter() {
                canvas.dot(panel.at(*point), 3.0, color);
            }
            let beside = (panel.right() + 12.0, TOP + 10.0 + 13.5 * index as f64);
            canvas.text(beside, &name, TextStyle::new(9.5, color));
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
