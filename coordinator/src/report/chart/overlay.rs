//! Measured against simulated stress at one gauge, recommended beside optimised on shared scales,
//! with the residual below (paper, Figs. 7, 9 and 10).
use super::canvas::{Canvas, Lettering, Pen, WIDTH, render};
use super::panel::{CRANK_TITLE, Panel};
use super::points::points;
use super::scale::Scale;
use crate::line::interpolated;
use crate::report::color::{BAND, GREY, INK, VERMILLION};
use crate::report::data::{ConditionResult, Run};
use crate::report::document::Figure;
use crate::report::number::{fixed, percent};
use crate::report::words;
use protocol::case::{Case, GaugeRecord, GaugeTrace, Offset};
use protocol::job::Verdict;

const LEFT: f64 = 58.0;
const BETWEEN: f64 = 26.0;
const TOP: f64 = 62.0;
const STRESS_HEIGHT: f64 = 200.0;
const RESIDUAL_TOP: f64 = TOP + STRESS_HEIGHT + 16.0;
const RESIDUAL_HEIGHT: f64 = 62.0;
const HEIGHT: f64 = RESIDUAL_TOP + RESIDUAL_HEIGHT + 42.0;

/// What is drawn of one parameter set.
struct Side {
    heading: &'static str,
    remark: String,
    simulated: Vec<(f64, f64)>,
    residual: Vec<(f64, f64)>,
}

/// Shift that the objective gives the simulated curve before it is compared [`MPa`].
fn shift_mpa(case: &Case, run: &Run, gauge: u8) -> f64 {
    let channel = run.evaluation.channels.iter().find(|c| c.gauge == gauge);
    match (case.objective.offset, channel) {
        (Offset::Free, Some(channel)) if channel.offset_mpa.is_finite() => channel.offset_mpa,
        (Offset::Free | Offset::Fixed, _) => 0.0,
    }
}

/// Simulated stress of a gauge by its number, 1 to 4.
fn stress(run: &Run, gauge: u8) -> &[f64] {
    usize::from(gauge)
        .checked_sub(1)
        .and_then(|index| run.simulation.gauge_mpa.get(index))
        .map_or(&[], Vec::as_slice)
}

impl Side {
    fn new(
        heading: &'static str,
        case: &Case,
        run: &Run,
        record: &GaugeRecord,
        trace: &GaugeTrace,
    ) -> Self {
        let turn = &run.simulation.turn_deg;
        let values = stress(run, trace.gauge);
        let shift = shift_mpa(case, run, trace.gauge);
        let simulated = points(turn, values)
            .into_iter()
            .map(|(x, y)| (x, y + shift))
            .collect();
        let residual = record
            .turn_deg
            .iter()
            .zip(&trace.mean_mpa)
            .map(|(&x, &measured)| {
                let simulated = interpolated(turn, values, x).unwrap_or(f64::NAN);
                (x, measured - simulated - shift)
            })
            .collect();
        let channel = run
            .evaluation
            .channels
            .iter()
            .find(|channel| channel.gauge == trace.gauge);
        let remark = match (run.simulation.verdict, channel) {
            (verdict @ Verdict::Failed { .. }, _) => {
                format!("{}; not shifted", words::verdict(&verdict))
            }
            (Verdict::Complete, Some(channel)) => format!(
                "rms error {} MPa, {} of half the range; shifted by {} MPa",
                fixed(channel.rmse_over_half_range * half_range(trace), 2),
                percent(channel.rmse_over_half_range),
                fixed(shift, 2),
            ),
            (Verdict::Complete, None) => String::new(),
        };
        Self {
            heading,
            remark,
            simulated,
            residual,
        }
    }
}

/// Half the range of the measured mean [`MPa`].
fn half_range(trace: &GaugeTrace) -> f64 {
    crate::report::number::range(trace.mean_mpa.iter().copied())
        .map_or(f64::NAN, |(low, high)| 0.5 * (high - low))
}

/// Draws the overlay of one gauge under one condition; none if the condition or its record does
/// not have it.
pub fn overlay(case: &Case, result: &ConditionResult, gauge: u8) -> Option<Figure> {
    let condition = case.conditions.get(result.condition)?;
    let record = condition.record.as_ref()?;
    let trace = record.gauges.iter().find(|trace| trace.gauge == gauge)?;
    let sides = [
        ("Recommended parameters", &result.recommended),
        ("Optimised parameters", &result.optimised),
    ]
    .map(|(heading, run)| Side::new(heading, case, run, record, trace));
    let cycles = record.cycles;
    let band: Vec<_> = record
        .turn_deg
        .iter()
        .zip(trace.mean_mpa.iter().zip(&trace.spread_mpa))
        .map(|(&x, (&mean, &spread))| (x, mean - spread, mean + spread))
        .collect();
    let curves = sides.iter().flat_map(|side| &side.simulated);
    let stresses = Scale::linear(
        curves
            .map(|&(_, y)| y)
            .chain(band.iter().flat_map(|&(_, low, high)| [low, high])),
        5.0,
    );
    let residuals = sides.iter().flat_map(|side| &side.residual);
    let residuals = Scale::symmetric(residuals.map(|&(_, y)| y));
    let title = format!("Stress at gauge {gauge}, condition {}", condition.name);
    let record = Measured {
        mean: points(&record.turn_deg, &trace.mean_mpa),
        band,
        stresses,
        residuals,
    };
    let svg = render((WIDTH, HEIGHT), &title, |canvas| {
        key(canvas, gauge, cycles);
        let [recommended, optimised] = &sides;
        column(canvas, &record, recommended, true);
        column(canvas, &record, optimised, false);
    });
    let free = match case.objective.offset {
        Offset::Free => {
            " Complete simulated curves are shifted to the measured mean, because a strain bridge \
             has no absolute zero."
        }
        Offset::Fixed => "",
    };
    Some(Figure {
        name: format!("stress_{}_gauge_{gauge}", condition.name),
        caption: format!(
            "{title}: measured and simulated over one crank revolution, on shared scales; below, \
             measured minus simulated.{free}"
        ),
        svg,
    })
}

