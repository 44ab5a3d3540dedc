//! Reads a case folder, checks it and resolves it into plain data.
//!
//! A folder holds `case.toml` and the files it names: load cards, gauge records with their data
//! sheets, and the reduced back head. What comes out is a [`Case`](protocol::case::Case), which travels to the workers;
//! what is wrong ends in one [`CaseError`] that names file, field, value, range and remedy; what
//! is worth knowing is a [`Note`]. Nothing here knows of dynamics, of search or of the wire.
mod card;
mod check;
mod coefficient;
mod condition;
mod document;
mod effect;
mod effect_text;
mod error;
mod file;
mod flexible;
mod gene_file;
mod general;
mod genes;
mod geometry;
mod head;
mod head_source;
mod kind;
mod load;
mod loaded;
mod machine;
pub mod mesh;
mod names;
mod note;
mod objective;
mod ranges;
mod recommended;
mod record;
mod schema;
mod spread;
mod table;
mod twin;

pub use card::read as read_card;
pub use check::{ConditionSummary, RecordSummary, Summary, check, check_with, template};
pub use effect::{CaseEffect, CaseParameter, Provenance};
pub use effect_text::{append_effects, write_effects, write_starts};
pub use error::CaseError;
pub use gene_file::{read_genes, write_genes};
pub use genes::unknown;
pub use geometry::Envelope;
pub use geometry::{QuasiStatic, quasi_static};
pub(crate) use head::GaugePlace;
pub use head_source::{HeadSource, load_head};
pub use load::{Overrides, load, load_with_notes};
pub use loaded::Loaded;
pub use note::Note;
pub use objective::require_record;
pub use record::{RecordFacts, count_samples};
pub(crate) use twin::TwinFile;
