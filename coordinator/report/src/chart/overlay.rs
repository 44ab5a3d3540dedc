//! Measured against simulated curves of one channel, recommended beside optimised parameters on shared
//! scales, with the residual below (paper, Figs. 7, 9 and 10).
use super::{
    axis::ChartAxis,
    before_after::{BeforeAfter, before_after},
    canvas::{Canvas, Pen, TextStyle, WIDTH, render},
    panel::Panel,
    points::points,
    scale::AxisScale,
};
use crate::{
    color::{BAND, GREY, INK, VERMILLION},
    data::{ConditionResult, ScoredCurves},
    document::Figure,
    number::{percent, significant, unit},
    words,
};
use protocol::case::{Case, Channel, ChannelRecord, Offset};
use protocol::job::{ChannelScore, Verdict};

const LEFT: f64 = 62.0;
const BETWEEN: f64 = 26.0;
const TOP: f64 = 62.0;
const VALUES_HEIGHT: f64 = 200.0;
const RESIDUAL_TOP: f64 = TOP + VALUES_HEIGHT + 16.0;
const RESIDUAL_HEIGHT: f64 = 62.0;
const HEIGHT: f64 = RESIDUAL_TOP + RESIDUAL_HEIGHT + 42.0;

/// Simulated curve and residual of one parameter set (recommended or optimised).
struct Side {
    heading: &'static str,
    remark: String,
    simulated: Vec<(f64, f64)>,
    residual: Vec<(f64, f64)>,
}

