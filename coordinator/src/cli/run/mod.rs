//! Runs: their folders, what is remembered of them, and what opens, resumes and repeats them.
pub(super) mod begun;
pub(crate) mod bus;
pub(super) mod calibration;
pub(super) mod command_line;
pub(super) mod diagnosis;
pub(super) mod folder;
pub(super) mod identification;
pub(super) mod interrupt;
pub(super) mod kind;
pub(super) mod manifest;
pub(crate) mod once;
pub(super) mod orthogonal;
pub(super) mod searches;
pub(super) mod session;
pub(super) mod swept;
pub(super) mod tables;
pub(super) mod target;
