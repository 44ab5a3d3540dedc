//! Arguments shared by several commands, one kind per file.
pub(super) mod assessment;
pub(crate) mod case;
pub(super) mod derivatives;
pub(crate) mod hours;
pub(crate) mod individual;
pub(super) mod individuals;
pub(super) mod listening;
pub(crate) mod nodes;
pub(crate) mod output;
pub(super) mod settings;
pub(super) mod study;
pub(super) mod workers;
