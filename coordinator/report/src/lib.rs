//! What people see of a finished run: tables, figures, an HTML report and the data behind it.
//!
//! Takes plain data ([`Calibration`], [`SingleRun`], [`diagnosis::Subject`], [`identification::Subject`]) and returns text, or
//! writes a folder of files. The same data give the same bytes: nothing here reads a clock, a journal
//! or the network.
//!
//! From below upwards: `number`, `color` and `words` say one thing each; `document` is what every report
//! is made of, and its forms; `table` and `chart` have what several topics share, and `drawing` is what a kind of model
//! fills in, those of `kind`, else `general`; `section` has a file for each topic, with its tables and figures;
//! `folder` and `write` make files of it.
pub mod chart;
pub mod color;
mod command_files;
mod csv;
pub mod data;
pub mod diagnosis;
pub mod document;
pub mod drawing;
mod failure;
pub mod folder;
mod general;
pub mod identification;
pub mod kind;
pub mod number;
pub mod orthogonal;
pub mod pumping_unit;
pub mod scaling;
mod section;
pub mod table;
pub mod words;
mod write;

pub use data::{
    Calibration, ConditionResult, HistoryPoint, Individual, Origin, Run, Shown, SingleRun,
    WorkerUse,
};
pub use document::{Block, Figure, Report, Section, Table, page, text};
pub use drawing::Drawing;
pub use folder::ReportError;
pub use general::General;
pub use section::{derivatives, genes, hosts, jobs, slot_time};
pub use write::{
    agreement, calibration, parameters, ranges, simulation, structure, write_calibration,
    write_simulation,
};
