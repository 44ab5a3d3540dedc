//! Which kind of model a case is of: what decides who reads the rest of it.
use super::{
    document::{Document, Step},
    error::CaseError,
};
use serde::Deserialize;

/// As much of a case file as any kind has.
#[derive(Debug, Deserialize)]
struct AnyCase {
    model: Option<AnyModel>,
}

/// `[model]`, whatever else it says.
#[derive(Debug, Deserialize)]
struct AnyModel {
    kind: Option<String>,
}

/// The kind that a case states.
///
/// # Errors
/// Where it states none: to guess one would be to read a case as something that it is not.
pub(super) fn of(document: &Document) -> Result<String, CaseError> {
    let kind = document
        .parse::<AnyCase>()?
        .model
        .and_then(|model| model.kind);
    kind.filter(|kind| !kind.is_empty()).ok_or_else(|| {
        document.field(
            &[Step::Key("model"), Step::Key("kind")],
            "absent",
            "the name of a kind of model, which workers announce",
            "add a table [model] with kind; that of a pumping unit is kind = \"dhh\"",
        )
    })
}
