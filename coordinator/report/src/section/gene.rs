//! Report section with figures of the objective over each gene (searched unknown), between the gene's bounds.
use crate::chart;
use crate::chart::canvas::{Canvas, Pen, TextStyle, WIDTH, render};
use crate::chart::panel::Panel;
use crate::chart::points::thinned;
use crate::chart::scale::AxisScale;
use crate::color::{AXIS, Color, GREY, INK, VERMILLION};
use crate::data::{Calibration, HistoryPoint};
use crate::document::{Figure, Section, figures};
use crate::number::{significant, unit};
use crate::words::objective_heading;
use protocol::case;

pub(super) fn calibration(calibration: &Calibration) -> Section {
    let searched = !calibration.history.is_empty();
    Section {
        id: "genes",
        title: "Genes between their bounds",
        blocks: if searched {
            let chosen = selection(&calibration.history, PARALLEL_ELITE, PARALLEL_MOST);
            let mut blocks = figures(chart::parallel(calibration, &chosen));
            blocks.extend(figures([genes(calibration)]));
            blocks
        } else {
            Vec::new()
        },
    }
}

const COLUMNS: usize = 5;
const LEFT: f64 = 62.0;
const BETWEEN: f64 = 28.0;
const TOP: f64 = 52.0;
const ROW: f64 = 178.0;
const PLOT: f64 = 104.0;
/// Maximum number of individuals drawn per gene, including the best ones.
const MOST: usize = 700;
/// Number of best individuals that are always drawn.
const ELITE: usize = 100;
/// Maximum number of individuals in parallel coordinates, including the best ones: all of most searches.
const PARALLEL_MOST: usize = 2000;
/// Number of best individuals that parallel coordinates always show.
const PARALLEL_ELITE: usize = 500;
const CLOUD: Color = Color(0x9a, 0xa3, 0xab);
const FAILED: Color = Color(0xd8, 0xd8, 0xd4);

/// Selects at most `most` individuals to show, as indices into the evaluation log, worst first: the `elite` best
/// ones and an even selection of the rest.
pub(super) fn selection(history: &[HistoryPoint], elite: usize, most: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..history.len()).collect();
    order.sort_by(|&a, &b| {
        let key = |index: usize| (!history[index].complete, history[index].fitness);
        let (failed_a, fitness_a) = key(a);
        let (failed_b, fitness_b) = key(b);
        failed_a
            .cmp(&failed_b)
            .then(fitness_a.total_cmp(&fitness_b))
    });
    let (best, rest) = order.split_at(order.len().min(elite));
    let mut chosen = best.to_vec();
    chosen.extend(thinned(rest, most - elite));
    chosen.reverse();
    chosen
}

/// Draws one small panel per gene: the objective of the individuals over the gene's value.
pub fn genes(calibration: &Calibration) -> Figure {
    let genes = &calibration.case.unknowns;
    let chosen = selection(&calibration.history, ELITE, MOST);
    let complete = calibration.history.iter().filter(|point| point.complete);
    let fitness = AxisScale::logarithmic(complete.map(|point| point.fitness));
    let rows = genes.len().div_ceil(COLUMNS).max(1);
    let height = TOP + rows as f64 * ROW;
    let width = (WIDTH - LEFT - 12.0 - BETWEEN * (COLUMNS - 1) as f64) / COLUMNS as f64;
    let title = "Genes between their bounds";
    let svg = render((WIDTH, height), title, |canvas| {
        key(canvas);
        for (index, gene) in genes.iter().enumerate() {
            let panel = Panel {
                left: LEFT + (index % COLUMNS) as f64 * (width + BETWEEN),
                top: TOP + (index / COLUMNS) as f64 * ROW + 18.0,
                width,
                height: PLOT,
                x: match gene.scale {
                    case::Scale::Logarithmic => AxisScale::logarithmic([gene.lower, gene.upper]),
                    case::Scale::Linear => AxisScale::linear([gene.lower, gene.upper], 3.0),
                },
                y: fitness,
            };
            small(canvas, &panel, calibration, index, &chosen);
        }
    });
    Figure {
        name: "genes".to_owned(),
        caption: format!(
            "{title}: objective over the value of each gene, on logarithmic axes{}; every panel \
             shows the same individuals. Individuals that failed are ticks along the upper edge{}.",
            if calibration.case.has_unknown_effects() {
                " (linear ones for parameters of effects)"
            } else {
                ""
            },
            if calibration.history.len() > MOST {
                format!(
                    " (the best {ELITE} and an even selection of the others, {MOST} of {} in all)",
                    calibration.history.len()
                )
            } else {
                String::new()
            }
        ),
        svg,
    }
}

