//! Reading of gauge records: from samples and data sheet to an averaged turn on the output grid.
//!
//! A record is cut into cycles at the index pulses, every whole cycle is resampled on the output grid, and
//! the cycles are averaged; the standard deviation between them is the noise model.
mod agreement;
mod read;
mod resample;
mod samples;
mod sheet;
#[cfg(test)]
mod tests;
mod tolerance;

pub use agreement::RecordFacts;
pub(super) use agreement::{Expected, SPEED_TOLERANCE};
pub use read::count_samples;
pub(super) use read::{GaugeRecord, channels, of, read, sheet_path};
pub(super) use resample::grid;
pub(super) use samples::{CURVES, Samples, median, whole};
