//! Parallel coordinates of the individuals of a search: one vertical axis for each unknown between its bounds and
//! one for the objective, and one line for each individual, coloured by its rank.
use super::canvas::{Canvas, Pen, TextStyle, WIDTH, render};
use super::scale::AxisScale;
use crate::color::{AXIS, GREY, INK, STRENGTH, VERMILLION};
use crate::data::{Calibration, HistoryPoint};
use crate::document::Figure;
use crate::number::{count, significant, unit};
use crate::words::objective_heading;
use protocol::case::{Scale, Unknown};

const LEFT: f64 = 70.0;
const RIGHT: f64 = 70.0;
const TOP: f64 = 44.0;
const HEIGHT: f64 = 230.0;
const BOTTOM: f64 = 30.0;
/// Shade of the worst individual on the scale of strength, so that it can still be seen.
const PALEST: f64 = 0.15;

/// Draws the individuals of a search with the indices `chosen`, worst first; `None` if none of them completed.
pub(crate) fn parallel(calibration: &Calibration, chosen: &[usize]) -> Option<Figure> {
    let history = &calibration.history;
    let complete = chosen.iter().filter_map(|index| history.get(*index));
    let complete = complete.filter(|point| point.complete && point.fitness.is_finite());
    let complete: Vec<&HistoryPoint> = complete.collect();
    let (best, others) = complete.split_last()?;
    let unknowns = &calibration.case.unknowns;
    let scales: Vec<AxisScale> = unknowns.iter().map(scale).collect();
    let worst = complete.first().map_or(best.fitness, |point| point.fitness);
    // a single value still needs room around it
    let objective = if best.fitness > 0.0 && worst > best.fitness {
        AxisScale::logarithmic_between(best.fitness, worst)
    } else {
        AxisScale::logarithmic([best.fitness, worst])
    };
    let between = (WIDTH - LEFT - RIGHT) / unknowns.len().max(1) as f64;
    let x = |axis: usize| LEFT + axis as f64 * between;
    let y = |share: f64| TOP + HEIGHT * (1.0 - share);
    let line = |point: &HistoryPoint| -> Vec<(f64, f64)> {
        let genes = point.genes.iter().zip(&scales).enumerate();
        let mut line: Vec<_> = genes
            .map(|(axis, (gene, scale))| (x(axis), y(scale.share(*gene))))
            .collect();
        line.push((x(unknowns.len()), y(objective.share(point.fitness))));
        line
    };
    let title = "Individuals in parallel coordinates";
    let svg = render((WIDTH, TOP + HEIGHT + BOTTOM), title, |canvas| {
        for (rank, point) in others.iter().enumerate() {
            let share = rank as f64 / others.len() as f64;
            let color = STRENGTH.at(PALEST + (1.0 - PALEST) * share);
            canvas.line(&line(point), Pen::new(color, 0.5));
        }
        canvas.line(&line(best), Pen::new(VERMILLION, 1.8));
        for (axis, unknown) in unknowns.iter().enumerate() {
            let heading = format!("{} [{}]", unknown.name, unit(&unknown.unit));
            let ends = [unknown.lower, unknown.upper];
            draw_axis(canvas, x(axis), &heading, ends);
        }
        let (low, high) = objective.ends();
        let heading = objective_heading(&calibration.case);
        draw_axis(canvas, x(unknowns.len()), &heading, [low, high]);
    });
    let sample = if history.len() > chosen.len() {
        format!(
            " The best ones and an even selection of the others, {} of {}.",
            count(chosen.len() as u64),
            count(history.len() as u64)
        )
    } else {
        String::new()
    };
    Some(Figure {
        name: "parallel_coordinates".to_owned(),
        caption: format!(
            "{title}: each line is one individual that completed, from the value of each unknown between its \
             bounds to the objective; the darker, the better, and the best one is coloured. Lines that meet at an \
             axis show an unknown that the record determines.{sample}"
        ),
        svg,
    })
}

fn scale(unknown: &Unknown) -> AxisScale {
    match unknown.scale {
        Scale::Logarithmic => AxisScale::logarithmic_between(unknown.lower, unknown.upper),
        Scale::Linear => AxisScale::between(unknown.lower, unknown.upper, 3.0),
    }
}

fn draw_axis(canvas: &mut Canvas, x: f64, heading: &str, [low, high]: [f64; 2]) {
    canvas.line(&[(x, TOP), (x, TOP + HEIGHT)], Pen::new(AXIS, 0.8));
    let (name, rest) = heading.split_once(' ').unwrap_or((heading, ""));
    let above = TextStyle::new(11.0, INK).centered().bold();
    canvas.text((x, TOP - 32.0), name, above);
    canvas.text((x, TOP - 20.0), rest, TextStyle::new(9.5, GREY).centered());
    let end = TextStyle::new(9.5, GREY).centered();
    canvas.text((x, TOP - 8.0), &significant(high), end);
    canvas.text((x, TOP + HEIGHT + 10.0), &significant(low), end);
}
