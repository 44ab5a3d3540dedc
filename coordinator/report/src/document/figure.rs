//! A finished figure.

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
