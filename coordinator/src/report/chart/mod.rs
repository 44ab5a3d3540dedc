//! Figures as SVG: what is drawn, on one quiet style for screen and print.
//!
//! Measured is black on a grey band, simulated is vermillion: the pair stays apart for colour-blind
//! readers and on a grey printer. Text is text. Knows the report's data; knows nothing of HTML.
mod angle_map;
mod canvas;
mod card;
mod closing;
mod contact;
mod convergence;
mod gene;
mod head_modes;
mod joint;
mod latent_force;
mod order_map;
mod overlay;
mod panel;
mod revolution;
mod rows;
mod scale;
mod strip;
mod work;
mod worker;

pub use angle_map::angle_map;
pub use card::card;
pub use closing::{Closing, closing};
pub use contact::contact;
pub use convergence::convergence;
pub use gene::genes;
pub use head_modes::{HeadPicture, head_modes};
pub use joint::joints;
pub use latent_force::latent_forces;
pub use order_map::order_map;
pub use overlay::overlay;
pub(super) use revolution::player;
pub use revolution::{gauges, motion, tension, torque};
pub use work::work_precision;
pub use worker::workers;

use super::data::ConditionResult;
use plotters::drawing::DrawingAreaErrorKind;
use plotters::prelude::RGBColor;
use protocol::case::Case;
use protocol::job::Simulation;

/// Width of every full-width figure [px].
const WIDTH: f64 = 960.0;
/// Text and measured curves.
const INK: RGBColor = RGBColor(0x22, 0x22, 0x22);
/// Secondary text.
const GREY: RGBColor = RGBColor(0x6b, 0x6b, 0x6b);
/// Axes.
const AXIS: RGBColor = RGBColor(0x55, 0x55, 0x55);
/// Guide lines behind curves.
const GUIDE: RGBColor = RGBColor(0xe9, 0xe9, 0xe6);
/// Bands of spread.
const BAND: RGBColor = RGBColor(0xd3, 0xd3, 0xd0);
/// Simulated curves and the optimum.
const VERMILLION: RGBColor = RGBColor(0xc8, 0x4b, 0x11);
/// Second simulated quantity.
const BLUE: RGBColor = RGBColor(0x0b, 0x5f, 0x9e);
/// Third and fourth simulated quantity.
const GREEN: RGBColor = RGBColor(0x1b, 0x7a, 0x5a);
/// Third and fourth simulated quantity.
const PURPLE: RGBColor = RGBColor(0x8a, 0x4f, 0x8f);

/// A figure could not be drawn.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[error("a figure could not be drawn: {reason}")]
pub struct ChartError {
    /// What the drawing library says.
    pub reason: String,
}

impl<E: std::error::Error + Send + Sync> From<DrawingAreaErrorKind<E>> for ChartError {
    fn from(error: DrawingAreaErrorKind<E>) -> Self {
        Self {
            reason: error.to_string(),
        }
    }
}

/// A finished figure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Figure {
    /// Stem of its file name, unique in a report.
    pub name: String,
    /// Plain text that says what is to be seen and how to read it.
    pub caption: String,
    /// The `svg` element.
    pub svg: String,
}

/// Every overlay of a condition: the objective's gauges first, then the others of the record.
///
/// # Errors
/// [`ChartError`] when the drawing library fails.
pub fn overlays(case: &Case, result: &ConditionResult) -> Result<Vec<Figure>, ChartError> {
    let condition = case.conditions.get(result.condition);
    let record = condition.and_then(|condition| condition.record.as_ref());
    let fitted: Vec<u8> = case.objective.gauges.iter().map(|&(g, _)| g).collect();
    let mut gauges: Vec<u8> = record.map_or_else(Vec::new, |record| {
        record.gauges.iter().map(|trace| trace.gauge).collect()
    });
    gauges.sort_by_key(|gauge| (!fitted.contains(gauge), *gauge));
    let figures = gauges
        .into_iter()
        .filter_map(|gauge| overlay(case, result, gauge).transpose());
    figures.collect()
}

/// Every figure of one simulation except its gauges.
///
/// # Errors
/// [`ChartError`] when the drawing library fails.
pub fn machine_curves(
    case: &Case,
    condition: usize,
    simulation: &Simulation,
) -> Result<Vec<Figure>, ChartError> {
    let mut figures = vec![tension(simulation)?];
    figures.extend(contact(case, simulation)?);
    figures.push(motion(simulation)?);
    figures.extend(card(case, condition, simulation)?);
    figures.push(torque(simulation)?);
    Ok(figures)
}

/// Every figure of one simulation.
///
/// # Errors
/// [`ChartError`] when the drawing library fails.
pub fn simulation(
    case: &Case,
    condition: usize,
    simulation: &Simulation,
) -> Result<Vec<Figure>, ChartError> {
    let mut figures = vec![gauges(case, condition, simulation)?];
    figures.extend(machine_curves(case, condition, simulation)?);
    Ok(figures)
}

/// Thins a list to at most `most` entries, evenly, first and last kept.
fn thinned<T: Copy>(values: &[T], most: usize) -> Vec<T> {
    if values.len() <= most || most < 2 {
        return values.to_vec();
    }
    (0..most)
        .map(|index| values[index * (values.len() - 1) / (most - 1)])
        .collect()
}

/// Points of a curve; as long as the shorter list.
fn points(xs: &[f64], ys: &[f64]) -> Vec<(f64, f64)> {
    xs.iter().copied().zip(ys.iter().copied()).collect()
}

/// Linear interpolation in an ascending table; none outside it or without a finite neighbour.
pub(super) fn interpolated(xs: &[f64], ys: &[f64], x: f64) -> Option<f64> {
    let above = xs.partition_point(|&known| known < x);
    let x1 = *xs.get(above)?;
    let y1 = *ys.get(above)?;
    if (x1 - x).abs() < 1e-9 {
        return y1.is_finite().then_some(y1);
    }
    let below = above.checked_sub(1)?;
    let (x0, y0) = (*xs.get(below)?, *ys.get(below)?);
    let y = y0 + (y1 - y0) * (x - x0) / (x1 - x0);
    y.is_finite().then_some(y)
}

#[cfg(test)]
mod tests {
    use super::{interpolated, thinned};

    #[test]
    fn thinning_keeps_the_ends() {
        let values: Vec<u32> = (0..1000).collect();
        let few = thinned(&values, 37);
        assert_eq!((few.len(), few[0], few[36]), (37, 0, 999));
        assert_eq!(thinned(&values[..5], 37), [0, 1, 2, 3, 4]);
    }

    #[test]
    fn interpolation_does_not_extrapolate() {
        let (xs, ys) = ([0.0, 1.0, 3.0], [10.0, 20.0, 40.0]);
        assert_eq!(interpolated(&xs, &ys, 2.0), Some(30.0));
        assert_eq!(interpolated(&xs, &ys, 0.0), Some(10.0));
        assert_eq!(interpolated(&xs, &ys, 3.1), None);
        assert_eq!(interpolated(&xs, &ys, -0.1), None);
        assert_eq!(interpolated(&[], &[], 0.0), None);
    }
}
