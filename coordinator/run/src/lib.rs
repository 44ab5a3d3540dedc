//! Runs: their folders and manifests, the sessions that work on them, and what readers take from them.
//!
//! [`opened`] opens the run of a folder with its [`manifest`] and [case](protocol::case::Case); [`session`] is a process that
//! works on it, with workers and journal. `calibration`, `diagnosis`, `identification`, `assessment`, `orthogonal`,
//! `sweep_file` and `scaling` are the kinds of run: their settings, their work on an evaluator, and their results, which are read from
//! the journal. [`view`] is a run of any kind as a reader sees it, and [`tables`] exports it. Messages go to standard error;
//! results are returned, and printed by others.
pub mod assessment;
pub mod calibration;
pub mod command_line;
pub mod diagnosis;
pub mod factor;
pub mod folder;
pub mod hash;
pub mod identification;
pub mod manifest;
pub mod message;
pub mod name;
pub mod opened;
pub mod orthogonal;
pub mod scaling;
pub mod scaling_remote;
pub mod searches;
pub mod session;
pub mod settings;
pub mod sweep_file;
pub mod tables;
pub mod target;
pub mod view;
