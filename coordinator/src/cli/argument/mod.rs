//! Arguments that several commands share, one kind per file.
pub(super) mod case;
pub(super) mod door;
pub(super) mod individual;
pub(super) mod output;
pub(super) mod settings;
pub(super) mod workers;
