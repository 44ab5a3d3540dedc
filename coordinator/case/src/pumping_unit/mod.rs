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
pub mod import;
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

use crate::{document::Document, error::CaseError};
use std::path::PathBuf;

pub use card::read as read_card;
pub use figures::{ConditionFigures, GaugeFigures, KeyFigures, RecordFigures, figures};
pub use genes::unknown;
pub use geometry::{Envelope, QuasiStaticTurn, quasi_static};
pub use head::{GaugePlace, WrapStress};
pub use head_comparison::{
    HalfRanges, HeadComparison, INERT, ModeMatch, WrappedTurn, compare_head, mac, wrapped_turn,
};
pub use head_source::{HeadSource, load_head, load_meshed_head};
pub use record::{RecordFacts, count_samples};
pub use twin::TwinFile;

/// Commented data sheet as a starting point, for a record with nothing known of its instruments.
const SHEET_TEMPLATE: &str = include_str!("record/template.toml");

/// Commented `case.toml` as a starting point; it loads as soon as the files it names exist.
const TEMPLATE: &str = include_str!("template.toml");

/// Returns the files of a new case, as paths below its folder and text: a commented `case.toml`, and a
/// commented data sheet for each record that it names.
///
/// # Errors
/// Never for the templates as they are; a fault in them is that of a case file.
pub fn new_files() -> Result<Vec<(PathBuf, &'static str)>, CaseError> {
    let document = Document::new("case.toml".into(), TEMPLATE.to_owned());
    let case: schema::CaseFile = document.parse()?;
    let records = case
        .conditions
        .iter()
        .filter_map(|own| own.record_file.as_ref());
    let sheets = records.map(|file| (record::sheet_path(file), SHEET_TEMPLATE));
    Ok([(document.path, TEMPLATE)]
        .into_iter()
        .chain(sheets)
        .collect())
}
