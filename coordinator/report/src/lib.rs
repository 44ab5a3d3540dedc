//! Reports of finished runs: tables, figures, HTML pages and the data behind them.
//!
//! Takes plain data ([`Calibration`], [`SingleRun`], [`diagnosis::DiagnosisInput`], [`identification::IdentificationInput`]) and
//! returns text, or writes a folder of files. Output is deterministic: nothing here reads a clock, a journal
//! or the network.
//!
//! Layers from bottom to top: `number`, `color` and `words` format single values; `document` is the document
//! model and its output formats; `table` and `chart` hold what several topics share; `model_report` is the trait
//! for content specific to a kind of model, which `kind` selects; `section` has a file for each topic, with its tables and figures; `folder` and `write` write
//! the files.
mod assessment;
pub mod chart;
pub mod color;
mod command_files;
mod csv;
pub mod data;
pub mod diagnosis;
pub mod document;
mod failure;
pub mod folder;
pub mod identification;
pub mod kind;
mod machine_check;
pub mod model_report;
pub mod number;
pub mod orthogonal;
pub mod pumping_unit;
pub mod scaling;
mod section;
pub mod sweep;
pub mod table;
pub mod words;
mod write;

pub use assessment::{MachineAssessment, Topic};
pub use data::{
    Calibration, ConditionResult, HistoryPoint, Individual, Origin, RivalFit, ScoredCurves,
    SimulationView, SingleRun, is_determined,
};
pub use document::{Block, Figure, Report, Section, Table, page, text};
pub use folder::{ReportError, write_report};
pub use machine_check::{ComparedChannel, MachineCheck};
pub use model_report::ModelReport;
pub use section::{checks, condition_checks, derivatives, flags, genes, hosts, jobs, slot_time};
pub use write::{
    agreement, calibration, individual, machine, parameters, ranges, rivals, running_calibration,
    script, simulation, structure, write_calibration, write_simulation,
};
