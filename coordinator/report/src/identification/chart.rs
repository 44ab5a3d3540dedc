//! Figures of an identification: likelihood profiles of the unknowns and prediction bands.
use super::subject::IdentificationInput;
use crate::{
    chart::{
        ChartAxis,
        canvas::{Canvas, Pen, TextStyle, WIDTH, render},
        panel::Panel,
        scale::AxisScale,
        strip::{Strip, curve, stack, strip},
    },
    color::{AXIS, BAND, INK, VERMILLION},
    document::Figure,
    number::{significant, unit},
    words::{condition_name, with_unit},
};
use discrepancy::identify::UnknownEstimate;
use protocol::case;

const COLUMNS: usize = 5;
const LEFT: f64 = 48.0;
const BETWEEN: f64 = 28.0;
const TOP: f64 = 8.0;
const ROW: f64 = 150.0;
const PLOT: f64 = 84.0;
/// Rise of `-2 ln L` at the ends of a 95 % interval (3.84), and the largest rise that is drawn.
const RISE: f64 = 3.84;
const HIGHEST: f64 = 8.0;

/// Draws one small panel per unknown: the rise of `-2 ln L` over its value, between its bounds.
pub(super) fn profiles(subject: &IdentificationInput<'_>) -> Figure {
    let all = &subject.identified.unknowns;
    let rows = all.len().div_ceil(COLUMNS).max(1);
    let width = (WIDTH - LEFT - 12.0 - BETWEEN * (COLUMNS - 1) as f64) / COLUMNS as f64;
    let title = "Profiles of the unknowns between their bounds";
    let svg = render((WIDTH, TOP + rows as f64 * ROW), title, |canvas| {
        for (index, own) in all.iter().enumerate() {
            let Some(unknown) = subject.unknown(&own.name) else {
                continue;
            };
            let bounds = [unknown.lower, unknown.upper];
            let panel = Panel {
                left: LEFT + (index % COLUMNS) as f64 * (width + BETWEEN),
                top: TOP + (index / COLUMNS) as f64 * ROW + 18.0,
                width,
                height: PLOT,
                x: match unknown.scale {
                    case::Scale::Logarithmic => AxisScale::logarithmic(bounds),
                    case::Scale::Linear => AxisScale::linear(bounds, 3.0),
                },
                y: AxisScale::between(0.0, HIGHEST, 4.0),
            };
            one(canvas, &panel, own, index.is_multiple_of(COLUMNS));
        }
    });
    Figure {
        name: "profiles".to_owned(),
        caption: format!(
            "{title}: rise of -2 ln L with all else refitted; the interval ends where it passes 3.84 (dashed). \
             Grey: the interval; a profile that stays low to a bound is open there."
        ),
        svg,
    }
}

fn one(canvas: &mut Canvas, panel: &Panel, own: &UnknownEstimate, first: bool) {
    let (left, right) = panel.x.ends();
    let low = own.interval[0].unwrap_or(left);
    let high = own.interval[1].unwrap_or(right);
    let from = (panel.at_x(low), panel.top);
    canvas.rectangle(from, (panel.at_x(high), panel.bottom()), BAND);
    let y = panel.at_y(RISE);
    canvas.dashed((panel.left, y), (panel.right(), y), Pen::new(AXIS, 0.7));
    let points = own.profile.iter();
    let points: Vec<(f64, f64)> = points
        .filter(|[_, rise]| *rise <= HIGHEST)
        .map(|[x, rise]| (*x, *rise))
        .collect();
    panel.curve(canvas, &points, Pen::new(INK, 0.9));
    for point in &points {
        canvas.dot(panel.at(*point), 1.4, INK);
    }
    canvas.dot(panel.at((own.value, 0.0)), 3.5, VERMILLION);
    let name = TextStyle::new(11.5, INK).bold().above();
    canvas.text((panel.left, panel.top - 5.0), &own.name, name);
    let text = TextStyle::new(10.5, VERMILLION).right().above();
    canvas.text(
        (panel.right(), panel.top - 5.0),
        &significant(own.value),
        text,
    );
    panel.left_axis(canvas, first, if first { "rise" } else { "" });
    panel.lower_axis(canvas, true, &unit(&own.unit));
}

/// Draws the prediction bands of all channels, one figure per condition and abscissa.
pub(super) fn bands(subject: &IdentificationInput<'_>) -> Vec<Figure> {
    let case = subject.case;
    let figures = subject.identified.bands.iter().flat_map(|band| {
        let condition = condition_name(case, band.condition);
        let all: Vec<_> = case.channels_of(band.condition).zip(&band.channels).collect();
        let mut kinds: Vec<&case::Abscissa> = Vec::new();
        for ((_, channel), _) in &all {
            if !kinds.contains(&&channel.abscissa) {
                kinds.push(&channel.abscissa);
            }
        }
        let figure = |(at, abscissa): (usize, &case::Abscissa)| {
            let own = all.iter().filter(|((_, channel), _)| channel.abscissa == *abscissa);
            let strips = own.map(|((_, channel), values)| {
                let points = &abscissa.points;
                let rows = points.iter().zip(values.low.iter().zip(&values.high));
                let likeliest = curve("", VERMILLION, points, &values.likeliest, 1.0);
                Strip {
                    band: rows.map(|(x, (low, high))| (*x, *low, *high)).collect(),
                    ..strip(with_unit(&channel.title, &channel.unit), 96.0, vec![likeliest])
                }
            });
            let strips: Vec<Strip> = strips.collect();
            stack(
                format!("prediction_{condition}_{}", at + 1),
                &format!("Prediction under condition {condition}"),
                format!(
                    "What the fit predicts under condition {condition}, and (grey) how far the record leaves it \
                     open at 95 %. Where no grey shows, it is narrower than the line."
                ),
                &ChartAxis::of(case, abscissa),
                &strips,
            )
        };
        kinds.into_iter().enumerate().map(figure).collect::<Vec<_>>()
    });
    figures.collect()
}