/// Returns the constant offset by which the objective shifts a simulated curve before comparing it with the
/// measured one; 0 unless the offset is free.
const fn shift(offset: Offset, score: Option<&ChannelScore>) -> f64 {
    match (offset, score) {
        (Offset::Free, Some(score)) if score.offset.is_finite() => score.offset,
        (Offset::Free | Offset::Fixed, _) => 0.0,
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

fn extremes(values: &[f64]) -> (f64, f64) {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    (low, high)
}

impl Side {
    fn new(
        heading: &'static str,
        (run, values): (&ScoredCurves, &[f64]),
        (at, channel): (usize, &Channel),
        record: &ChannelRecord,
    ) -> Self {
        let grid = &channel.abscissa.points;
        let mut scores = run.evaluation.channels.iter();
        let score = scores.find(|score| score.channel == at);
        let complete = run.curves.verdict == Verdict::Complete;
        let shift = match (channel.offset, score) {
            (Offset::Free, None) if complete => mean(&record.mean) - mean(values),
            (offset, score) => shift(offset, score),
        };
        let simulated = points(grid, values)
            .into_iter()
            .map(|(x, y)| (x, y + shift))
            .collect();
        // measured and simulated values stand at the same places
        let rows = grid.iter().zip(record.mean.iter().zip(values));
        let residual: Vec<(f64, f64)> = rows
            .map(|(&x, (measured, simulated))| (x, measured - simulated - shift))
            .collect();
        let remark = match (run.curves.verdict, score) {
            (verdict @ Verdict::Failed { .. }, _) => {
                format!("{}; not shifted", words::verdict(&verdict))
            }
            (Verdict::Complete, score) => {
                let unit = unit(&channel.unit);
                let squares: Vec<f64> = residual.iter().map(|(_, y)| y * y).collect();
                let rms = score
                    .map_or_else(|| mean(&squares), |score| score.mse)
                    .sqrt();
                let (low, high) = extremes(&record.mean);
                let share = score.map_or_else(
                    || 2.0 * rms / (high - low),
                    |score| score.rmse_over_half_range,
                );
                format!(
                    "rms error {} {unit}, {} of half the range; shifted by {} {unit}",
                    significant(rms),
                    percent(share),
                    significant(shift),
                )
            }
        };
        Self {
            heading,
            remark,
            simulated,
            residual,
        }
    }
}

/// Draws the measured over the simulated curves of the channel with index `at` in the case, under the
/// result's condition; `None` if the channel was not measured.
pub fn overlay(case: &Case, result: &ConditionResult, at: usize) -> Option<Figure> {
    let condition = case.conditions.get(result.condition)?;
    let channel = case.channels.get(at)?;
    let record = channel.record.as_ref()?;
    let sides = [
        ("Recommended parameters", &result.recommended),
        ("Optimised parameters", &result.optimised),
    ]
    .map(|(heading, run)| {
        let values = run.shown(case, result.condition).channel(channel);
        Side::new(heading, (run, values), (at, channel), record)
    });
    let cycles = record.cycles;
    let grid = &channel.abscissa.points;
    let band: Vec<_> = grid
        .iter()
        .zip(record.mean.iter().zip(&record.spread))
        .map(|(&x, (&mean, &spread))| (x, mean - spread, mean + spread))
        .collect();
    let curves = sides.iter().flat_map(|side| &side.simulated);
    let values = AxisScale::linear(
        curves
            .map(|&(_, y)| y)
            .chain(band.iter().flat_map(|&(_, low, high)| [low, high])),
        5.0,
    );
    let residuals = sides.iter().flat_map(|side| &side.residual);
    let residuals = AxisScale::symmetric(residuals.map(|&(_, y)| y));
    let heading = words::capitalised(&channel.title);
    let title = format!("{heading}, condition {}", condition.name);
    let measured = Measured {
        mean: points(grid, &record.mean),
        band,
        values,
        residuals,
        axis: ChartAxis::of(case, &channel.abscissa),
        unit: unit(&channel.unit),
    };
    let svg = render((WIDTH, HEIGHT), &title, |canvas| {
        key(canvas, &heading, cycles);
        let [recommended, optimised] = &sides;
        column(canvas, &measured, recommended, true);
        column(canvas, &measured, optimised, false);
    });
    let free = match channel.offset {
        Offset::Free => {
            " Complete simulated curves are shifted to the measured mean, because the sensor has no \
             absolute zero."
        }
        Offset::Fixed => "",
    };
    Some(Figure {
        name: format!("overlay_{}_{}", condition.name, channel.name),
        caption: format!(
            "{title}: measured and simulated, on shared scales; below, \
             measured minus simulated.{free}"
        ),
        svg,
    })
}

/// Draws the fitted channels of a result's condition with the recommended and the optimised parameters on one pair
/// of axes each; `None` if none of them was measured.
pub(crate) fn fitted(case: &Case, result: &ConditionResult) -> Option<Figure> {
    let condition = words::condition_name(case, result.condition);
    let measured = case.measured(result.condition);
    let channels: Vec<_> = measured
        .filter(|(_, channel, _)| case.objective.names(&channel.name))
        .collect();
    let axes = channels
        .iter()
        .map(|(_, channel, _)| ChartAxis::of(case, &channel.abscissa));
    let axes: Vec<ChartAxis> = axes.collect();
    let shifted = |run: &ScoredCurves, at: usize, channel: &Channel| -> Vec<f64> {
        let score = run.evaluation.channels.iter().find(|own| own.channel == at);
        let shift = shift(channel.offset, score);
        let curve = run.shown(case, result.condition).channel(channel);
        curve.iter().map(|value| value + shift).collect()
    };
    let drawn = channels.iter().zip(&axes);
    let drawn: Vec<BeforeAfter<'_>> = drawn
        .map(|(&(at, channel, record), axis)| BeforeAfter {
            title: format!(
                "{}, condition {condition}",
                words::capitalised(&channel.title)
            ),
            unit: unit(&channel.unit),
            at: &channel.abscissa.points,
            axis,
            measured: &record.mean,
            spread: &record.spread,
            before: shifted(&result.recommended, at, channel),
            after: Some(shifted(&result.optimised, at, channel)),
        })
        .collect();
    before_after(
        &drawn,
        ["recommended parameters", "optimised parameters"],
        "The fitted channels: measured, and simulated with the recommended and with the optimised parameters; below, measured \
         minus simulated."
            .to_owned(),
    )
}

struct Measured {
    mean: Vec<(f64, f64)>,
    /// Band of the measured spread, as points (abscissa, lower end, upper end).
    band: Vec<(f64, f64, f64)>,
    values: AxisScale,
    residuals: AxisScale,
    axis: ChartAxis,
    unit: String,
}

/// Draws the figure column of one parameter set: measured and simulated curves above, residual below. Only
/// the first column labels its axes.
fn column(canvas: &mut Canvas, measured: &Measured, side: &Side, first: bool) {
    let width = 0.5 * (WIDTH - LEFT - BETWEEN - 10.0);
    let left = if first { LEFT } else { LEFT + width + BETWEEN };
    let panel = Panel {
        left,
        top: TOP,
        width,
        height: VALUES_HEIGHT,
        x: measured.axis.scale,
        y: measured.values,
    };
    let title = |what: &str| {
        if first {
            format!("{what} [{}]", measured.unit)
        } else {
            String::new()
        }
    };
    panel.guides(canvas);
    panel.band(canvas, &measured.band, BAND);
    panel.curve(canvas, &measured.mean, MEASURED);
    panel.curve(canvas, &side.simulated, SIMULATED);
    panel.left_axis(canvas, first, &title("measured and simulated"));
    panel.lower_axis(canvas, false, "");
    if side.simulated.len() < 2 {
        panel.remark(canvas, "no simulated curve: the run failed before it");
    }
    let heading = TextStyle::new(12.0, INK).bold();
    canvas.text((left, TOP - 27.0), side.heading, heading);
    canvas.text((left, TOP - 12.0), &side.remark, TextStyle::new(10.5, GREY));
    let strip = Panel {
        top: RESIDUAL_TOP,
        height: RESIDUAL_HEIGHT,
        y: measured.residuals,
        ..panel
    };
    strip.guides(canvas);
    strip.curve(canvas, &side.residual, RESIDUAL);
    strip.left_axis(canvas, first, &title("residual"));
    strip.lower_axis(canvas, true, &measured.axis.title);
}

const MEASURED: Pen = Pen::new(INK, 1.3);
const SIMULATED: Pen = Pen::new(VERMILLION, 1.1);
const RESIDUAL: Pen = Pen::new(INK, 0.8);

/// Draws the legend above the overlay's panels: each mark before its text, with room for the widest typeface,
/// since text widths are unknown here.
fn key(canvas: &mut Canvas, title: &str, cycles: usize) {
    const LETTER: f64 = 6.4;
    const MARK: f64 = 22.0;
    let y = 12.0;
    let heading = TextStyle::new(13.0, INK).bold();
    canvas.text((LEFT, y), title, heading);
    let measured = match cycles {
        0 | 1 => "measured, one cycle".to_owned(),
        _ => format!("measured, mean of {cycles} cycles ± one standard deviation"),
    };
    let text = TextStyle::new(10.5, INK);
    let place = |text: &str, right: f64| right - LETTER * text.chars().count() as f64;
    let x = place("simulated", WIDTH - 10.0);
    canvas.text((x, y), "simulated", text);
    canvas.line(&[(x - 6.0 - MARK, y), (x - 6.0, y)], SIMULATED);
    let x = place(&measured, x - MARK - 24.0);
    canvas.text((x, y), &measured, text);
    canvas.rectangle((x - 6.0 - MARK, y - 4.0), (x - 6.0, y + 4.0), BAND);
    canvas.line(&[(x - 6.0 - MARK, y), (x - 6.0, y)], MEASURED);
}

/// Draws every channel's measured over its simulated curves under a condition: the channels of the objective
/// first, then the other measured ones.
pub fn overlays(case: &Case, result: &ConditionResult) -> Vec<Figure> {
    let mut measured: Vec<_> = case.measured(result.condition).collect();
    measured.sort_by_key(|(_, channel, _)| !case.objective.names(&channel.name));
    let figures = measured.into_iter();
    figures
        .filter_map(|(at, ..)| overlay(case, result, at))
        .collect()
}
