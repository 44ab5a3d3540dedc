//! Import of a PEST control file as a case: writes `case.toml` and the observations, and copies the control
//! file's folder, whose files travel with the case.
mod channels;
mod copy;
mod unknowns;

use channels::Group;
use exchange::{Problem, decoded, pest::Control};
use std::{
    fs, io,
    path::{Path, PathBuf},
};
use toml_edit::{Array, ArrayOfTables, DocumentMut, InlineTable, Item, Table, Value, value};

/// Name of the only condition of an imported case.
const CONDITION: &str = "model";
/// Deadline that an imported case states for one run of its program (s).
const DEADLINE_S: f64 = 3600.0;

/// Result of importing a PEST control file as a case.
#[derive(Debug)]
pub struct Imported {
    /// Folder of the new case.
    pub folder: PathBuf,
    /// Notes on settings of the control file that were changed or ignored.
    pub notes: Vec<String>,
    /// Number of estimated parameters and number of observations with positive weight.
    pub counts: [usize; 2],
}

/// Error that prevents an import.
#[derive(Debug, thiserror::Error)]
pub enum ImportError {
    /// Problem in the PEST control file or in a file that it names.
    #[error(transparent)]
    File(#[from] Problem),
    /// Target folder of the import, which exists already.
    #[error("{} exists already, and nothing was written", .0.display())]
    Exists(PathBuf),
    /// Input or output error of the operating system.
    #[error("{}: {source}", .path.display())]
    Io {
        /// Path of the file or folder that could not be read or written.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
}

/// Creates the case folder for a control file: at `to`, or beside the control file under its name without
/// extension.
///
/// # Errors
/// Returns an error for a control file that cannot be used, and for a target folder that exists. A partly
/// written folder is removed.
pub fn import(control: &Path, to: Option<&Path>) -> Result<Imported, ImportError> {
    let io = |path: &Path, source| ImportError::Io {
        path: path.to_owned(),
        source,
    };
    let text = fs::read(control).map_err(|source| io(control, source))?;
    let text = decoded(&text);
    let beside = match control.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        Some(_) | None => Path::new("."),
    };
    let open = |name: &str| {
        let bytes = fs::read(beside.join(name)).map_err(|error| error.to_string())?;
        Ok(decoded(&bytes).into_owned())
    };
    let read = Control::parse(&control.display().to_string(), &text, &open)?;
    let mut notes = read.notes.clone();
    if let Some(line) = read.commands.iter().find(|line| is_of_windows(line)) {
        notes.push(format!(
            "the model command line `{line}` is that of a Windows program: change `command` in case.toml to one that runs on \
             the workers"
        ));
    }
    let folder = to.map_or_else(|| control.with_extension(""), Path::to_owned);
    if folder.exists() {
        return Err(ImportError::Exists(folder));
    }
    let name = case_name(control);
    let groups = channels::groups(&read);
    fs::create_dir_all(&folder).map_err(|source| io(&folder, source))?;
    let written = copy::copy_contents(beside, &folder).and_then(|(files, not_copied)| {
        notes.extend(not_copied);
        let file = control.file_name().unwrap_or_default().to_string_lossy();
        let case = text_of(&read, &groups, (&name, &file), &files);
        fs::write(folder.join("case.toml"), case)?;
        fs::write(
            folder.join(channels::file_name(&files)),
            channels::table(&groups),
        )
    });
    if let Err(source) = written {
        drop(fs::remove_dir_all(&folder));
        return Err(io(&folder, source));
    }
    let estimated = read.parameters.iter();
    let estimated = estimated
        .filter(|own| unknowns::is_searched(&own.transform))
        .count();
    let counted = groups.iter().filter(|group| group.is_measured);
    Ok(Imported {
        folder,
        counts: [estimated, counted.map(|group| group.rows.len()).sum()],
        notes,
    })
}

/// Returns the name for the case and its allow-list entry: the folder's name and the control file's name,
/// because many control files have the same name.
fn case_name(control: &Path) -> String {
    let full = std::path::absolute(control).unwrap_or_else(|_| control.to_owned());
    let folder = full.parent().and_then(Path::file_name);
    let parts = folder.into_iter().chain(control.file_stem());
    let parts: Vec<_> = parts.map(std::ffi::OsStr::to_string_lossy).collect();
    parts.join("-")
}

/// Returns the text of the `case.toml` to which a PEST control file is converted.
fn text_of(
    control: &Control,
    groups: &[Group<'_>],
    (name, file): (&str, &str),
    files: &[String],
) -> String {
    let mut document = DocumentMut::new();
    document.insert("name", value(name));
    document.insert("model", Item::Table(model(control, name, files)));
    document.insert("unknowns", Item::ArrayOfTables(unknowns::tables(control)));
    let mut condition = Table::new();
    condition.insert("name", value(CONDITION));
    let conditions: ArrayOfTables = [condition].into_iter().collect();
    document.insert("conditions", Item::ArrayOfTables(conditions));
    document.insert(
        "channels",
        Item::ArrayOfTables(channels::tables(
            groups,
            CONDITION,
            &channels::file_name(files),
        )),
    );
    document.insert(
        "objective",
        Item::Table(channels::objective(groups, CONDITION)),
    );
    format!("# Made from {file}, a control file of PEST.\n{document}")
}

/// Returns the `[model]` table of the imported case.
fn model(control: &Control, name: &str, files: &[String]) -> Table {
    let mut model = Table::new();
    model.insert("kind", value("command"));
    let plain = |letter: char| letter.is_ascii_alphanumeric() || matches!(letter, '_' | '-' | '.');
    let entry: String = name
        .chars()
        .map(|letter| if plain(letter) { letter } else { '_' })
        .take(64)
        .collect();
    model.insert("entry", value(entry));
    model.insert("command", list(&command(&control.commands)));
    model.insert("files", list(files));
    model.insert("deadline_s", value(DEADLINE_S));
    let pair = |own: &'static str, pair: &exchange::pest::FilePair| {
        let parts = [
            ("file", plain_path(&pair.program)),
            (own, plain_path(&pair.own)),
        ];
        parts.into_iter().collect::<InlineTable>()
    };
    let inputs: Array = control
        .inputs
        .iter()
        .map(|it| pair("template", it))
        .collect();
    let outputs: Array = control
        .outputs
        .iter()
        .map(|it| pair("instructions", it))
        .collect();
    model.insert("inputs", value(inputs));
    model.insert("outputs", value(outputs));
    if !control.prior.is_empty() {
        let equations: Array = control.prior.iter().map(unknowns::equation).collect();
        model.insert("equations", value(equations));
    }
    let written: InlineTable = control
        .parameters
        .iter()
        .filter_map(unknowns::written)
        .collect();
    if !written.is_empty() {
        model.insert("parameters", value(written));
    }
    model
}

/// Normalises a path: removes leading `./` and uses `/` as separator.
fn plain_path(path: &str) -> String {
    let path = path.replace('\\', "/");
    path.trim_start_matches("./").to_owned()
}

/// Returns whether a command line has a path of Windows: a backslash that escapes neither a blank nor a sign.
fn is_of_windows(line: &str) -> bool {
    let mut behind = line.split('\\').skip(1);
    behind.any(|part| part.starts_with(|letter: char| letter.is_alphanumeric() || letter == '.'))
}

/// Splits the command line of a PEST control file into words; several lines, or a line with shell syntax, are
/// passed to `/bin/sh -c`.
fn command(lines: &[String]) -> Vec<String> {
    let shell = |text: &str| text.contains(['|', '>', '<', '&', ';', '$', '`']);
    match lines {
        // a path of Windows, whose backslashes are no escapes
        [one] if is_of_windows(one) && !shell(one) => {
            one.split_whitespace().map(str::to_owned).collect()
        }
        [one] if !shell(one) => shlex::split(one).unwrap_or_else(|| vec![one.clone()]),
        more => vec!["/bin/sh".to_owned(), "-c".to_owned(), more.join(" && ")],
    }
}

fn list(words: &[String]) -> Item {
    value(words.iter().map(Value::from).collect::<Array>())
}
