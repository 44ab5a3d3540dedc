//! Reads a case folder, checks it and resolves it into plain data.
//!
//! A folder holds `case.toml` and the files it names. What comes out is a [`Case`](protocol::case::Case),
//! which travels to the workers; what is wrong ends in one [`CaseError`] that names file, field, value,
//! range and remedy; what is worth knowing is a [`Note`]. Here is what cases of all kinds share, and the
//! general form; a kind of model that has a form of its own reads it in its own folder. Nothing here
//! knows of dynamics, of search or of the wire.
pub(crate) mod conversion;
pub(crate) mod difference;
pub(crate) mod document;
pub(crate) mod effect;
mod effect_text;
pub(crate) mod error;
pub(crate) mod file;
mod gene_file;
pub(crate) mod general;
mod kind;
pub(crate) mod load;
pub(crate) mod loaded;
mod measured;
pub(crate) mod names;
pub(crate) mod note;
pub(crate) mod prior;
pub(crate) mod source;
pub(crate) mod spread;
pub(crate) mod summary;
pub(crate) mod table;

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
