//! Report section on the convergence of the search.
use crate::chart::canvas::{Canvas, Pen, TextStyle, WIDTH, render};
use crate::chart::panel::{Panel, spread};
use crate::chart::scale::AxisScale;
use crate::color::{BAND, GREY, INK, VERMILLION};
use crate::data::{Calibration, HistoryPoint};
use crate::document::{Block, Figure, Section, figures};
use crate::number::{count, duration, percent, significant};
use crate::words;
use crate::words::objective_heading;
use support::quantile;

pub(super) fn calibration(calibration: &Calibration) -> Section {
    let recommended = words::complete_objective(calibration);
    let searched = !calibration.history.is_empty();
    let drawn = searched.then(|| chart(calibration, recommended));
    let mut blocks = figures(drawn);
    // a search that goes on has no end
    if searched && !calibration.finish.is_empty() {
        blocks.insert(0, Block::Text(work(calibration)));
    }
    Section {
        id: "convergence",
        title: "Convergence of the population",
        blocks,
    }
}

/// Describes the work of a search and why it ended.
fn work(calibration: &Calibration) -> String {
    let history = &calibration.history;
    let failed = history.iter().filter(|point| !point.complete).count();
    format!(
        "{} evaluations, {} of which did not complete, in {}. The search ended because {}.",
        count(history.len() as u64),
        count(failed as u64),
        duration(calibration.wall_s),
        calibration.finish
    )
}

const LEFT: f64 = 62.0;
const RIGHT: f64 = 120.0;
const TOP: f64 = 16.0;
const MAIN: f64 = 230.0;
const STRIP_TOP: f64 = TOP + MAIN + 18.0;
const STRIP: f64 = 52.0;
const HEIGHT: f64 = STRIP_TOP + STRIP + 46.0;

/// Statistics of one generation of the search, or of several merged neighbouring generations.
struct Generation {
    from: f64,
    to: f64,
    /// Quantiles (10 %, 50 % and 90 %) of the objective of the complete individuals.
    quantiles: Option<[f64; 3]>,
    failed_share: f64,
}

/// Divides the evaluation log, in index order, into generations; neighbouring generations are merged so that
/// there are at most `most`.
fn generations(history: &[HistoryPoint], most: usize) -> Vec<Generation> {
    let mut stretches: Vec<(usize, usize)> = Vec::new();
    let mut start = 0;
    for end in 1..=history.len() {
        let ends = end == history.len() || history[end].generation != history[start].generation;
        if ends {
            stretches.push((start, end));
            start = end;
        }
    }
    let together = stretches.len().div_ceil(most).max(1);
    stretches
        .chunks(together)
        .filter_map(|chunk| Some((chunk.first()?.0, chunk.last()?.1)))
        .map(|(from, to)| {
            let members = &history[from..to];
            let mut complete: Vec<f64> = members
                .iter()
                .filter(|point| point.complete && point.fitness.is_finite())
                .map(|point| point.fitness)
                .collect();
            complete.sort_by(f64::total_cmp);
            let quantiles = [10, 50, 90].map(|percent| quantile::of(&complete, percent));
            let failed = members.iter().filter(|point| !point.complete).count();
            Generation {
                from: from as f64,
                to: to as f64,
                quantiles: match quantiles {
                    [Some(low), Some(median), Some(high)] => Some([low, median, high]),
                    _ => None,
                },
                failed_share: failed as f64 / members.len() as f64,
            }
        })
        .collect()
}

/// Returns the best objective of the complete individuals so far, as a step curve over the number of
/// evaluations.
fn best_so_far(history: &[HistoryPoint]) -> Vec<(f64, f64)> {
    let mut best = f64::INFINITY;
    let mut steps = Vec::new();
    for (index, point) in history.iter().enumerate() {
        if point.complete && point.fitness < best {
            if best.is_finite() {
                steps.push((index as f64 + 1.0, best));
            }
            best = point.fitness;
            steps.push((index as f64 + 1.0, best));
        }
    }
    if best.is_finite() {
        steps.push((history.len() as f64, best));
    }
    steps
}

