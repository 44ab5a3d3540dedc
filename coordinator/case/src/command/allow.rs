//! What a machine would have to allow for a case: an entry of its list, made of what the case proposes.
use super::file::OwnFile;
use crate::{CaseError, Overrides, document::Step, load_with_notes, source::document};
use exchange::allow::Entry;
use protocol::external::{External, entry_of};
use std::{
    env,
    path::{Component, Path, PathBuf},
};

/// An entry as a case proposes it.
#[derive(Debug)]
pub struct Proposal {
    /// The name that the case uses.
    pub name: String,
    /// What would be written.
    pub entry: Entry,
    /// Paths of the files that the program reads or is made of.
    pub files: Vec<String>,
}

/// What a case proposes.
///
/// # Errors
/// A case that cannot be read, is of another kind, or proposes nothing.
pub fn proposed(folder: &Path) -> Result<Proposal, CaseError> {
    let overrides = Overrides::default();
    let case = load_with_notes(folder, &overrides)?.case;
    let document = document(folder, &overrides)?;
    let Some((name, external)) = entry_of(&case.model.kind).zip(External::of(&case.model).ok())
    else {
        return Err(document.field(
            &[Step::Key("model"), Step::Key("kind")],
            format!("\"{}\"", case.model.kind),
            "\"command\": only programs of somebody's own are to be allowed",
            "a case of another kind needs no permission",
        ));
    };
    let own: OwnFile = document.parse()?;
    let Some((program, arguments)) = own.model.command.split_first() else {
        return Err(document.field(
            &[Step::Key("model"), Step::Key("command")],
            "absent",
            "the program with its arguments, as [\"python3\", \"model.py\"]",
            "add it, or write the entry by hand; `horsehead allow --help` says where",
        ));
    };
    let place = found(program);
    if !is_there(&place, folder, &external) {
        return Err(document.field(
            &[Step::Key("model"), Step::Key("command")],
            format!("\"{program}\""),
            "a program of this machine, by its name or its whole path, or a file of the case, as \"./model.sh\"",
            "there is no such program: install it, or correct the name",
        ));
    }
    let mut entry = Entry::new(place, arguments.to_vec());
    entry.files = Some(external.digest());
    if let Some((program, arguments)) = own.model.version.split_first() {
        entry.version = vec![found(program).display().to_string()];
        entry.version.extend(arguments.iter().cloned());
    }
    let files = external.files.iter().map(|file| file.path.clone());
    let filled = external
        .fills
        .iter()
        .map(|fill| format!("{} (filled in)", fill.file));
    Ok(Proposal {
        name: name.to_owned(),
        entry,
        files: files.chain(filled).collect(),
    })
}

/// Whether there is a program at a place: on this machine, or where the case's files will lie.
fn is_there(place: &Path, folder: &Path, external: &External) -> bool {
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

/// Where a program lies: as the shell finds it; as it is named where it travels with the case.
fn found(program: &str) -> PathBuf {
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
