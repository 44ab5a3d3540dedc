//! Windows of the revolution in which a residual cannot be noise.
pub(crate) mod map;
pub(crate) mod null;
pub(crate) mod windows;

pub use map::{AngleMap, Window, map};
pub use windows::{BINS, WIDTHS};
