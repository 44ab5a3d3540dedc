//! Figure that compares one channel before and after an effect is added to the model: the measured mean, both
//! simulated curves, and on one scale the residuals before, after and with the best rejected rival effect.
use super::axis::ChartAxis;
use super::scale::AxisScale;
use super::strip::{Strip, StripCurve, curve, stack, strip};
use crate::color::{BLUE, GREEN, INK, VERMILLION};
use crate::document::Figure;
use crate::number::{range, significant, unit};
use crate::words::{capitalised, with_unit};

/// Measured and simulated curves of one channel under one condition; all values on the grid `at`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct GapComparison<'a> {
    /// Name of the condition, such as `5rpm`.
    pub condition: &'a str,
    /// Name of the channel, such as `force`.
    pub channel: &'a str,
    /// Unit of the channel's values.
    pub unit: &'a str,
    /// Abscissa values at which the measured and simulated curves are given.
    pub at: &'a [f64],
    /// Horizontal axis of the abscissa.
    pub axis: &'a ChartAxis,
    /// Mean of the channel's measured cycles at each abscissa value.
    pub measured: &'a [f64],
    /// Standard deviation of a single measured cycle about the mean, at each abscissa value; empty if there
    /// is only one cycle.
    pub spread: &'a [f64],
    /// Number of cycles in the mean.
    pub cycles: usize,
    /// Curve of the recalibrated baseline model, without added effects.
    pub before: &'a [f64],
    /// Curve of the model with the added effects, if any.
    pub after: Option<&'a [f64]>,
    /// Name of the best rejected rival effect, and the curve of the model with that effect in place of the
    /// added ones.
    pub rival: Option<(&'a str, &'a [f64])>,
    /// Whether a constant offset between measured and simulated values is ignored.
    pub free_offset: bool,
}

impl GapComparison<'_> {
    /// Returns the constant offset, mean of measured minus simulated values, to subtract from a residual; 0
    /// unless the offset is free.
    pub(crate) fn shift(&self, simulated: &[f64]) -> f64 {
        let n = self.measured.len().min(simulated.len()).max(1) as f64;
        let difference = self.measured.iter().zip(simulated).map(|(m, s)| m - s);
        if self.free_offset {
            difference.sum::<f64>() / n
        } else {
            0.0
        }
    }

    /// Returns the residual of a simulated curve: measured minus simulated values, less the free offset.
    pub(crate) fn residual(&self, simulated: &[f64]) -> Vec<f64> {
        let shift = self.shift(simulated);
        let pairs = self.measured.iter().zip(simulated);
        pairs.map(|(m, s)| m - s - shift).collect()
    }

    /// Returns the root mean square of the residual.
    pub(crate) fn rms(&self, simulated: &[f64]) -> f64 {
        let residual = self.residual(simulated);
        let square: f64 = residual.iter().map(|r| r * r).sum();
        (square / residual.len().max(1) as f64).sqrt()
    }
}

/// Draws the comparison of one channel before and after an effect is added; `None` if there are no curves.
pub(crate) fn closing(of: &GapComparison<'_>) -> Option<Figure> {
    if of.measured.len() < 2 || of.before.len() != of.measured.len() {
        return None;
    }
    let shifted = |simulated: &[f64]| -> Vec<f64> {
        let shift = of.shift(simulated);
        simulated.iter().map(|s| s + shift).collect()
    };
    let mut curves = vec![
        curve("measured", INK, of.at, of.measured, 1.0),
        curve("before", BLUE, of.at, &shifted(of.before), 1.0),
    ];
    if let Some(after) = of.after {
        curves.push(curve("after", VERMILLION, of.at, &shifted(after), 1.0));
    }
    let rows = of.at.iter().zip(of.measured.iter().zip(of.spread));
    let mut strips = vec![Strip {
        title: with_unit("measured and simulated", &unit(of.unit)),
        height: 170.0,
        curves,
        band: rows.map(|(&x, (m, s))| (x, m - s, m + s)).collect(),
        scale: None,
    }];
    strips.extend(residuals(of));
    let title = format!("{}, condition {}", capitalised(of.channel), of.condition);
    Some(stack(
        format!("proof_{}_{}", of.condition, of.channel.replace(' ', "_")),
        &title,
        caption(of, &title),
        of.axis,
        &strips,
    ))
}

/// Builds the strips of the residuals before and after adding effects, on one scale, with a band of the
/// standard error of the measured mean.
fn residuals(of: &GapComparison<'_>) -> Vec<Strip> {
    let mut all = vec![("without it", BLUE, of.before)];
    all.extend(of.after.map(|after| ("with it", VERMILLION, after)));
    all.extend(of.rival.map(|(_, rival)| ("with the rival", GREEN, rival)));
    let values: Vec<Vec<f64>> = all.iter().map(|(.., s)| of.residual(s)).collect();
    let error = (of.cycles.max(1) as f64).sqrt();
    let errors = of.spread.iter().map(|s| s / error);
    let band: Vec<(f64, f64, f64)> = of.at.iter().zip(errors).map(|(&x, e)| (x, -e, e)).collect();
    let scale = AxisScale::symmetric(values.iter().flatten().copied());
    all.iter()
        .zip(&values)
        .map(|((label, color, _), values)| {
            let curves: Vec<StripCurve> = vec![curve(*label, *color, of.at, values, 1.0)];
            Strip {
                band: band.clone(),
                scale: Some(scale),
                ..strip("residual", 58.0, curves)
            }
        })
        .collect()
}

fn caption(of: &GapComparison<'_>, title: &str) -> String {
    let mut said = vec![format!(
        "without the effect {} {}",
        significant(of.rms(of.before)),
        of.unit
    )];
    if let Some(after) = of.after {
        said.push(format!("with it {}", significant(of.rms(after))));
    }
    if let Some((name, rival)) = of.rival {
        said.push(format!(
            "with the best rejected rival, {name}, {}",
            significant(of.rms(rival))
        ));
    }
    let noise = range(of.spread.iter().copied()).map_or_else(
        || "One cycle: there is no band of scatter.".to_owned(),
        |_| {
            format!(
                "Bands: one standard deviation of a cycle above, of the mean of {} cycles below.",
                of.cycles
            )
        },
    );
    let free = if of.free_offset {
        " Simulated curves are shifted to the measured mean."
    } else {
        ""
    };
    format!(
        "{title}: measured, and simulated by the recalibrated model. Below, measured minus simulated on \
         one scale; root mean square {}. {noise}{free}",
        said.join(", ")
    )
}
