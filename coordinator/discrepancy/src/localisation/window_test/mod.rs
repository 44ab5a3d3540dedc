//! Map of a residual over the abscissa: windows in which it is larger than noise.
pub(crate) mod map;
pub(crate) mod null;
pub(crate) mod windows;

pub use map::{AbscissaWindow, AlongMap, map};
pub use record::bins::{BINS, Bins};
pub use windows::WIDTHS;
