//! Registry of the kinds of models that have their own case format. Cases of any other kind are read in the
//! general form.
use crate::{
    case_kind::{GenericKind, ModelKind},
    command::kind::CommandKind,
    document::{Document, DocumentStep},
    error::CaseError,
    pumping_unit::kind::PumpingUnitKind,
};
use protocol::case::Case;
use serde::Deserialize;

const ALL: &[&dyn ModelKind] = &[&PumpingUnitKind, &CommandKind];

/// Returns the part of a model kind's name before the colon, as `command` of `command:decay`; the rest names
/// an allow-list entry.
pub fn family(name: &str) -> &str {
    name.split_once(':').map_or(name, |(family, _)| family)
}

/// Returns the kind of model with a name; a generic kind if the name is not registered.
pub fn named(name: &str) -> &'static dyn ModelKind {
    let name = family(name);
    let mut all = ALL.iter().copied();
    all.find(|kind| kind.name() == name).unwrap_or(&GenericKind)
}

/// Returns the kind of model of a case.
pub fn of(case: &Case) -> &'static dyn ModelKind {
    named(&case.model.kind)
}

/// Part of a case file that cases of every kind contain.
#[derive(Debug, Deserialize)]
struct AnyCase {
    model: Option<AnyModel>,
}

/// Table `[model]`, of which only `kind` is read.
#[derive(Debug, Deserialize)]
struct AnyModel {
    kind: Option<String>,
}

/// Returns the kind of model that a case file states.
///
/// # Errors
/// Returns an error if no kind is stated; a guess could misinterpret the case.
pub(crate) fn stated(document: &Document) -> Result<String, CaseError> {
    let kind = document
        .parse::<AnyCase>()?
        .model
        .and_then(|model| model.kind);
    kind.filter(|kind| !kind.is_empty()).ok_or_else(|| {
        document.field(
            &[DocumentStep::Key("model"), DocumentStep::Key("kind")],
            "absent",
            "the name of a kind of model, which workers announce",
            "add a table [model] with kind; that of a pumping unit is kind = \"dhh\"",
        )
    })
}
