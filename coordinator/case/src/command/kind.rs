//! Kind of model `command`: cases whose model is a program of the user's own.
use super::{
    assemble::assemble,
    file::{CommandCaseFile, ModelEntry},
    parameters::{jacobian, parameters},
};
use crate::{
    case_kind::ModelKind,
    document::{Document, DocumentStep},
    error::CaseError,
    general,
    loaded::Loaded,
    source::RecordFolder,
};
use protocol::{
    case::{Case, ModelSettings, Reproducibility},
    external::{External, entry_of, kind_of},
    wire,
};
use record::Curves;

/// Maximum deadline that a case may state for one run of its program (s): a week.
const LONGEST_S: f64 = 604_800.0;

/// Upper limit of the `reference_tolerance` that a case may state for differences between machines, as a
/// share of a channel's root mean square.
const MOST_TOLERANCE: f64 = 1.0;

/// Model that is a program of the user's own.
#[derive(Clone, Copy, Debug)]
pub struct CommandModel;

impl ModelKind for CommandModel {
    fn read(&self, source: &RecordFolder<'_>) -> Result<Loaded, CaseError> {
        let document = source.document;
        let own: CommandCaseFile = document.parse()?;
        let keys = |key| [DocumentStep::Key("model"), DocumentStep::Key(key)];
        let entry = &own.model.entry;
        let is_plain =
            |letter: char| letter.is_ascii_alphanumeric() || matches!(letter, '_' | '-' | '.');
        if entry.is_empty() || entry.len() > 64 || !entry.chars().all(is_plain) {
            return Err(document.field(
                &keys("entry"),
                format!("\"{entry}\""),
                "1 to 64 letters, digits, `_`, `-` and `.`",
                "name the entry of the workers' lists that starts the program",
            ));
        }
        document.within(
            "model.deadline_s",
            own.model.deadline_s,
            1e-3..=LONGEST_S,
            "s",
        )?;
        let repeats = repeats(document, &own.model)?;
        let mut loaded = general::read(source)?;
        let external = assemble(source, &own, &loaded.case)?;
        let settings = wire::encode(&external).map_err(|error| {
            document.field(
                &keys("files"),
                error.to_string(),
                "files that fit into one message to the workers",
                "remove large files from `files` and install them on the workers",
            )
        })?;
        loaded.case.model = ModelSettings {
            kind: kind_of(entry),
            settings,
            repeats,
            deadline_s: Some(own.model.deadline_s),
        };
        Ok(loaded)
    }

    fn gene_file(&self, case: &Case, genes: &[f64]) -> Option<(&'static str, String)> {
        Some(("calibrated.par", parameters(case, genes)))
    }

    fn jacobian_file(
        &self,
        case: &Case,
        unknowns: &[&str],
        channels: &[usize],
        derivatives: &[Curves],
    ) -> Option<(&'static str, Vec<u8>)> {
        jacobian(case, unknowns, channels, derivatives)
    }

    fn is_program(&self) -> bool {
        true
    }

    fn readiness_problem(&self, case: &Case) -> Option<(String, String)> {
        let name = entry_of(&case.model.kind)?;
        let path = exchange::allow::path();
        let remedy = "review the command, then allow it on this machine: horsehead allow CASE";
        let allowed = match exchange::allow::read(&path) {
            Ok(allowed) => allowed,
            Err(problem) => return Some((problem.to_string(), "correct the file".to_owned())),
        };
        let Some(entry) = allowed.entry.get(name) else {
            let message = format!(
                "this machine does not allow the case's program: {} has no entry `{name}`",
                path.display()
            );
            return Some((message, remedy.to_owned()));
        };
        let external = External::of(&case.model).ok()?;
        let other = entry
            .files
            .as_ref()
            .is_some_and(|own| *own != external.digest());
        other.then(|| {
            let message = format!(
                "the case's files are not those that entry `{name}` of {} was allowed for",
                path.display()
            );
            (message, remedy.to_owned())
        })
    }
}

/// Returns how reproducible the results are between machines, as the case states: bit-identical, within a
/// tolerance, or unknown.
fn repeats(document: &Document, model: &ModelEntry) -> Result<Reproducibility, CaseError> {
    let Some(tolerance) = model.reference_tolerance else {
        return Ok(if model.repeatable {
            Reproducibility::Bits
        } else {
            Reproducibility::Unknown
        });
    };
    let keys = [
        DocumentStep::Key("model"),
        DocumentStep::Key("reference_tolerance"),
    ];
    if model.repeatable {
        return Err(document.field(
            &keys,
            tolerance,
            "absent beside `repeatable = true`",
            "bit-identical results need no tolerance: remove `repeatable` or `reference_tolerance`",
        ));
    }
    document.within(
        "model.reference_tolerance",
        tolerance,
        f64::MIN_POSITIVE..=MOST_TOLERANCE,
        "",
    )?;
    Ok(Reproducibility::Within(tolerance))
}
