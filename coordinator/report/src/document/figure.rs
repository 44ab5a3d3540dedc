//! Figure type of a report.
use serde::{Deserialize, Serialize};

/// Rendered figure with its name and caption.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Figure {
    /// Stem of the figure's file name, unique in a report.
    pub name: String,
    /// Caption in plain text: content of the figure and how to read it.
    pub caption: String,
    /// The figure as an SVG element, `<svg>...</svg>`.
    pub svg: String,
}
