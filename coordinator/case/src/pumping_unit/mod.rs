//! Reading of the case folder of a pumping unit: its file, load cards, gauge records with their data sheets,
//! and the reduced back head with its mesh.
//!
//! The module covers files and geometry, not dynamics.
mod card;
mod coefficient;
mod condition;
mod figures;
mod flexible;
mod genes;
mod geometry;
mod head;
mod head_comparison;
mod head_source;
pub(crate) mod kind;
mod machine;
pub mod mesh;
mod numerics;
mod objective;
mod ranges;
mod read;
mod recommended;
mod record;
mod schema;
mod twin;

pub use card::read as read_card;
pub use figures::{ConditionFigures, KeyFigures, RecordFigures, figures};
pub use genes::unknown;
pub use geometry::{Envelope, QuasiStaticTurn, quasi_static};
pub use head::GaugePlace;
pub use head_comparison::{
    HalfRanges, HeadComparison, ModeMatch, WrappedTurn, compare_head, wrapped_turn,
};
pub use head_source::{HeadSource, load_head};
pub use record::{RecordFacts, count_samples};
pub use twin::TwinFile;

/// Returns a commented `case.toml` as a starting point; it loads as soon as the files it names exist.
pub const fn template() -> &'static str {
    include_str!("template.toml")
}
