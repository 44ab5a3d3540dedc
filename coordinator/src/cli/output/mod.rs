//! What a command prints and writes: the terminal, progress, errors, tables, files, JSON objects.
pub(super) mod calibration;
pub(super) mod diagnosis;
pub(super) mod files;
pub(super) mod head_files;
pub(super) mod object;
pub(super) mod problem;
pub(super) mod progress;
pub(super) mod terminal;