/// Draws the convergence of a search whose starting point had the objective `recommended` (`None` if it did
/// not complete).
pub(crate) fn chart(
    Calibration { case, history, .. }: &Calibration,
    recommended: Option<f64>,
) -> Figure {
    let generations = generations(history, 400);
    let best = best_so_far(history);
    let quantiles = generations.iter().filter_map(|g| g.quantiles).flatten();
    let panel = Panel {
        left: LEFT,
        top: TOP,
        width: WIDTH - LEFT - RIGHT,
        height: MAIN,
        x: AxisScale::between(0.0, history.len().max(1) as f64, 8.0),
        y: AxisScale::logarithmic(
            quantiles
                .chain(best.iter().map(|&(_, f)| f))
                .chain(recommended),
        ),
    };
    let strip = Panel {
        top: STRIP_TOP,
        height: STRIP,
        y: AxisScale::between(0.0, 100.0, 2.0),
        ..panel
    };
    let title = "Convergence of the population";
    let svg = render((WIDTH, HEIGHT), title, |canvas| {
        panel.guides(canvas);
        population(canvas, &panel, &generations);
        panel.curve(canvas, &best, Pen::new(VERMILLION, 1.8));
        labels(canvas, &panel, &generations, &best, recommended);
        if best.is_empty() {
            panel.remark(canvas, "no individual completed");
        }
        panel.left_axis(canvas, true, &objective_heading(case));
        panel.lower_axis(canvas, false, "");
        for generation in &generations {
            canvas.rectangle(
                strip.at((generation.from, 100.0 * generation.failed_share)),
                strip.at((generation.to, 0.0)),
                BAND,
            );
        }
        strip.left_axis(canvas, true, "failed [%]");
        strip.lower_axis(canvas, true, "evaluations, in index order");
        let failed = history.iter().filter(|point| !point.complete).count();
        let share = failed as f64 / history.len().max(1) as f64;
        let text = format!("{} in all", percent(share));
        canvas.text(
            (strip.right() + 7.0, strip.top + 0.5 * STRIP),
            &text,
            TextStyle::new(11.0, GREY),
        );
    });
    Figure {
        name: "convergence".to_owned(),
        caption: format!(
            "{title} over {} evaluations: best individual so far, and per generation or stage of the search the median \
             of the complete individuals with the band from their 10 % to their 90 % quantile. \
             Below, the share of each that did not complete.",
            count(history.len() as u64)
        ),
        svg,
    }
}

/// Draws median and quantile band of the population's objective as steps, one per generation.
fn population(canvas: &mut Canvas, panel: &Panel, generations: &[Generation]) {
    let mut band = Vec::new();
    let mut median = Vec::new();
    for generation in generations {
        let [low, middle, high] = generation.quantiles.unwrap_or([f64::NAN; 3]);
        for x in [generation.from, generation.to] {
            band.push((x, low, high));
            median.push((x, middle));
        }
    }
    panel.band(canvas, &band, BAND);
    let pen = Pen::new(INK, 1.0);
    panel.curve(canvas, &median, pen);
}

/// Draws the labels of the convergence curves at the right edge.
fn labels(
    canvas: &mut Canvas,
    panel: &Panel,
    generations: &[Generation],
    best: &[(f64, f64)],
    recommended: Option<f64>,
) {
    let mut labels = Vec::new();
    if let Some(&(_, value)) = best.last() {
        labels.push((value, format!("best {}", significant(value)), VERMILLION));
    }
    if let Some([_, value, _]) = generations.iter().rev().find_map(|g| g.quantiles) {
        labels.push((value, "median".to_owned(), INK));
    }
    if let Some(value) = recommended.filter(|value| value.is_finite() && *value > 0.0) {
        let y = panel.at_y(value);
        let pen = Pen::new(GREY, 0.8);
        canvas.dashed((panel.left, y), (panel.right(), y), pen);
        labels.push((value, format!("recommended {}", significant(value)), GREY));
    }
    let wanted: Vec<_> = labels.iter().map(|label| panel.at_y(label.0)).collect();
    let places = spread(&wanted, 13.0, panel.top, panel.bottom());
    for ((_, text, color), y) in labels.iter().zip(places) {
        let lettering = TextStyle::new(11.0, *color);
        canvas.text((panel.right() + 7.0, y), text, lettering);
    }
}

#[cfg(test)]
mod tests {
    use super::{best_so_far, generations};
    use crate::data::HistoryPoint;

    fn log() -> Vec<HistoryPoint> {
        let fitness = [9.0, 1e6, 4.0, 7.0, 3.0, 1e6, 1e6, 5.0];
        (0..)
            .zip(fitness)
            .map(|(id, fitness)| HistoryPoint {
                id,
                generation: u32::from(id >= 4),
                purpose: String::new(),
                genes: Vec::new(),
                fitness,
                complete: fitness < 1e6,
                failure: None,
                cost: None,
            })
            .collect()
    }

    #[test]
    fn the_best_only_falls_and_ignores_failures() {
        let mut log = log();
        // a failed individual with a small graded value is still not a solution
        log[1].fitness = 0.1;
        let steps = [
            (1.0, 9.0),
            (3.0, 9.0),
            (3.0, 4.0),
            (5.0, 4.0),
            (5.0, 3.0),
            (8.0, 3.0),
        ];
        assert_eq!(best_so_far(&log), steps);
    }

    #[test]
    fn generations_have_their_own_median_and_failed_share() {
        let log = log();
        let found = generations(&log, 10);
        let medians: Vec<_> = found.iter().map(|g| g.quantiles.map(|q| q[1])).collect();
        let failed: Vec<_> = found.iter().map(|g| g.failed_share).collect();
        assert_eq!(medians, [Some(7.0), Some(3.0)]);
        assert_eq!(failed, [0.25, 0.5]);
        assert_eq!(generations(&log, 1).len(), 1);
        assert!(generations(&[], 10).is_empty());
    }
}
