//! Entry that a machine's allow list needs before its workers may run a case's program, built from the case's
//! proposal.
use super::{file::CommandCaseFile, kind::CommandModel};
use crate::{
    CaseError, Overrides,
    case_kind::ModelKind as _,
    document::DocumentStep,
    source::{RecordFolder, document, stated_kind},
};
use exchange::allow::AllowEntry;
use protocol::external::{External, KIND, entry_of};
use std::{
    env,
    path::{Component, Path, PathBuf},
};

/// Allow-list entry that a case proposes, so that a machine's workers may run the case's program.
#[derive(Debug)]
pub struct EntryProposal {
    /// Name of the allow-list entry that the case refers to.
    pub name: String,
    /// Entry that would be written to the allow list.
    pub entry: AllowEntry,
    /// Whether the program exists: on this machine, or among the files that the case brings.
    pub is_there: bool,
    /// Paths of the case's files that are sent to the workers, and of the input files that are filled in for
    /// the program.
    pub files: Vec<String>,
}

/// Returns the allow-list entry that a case proposes.
///
/// # Errors
/// Returns an error if the case cannot be read, is not of the kind `command`, or proposes no command.
///
/// Whether this machine has the program does not matter: the case may be prepared here for others.
pub fn propose_entry(folder: &Path) -> Result<EntryProposal, CaseError> {
    let overrides = Overrides::default();
    let document = document(folder, &overrides)?;
    let stated = stated_kind(&document)?;
    let other_kind = || {
        document.field(
            &[DocumentStep::Key("model"), DocumentStep::Key("kind")],
            format!("\"{stated}\""),
            "\"command\": only cases with a program of the user's own need an entry in the allow list",
            "do nothing: a case of another kind needs no entry in the allow list",
        )
    };
    if stated.split(':').next() != Some(KIND) {
        return Err(other_kind());
    }
    let location = RecordFolder::new(folder, &overrides, &document);
    let model = CommandModel.read(&location)?.case.model;
    let external = External::of(&model).ok();
    let (name, external) = entry_of(&model.kind).zip(external).ok_or_else(other_kind)?;
    let own: CommandCaseFile = document.parse()?;
    let Some((program, arguments)) = own.model.command.split_first() else {
        return Err(document.field(
            &[DocumentStep::Key("model"), DocumentStep::Key("command")],
            "absent",
            "the program with its arguments, as [\"python3\", \"model.py\"]",
            "add it, or write the entry by hand; `horsehead allow --help` says where",
        ));
    };
    let place = resolve_program(program);
    let is_there = program_exists(&place, folder, &external);
    let mut entry = AllowEntry::new(place, arguments.to_vec());
    entry.files = Some(external.digest());
    if let Some((program, arguments)) = own.model.version.split_first() {
        entry.version = vec![resolve_program(program).display().to_string()];
        entry.version.extend(arguments.iter().cloned());
    }
    let files = external.files.iter().map(|file| file.path.clone());
    let filled = external
        .fills
        .iter()
        .map(|fill| format!("{} (filled in)", fill.file));
    Ok(EntryProposal {
        name: name.to_owned(),
        entry,
        is_there,
        files: files.chain(filled).collect(),
    })
}

/// Returns whether a program exists at a path: on this machine, or among the files that the case brings or
/// fills in.
fn program_exists(place: &Path, folder: &Path, external: &External) -> bool {
    let plain = |path: &Path| {
        path.components()
            .filter(|part| *part != Component::CurDir)
            .collect()
    };
    let inside: PathBuf = plain(place);
    let mut fills = external.fills.iter();
    // a whole path stays itself when it is joined to a folder
    folder.join(place).is_file() || fills.any(|fill| plain(Path::new(&fill.file)) == inside)
}

/// Returns the path of a program: looked up in `PATH` for a bare name; unchanged if it contains `/`, since
/// such a path may refer to a file of the case.
fn resolve_program(program: &str) -> PathBuf {
    let plain = Path::new(program);
    if program.contains('/') {
        return plain.to_owned();
    }
    let path = env::var_os("PATH").unwrap_or_default();
    let mut places = env::split_paths(&path).map(|folder| folder.join(plain));
    places
        .find(|place| place.is_file())
        .unwrap_or_else(|| plain.to_owned())
}