/// The measured side of both columns, and the scales they share.
struct Measured {
    mean: Vec<(f64, f64)>,
    /// Rows of (crank angle, low, high).
    band: Vec<(f64, f64, f64)>,
    stresses: Scale,
    residuals: Scale,
}

/// One parameter set: stress above, residual below. Only the first column labels its scales.
fn column(canvas: &mut Canvas, measured: &Measured, side: &Side, first: bool) {
    let width = 0.5 * (WIDTH - LEFT - BETWEEN - 10.0);
    let left = if first { LEFT } else { LEFT + width + BETWEEN };
    let panel = Panel {
        left,
        top: TOP,
        width,
        height: STRESS_HEIGHT,
        x: Scale::crank(),
        y: measured.stresses,
    };
    let title = |title| if first { title } else { "" };
    panel.guides(canvas);
    panel.band(canvas, &measured.band, BAND);
    panel.curve(canvas, &measured.mean, MEASURED);
    panel.curve(canvas, &side.simulated, SIMULATED);
    panel.left_axis(canvas, first, title("stress [MPa]"));
    panel.lower_axis(canvas, false, "");
    if side.simulated.len() < 2 {
        panel.remark(canvas, "no simulated curve: the run failed before it");
    }
    let heading = Lettering::new(12.0, INK).bold();
    canvas.text((left, TOP - 27.0), side.heading, heading);
    canvas.text((left, TOP - 12.0), &side.remark, Lettering::new(10.5, GREY));
    let strip = Panel {
        top: RESIDUAL_TOP,
        height: RESIDUAL_HEIGHT,
        y: measured.residuals,
        ..panel
    };
    strip.guides(canvas);
    strip.curve(canvas, &side.residual, RESIDUAL);
    strip.left_axis(canvas, first, title("residual [MPa]"));
    strip.lower_axis(canvas, true, CRANK_TITLE);
}

const MEASURED: Pen = Pen::new(INK, 1.3);
const SIMULATED: Pen = Pen::new(VERMILLION, 1.1);
const RESIDUAL: Pen = Pen::new(INK, 0.8);

/// The key above both panels: each mark before its words, with room for the widest typeface, since the
/// width of a text is not known here.
fn key(canvas: &mut Canvas, gauge: u8, cycles: usize) {
    const LETTER: f64 = 6.4;
    const MARK: f64 = 22.0;
    let y = 12.0;
    let heading = Lettering::new(13.0, INK).bold();
    canvas.text((LEFT, y), &format!("Gauge {gauge}"), heading);
    let measured = match cycles {
        0 | 1 => "measured, one cycle".to_owned(),
        _ => format!("measured, mean of {cycles} cycles ± one standard deviation"),
    };
    let text = Lettering::new(10.5, INK);
    let place = |text: &str, right: f64| right - LETTER * text.chars().count() as f64;
    let x = place("simulated", WIDTH - 10.0);
    canvas.text((x, y), "simulated", text);
    canvas.line(&[(x - 6.0 - MARK, y), (x - 6.0, y)], SIMULATED);
    let x = place(&measured, x - MARK - 24.0);
    canvas.text((x, y), &measured, text);
    canvas.rectangle((x - 6.0 - MARK, y - 4.0), (x - 6.0, y + 4.0), BAND);
    canvas.line(&[(x - 6.0 - MARK, y), (x - 6.0, y)], MEASURED);
}

/// Every overlay of a condition: the objective's gauges first, then the others of the record.
pub fn overlays(case: &Case, result: &ConditionResult) -> Vec<Figure> {
    let condition = case.conditions.get(result.condition);
    let record = condition.and_then(|condition| condition.record.as_ref());
    let fitted: Vec<u8> = case.objective.gauges.iter().map(|&(g, _)| g).collect();
    let mut gauges: Vec<u8> = record.map_or_else(Vec::new, |record| {
        record.gauges.iter().map(|trace| trace.gauge).collect()
    });
    gauges.sort_by_key(|gauge| (!fitted.contains(gauge), *gauge));
    let figures = gauges.into_iter();
    figures
        .filter_map(|gauge| overlay(case, result, gauge))
        .collect()
}