/// Draws the panel of one gene: the objective of the individuals over the gene's value.
fn small(
    canvas: &mut Canvas,
    panel: &Panel,
    calibration: &Calibration,
    index: usize,
    chosen: &[usize],
) {
    let gene = &calibration.case.unknowns[index];
    let bound = Pen::new(AXIS, 0.7);
    for value in [gene.lower, gene.upper] {
        let x = panel.at_x(value);
        canvas.dashed((x, panel.top), (x, panel.bottom()), bound);
    }
    let x = panel.at_x(gene.start);
    let pen = Pen::new(INK, 0.7);
    canvas.line(&[(x, panel.top), (x, panel.bottom())], pen);
    for &member in chosen {
        let point = &calibration.history[member];
        let Some(&value) = point.genes.get(index) else {
            continue;
        };
        let x = panel.at_x(value);
        if !x.is_finite() {
            continue;
        }
        if point.complete {
            let y = panel.at_y(point.fitness);
            if y.is_finite() {
                canvas.dot((x, y), 1.1, CLOUD);
            }
        } else {
            let pen = Pen::new(FAILED, 0.6);
            canvas.line(&[(x, panel.top - 5.0), (x, panel.top - 1.0)], pen);
        }
    }
    let best = calibration.optimised.genes.get(index).copied();
    let fitness = calibration
        .objective(|result| &result.optimised)
        .map(|(_, fitness)| fitness);
    if let (Some(value), Some(fitness)) = (best, fitness) {
        let at = panel.at((value, fitness));
        if at.0.is_finite() && at.1.is_finite() {
            canvas.dot(at, 4.0, VERMILLION);
        }
    }
    let name = TextStyle::new(11.5, INK).bold().above();
    let (heading, about) = match gene.of_effect() {
        Some((effect, parameter)) => (parameter, effect),
        None => (gene.name.as_str(), gene.title.as_str()),
    };
    canvas.text((panel.left, panel.top - 7.0), heading, name);
    let right = TextStyle::new(10.5, VERMILLION).right().above();
    let text = best.map_or_else(String::new, significant);
    canvas.text((panel.right(), panel.top - 7.0), &text, right);
    let first = index.is_multiple_of(COLUMNS);
    let objective = objective_heading(&calibration.case);
    panel.left_axis(canvas, first, if first { &objective } else { "" });
    let title = format!("{about} [{}]", unit(&gene.unit));
    panel.lower_axis(canvas, true, &title);
}

/// Draws the legend above the panels of the genes.
fn key(canvas: &mut Canvas) {
    let y = 14.0;
    let text = TextStyle::new(10.5, INK);
    let mut x = LEFT;
    canvas.dot((x + 4.0, y), 1.8, CLOUD);
    canvas.text((x + 13.0, y), "evaluated individual", text);
    x += 138.0;
    canvas.dot((x + 4.0, y), 4.0, VERMILLION);
    canvas.text((x + 13.0, y), "optimum", text);
    x += 78.0;
    let pen = Pen::new(INK, 0.7);
    canvas.line(&[(x + 4.0, y - 7.0), (x + 4.0, y + 7.0)], pen);
    canvas.text((x + 13.0, y), "recommended value", text);
    x += 130.0;
    let pen = Pen::new(AXIS, 0.7);
    canvas.dashed((x + 4.0, y - 7.0), (x + 4.0, y + 7.0), pen);
    canvas.text((x + 13.0, y), "bound of the search", text);
    x += 134.0;
    let pen = Pen::new(GREY, 0.6);
    canvas.line(&[(x + 4.0, y - 3.0), (x + 4.0, y + 3.0)], pen);
    canvas.text((x + 13.0, y), "failed", text);
}
