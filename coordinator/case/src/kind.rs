//! The kinds of models whose cases have a form of their own: one line each. Cases of every other kind are read by the
//! general form alone.
use crate::{
    case_kind::{AnyKind, CaseKind},
    command::kind::Commands,
    document::{Document, Step},
    error::CaseError,
    pumping_unit::kind::PumpingUnits,
};
use protocol::case::Case;
use serde::Deserialize;

const ALL: &[&dyn CaseKind] = &[&PumpingUnits, &Commands];

/// Part of a kind's name before its colon, which all entries of a list share: `command` of `command:decay`.
pub fn family(name: &str) -> &str {
    name.split_once(':').map_or(name, |(family, _)| family)
}

/// The kind of a name.
pub fn named(name: &str) -> &'static dyn CaseKind {
    let name = family(name);
    let mut all = ALL.iter().copied();
    all.find(|kind| kind.name() == name).unwrap_or(&AnyKind)
}

/// The kind that a case is of.
pub fn of(case: &Case) -> &'static dyn CaseKind {
    named(&case.model.kind)
}

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
pub(crate) fn stated(document: &Document) -> Result<String, CaseError> {
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
