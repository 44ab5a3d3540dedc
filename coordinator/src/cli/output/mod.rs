//! Output of commands: terminal, progress display, errors, tables, files and JSON objects.
pub(super) mod assessment;
pub(super) mod calibration;
pub(super) mod diagnosis;
pub(super) mod files;
pub(super) mod identification;
pub(super) mod model;
pub(crate) mod object;
pub(crate) mod problem;
pub(super) mod progress;
pub(super) mod sweep;
pub(crate) mod terminal;
