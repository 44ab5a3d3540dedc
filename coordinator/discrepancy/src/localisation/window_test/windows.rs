//! Means of a whitened residual over windows of the abscissa, without any test of significance.
use nalgebra::DVector;
use record::metric::Metric;

/// Widths of the windows in which the residual is averaged (bins).
pub const WIDTHS: [usize; 3] = [5, 11, 21];

/// Means of a whitened residual over windows, by channel, width and first bin of the window.
pub(crate) type Windows = Vec<Vec<Vec<f64>>>;

/// Computes the window means of every channel's whitened curve.
pub(crate) fn windows(whitened: &DVector<f64>, metric: &Metric) -> Windows {
    let curves = metric.along(whitened);
    let channels = metric.bins().into_iter().zip(&curves);
    channels
        .map(|(bins, curve)| {
            WIDTHS
                .iter()
                .map(|&width| bins.moving_mean(curve, width))
                .collect()
        })
        .collect()
}
