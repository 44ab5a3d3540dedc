//! Reading, checking and resolving of a case folder into plain data.
//!
//! A folder holds `case.toml` and the files it names. The result is a [`Case`](protocol::case::Case), which
//! is sent to the workers. A fault is reported as a [`CaseError`] that names file, field, value, range and
//! remedy; a remark as a [`Note`]. This crate contains the code shared by all kinds of cases and the general
//! form; each kind of model with a format of its own has a separate folder. The crate is independent of
//! dynamics, search and the wire protocol.
mod case_kind;
pub mod command;
pub mod conversion;
mod diagnose;
pub mod difference;
pub mod document;
pub mod effect;
mod effect_text;
pub mod error;
pub mod file;
mod fitted_conditions;
mod gene_file;
pub mod general;
pub mod kind;
pub mod load;
pub mod loaded;
mod measured;
pub mod names;
pub mod note;
pub mod prior;
pub mod pumping_unit;
pub mod source;
pub mod spread;
pub mod summary;
pub mod table;

pub use case_kind::ModelKind;
pub use diagnose::DiagnoseEntry;
pub use effect::{CaseEffect, CaseParameter, Provenance};
pub use effect_text::{append_effects, write_effects, write_starts};
pub use error::CaseError;
pub use gene_file::{GeneFile, read_genes, write_genes};
pub use load::{check, load, load_with_notes};
pub use loaded::Loaded;
pub use measured::require_record;
pub use note::Note;
pub use source::Overrides;
pub use summary::CaseSummary;
