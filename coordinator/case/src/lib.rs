//! Reads a case folder, checks it and resolves it into plain data.
//!
//! A folder holds `case.toml` and the files it names. What comes out is a [`Case`](protocol::case::Case),
//! which travels to the workers; what is wrong ends in one [`CaseError`] that names file, field, value,
//! range and remedy; what is worth knowing is a [`Note`]. Here is what cases of all kinds share, and the
//! general form; a kind of model that has a form of its own reads it in its own folder. Nothing here
//! knows of dynamics, of search or of the wire.
mod case_kind;
pub mod command;
pub mod conversion;
pub mod difference;
pub mod document;
pub mod effect;
mod effect_text;
pub mod error;
pub mod file;
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

pub use case_kind::CaseKind;
pub use effect::{CaseEffect, CaseParameter, Provenance};
pub use effect_text::{append_effects, write_effects, write_starts};
pub use error::CaseError;
pub use gene_file::{read_genes, write_genes};
pub use load::{check, load, load_with_notes};
pub use loaded::Loaded;
pub use measured::require_record;
pub use note::Note;
pub use source::Overrides;
pub use summary::Summary;
