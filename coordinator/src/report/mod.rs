//! What people see of a finished run: tables, figures, an HTML report and the data behind it.
//!
//! Takes plain data ([`Calibration`], [`SingleRun`], [`diagnosis::Subject`]) and returns text, or
//! writes a folder of files. The same data give the same bytes: nothing here reads a clock, a journal
//! or the network.
//!
//! From below upwards: `number`, `color` and `words` say one thing each; `document` is what every report
//! is made of, and its forms; `table`, `chart` and `animation` fill it; `section` lists what a report
//! says; `folder` and `write` make files of it.
mod animation;
pub mod chart;
mod color;
pub mod csv;
mod data;
pub mod diagnosis;
mod document;
mod folder;
mod number;
mod section;
pub mod table;
pub mod vtu;
pub mod words;
mod write;

pub use data::{
    Calibration, ConditionResult, HistoryPoint, Individual, Origin, Run, SingleRun, WorkerUse,
};
pub use document::{Block, Figure, Report, Section, Table, page, text};
pub use folder::ReportError;
pub use write::{
    calibration, parameters, simulation, write_calibration, write_head_modes, write_simulation,
};
