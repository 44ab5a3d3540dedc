//! Target of an export: written to a temporary folder beside the target and moved there once complete, so
//! that readers see either the old export or the new one. Files that are not exports are never replaced
//! without `force`.
use super::{
    csv::CsvFiles,
    error::StoreError,
    parquet::ParquetFiles,
    sqlite::{APPLICATION, Database},
    table,
    writer::Sink,
};
use std::{
    collections::BTreeSet,
    fs::{self, File},
    io::{self, ErrorKind, Read as _},
    path::{Path, PathBuf},
};
use tempfile::TempDir;

/// File format of an export.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// One SQLite database with all tables.
    Sqlite,
    /// A folder with one CSV file per table.
    Csv,
    /// A folder with one Parquet file per table.
    Parquet,
}

impl Format {
    /// Returns the name of the export format.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Sqlite => "sqlite",
            Self::Csv => "csv",
            Self::Parquet => "parquet",
        }
    }

    /// Returns the default name of an export in this format within a run folder.
    pub const fn usual_name(self) -> &'static str {
        match self {
            Self::Sqlite => "run.sqlite",
            Self::Csv => "csv",
            Self::Parquet => "parquet",
        }
    }

    const fn is_folder(self) -> bool {
        matches!(self, Self::Csv | Self::Parquet)
    }
}

/// Path and format of an export.
#[derive(Clone, Debug)]
pub struct Target {
    /// Path of the export: a file for SQLite, otherwise a folder.
    pub path: PathBuf,
    /// File format of the export.
    pub format: Format,
    /// Whether existing content that is not an export may be replaced: a file as a whole, in a folder the
    /// files of the same names.
    pub force: bool,
}

/// Name of the unfinished export within its temporary folder.
const DRAFT: &str = "export";

/// Export in a temporary folder, before it is moved to its target.
#[derive(Debug)]
pub(super) struct Draft {
    target: Target,
    scratch: TempDir,
}

impl Draft {
    /// Creates the temporary folder for an export.
    ///
    /// # Errors
    /// [`StoreError::Foreign`] if the target exists and is not an export, [`StoreError::Io`] if the target
    /// cannot be written.
    pub(super) fn begin(target: Target) -> Result<Self, StoreError> {
        if !target.force && !is_replaceable(&target).map_err(StoreError::reading(&target.path))? {
            return Err(StoreError::Foreign { path: target.path });
        }
        let parent = parent(&target.path);
        let made = fs::create_dir_all(&parent).and_then(|()| {
            tempfile::Builder::new()
                .prefix(".horsehead-export-")
                .tempdir_in(&parent)
        });
        let scratch = made.map_err(StoreError::writing(&target.path))?;
        Ok(Self { target, scratch })
    }

    fn path(&self) -> PathBuf {
        self.scratch.path().join(DRAFT)
    }

    /// Creates the table writer for the file format of the export.
    pub(super) fn sink(&self) -> Result<Box<dyn Sink>, StoreError> {
        let path = self.path();
        if self.target.format.is_folder() {
            fs::create_dir(&path).map_err(StoreError::writing(&path))?;
        }
        Ok(match self.target.format {
            Format::Sqlite => Box::new(Database::create(&path)?),
            Format::Csv => Box::new(CsvFiles::new(&path)),
            Format::Parquet => Box::new(ParquetFiles::new(&path)),
        })
    }

    /// Moves the complete export to its target and returns the paths of its files.
    pub(super) fn publish(self) -> Result<Vec<PathBuf>, StoreError> {
        let (draft, place) = (self.path(), &self.target.path);
        let moved = if self.target.format.is_folder() {
            self.publish_folder(&draft)
        } else {
            fs::rename(&draft, place).map(|()| vec![place.clone()])
        };
        moved.map_err(StoreError::writing(place))
    }

    fn publish_folder(&self, draft: &Path) -> io::Result<Vec<PathBuf>> {
        let place = &self.target.path;
        let names: BTreeSet<_> = entries(draft)?;
        if is_replaceable(&self.target)? {
            if place.exists() {
                // what is ours goes with the scratch folder
                fs::rename(place, self.scratch.path().join("old"))?;
            }
            fs::rename(draft, place)?;
        } else {
            for name in &names {
                fs::rename(draft.join(name), place.join(name))?;
            }
        }
        Ok(names.iter().map(|name| place.join(name)).collect())
    }
}

/// Returns the parent folder of a path; `.` for a bare file name.
fn parent(path: &Path) -> PathBuf {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent.to_owned(),
        Some(_) | None => PathBuf::from("."),
    }
}

/// Returns whether an export may be written to a path: nothing exists there, or an export in the same format.
fn is_replaceable(target: &Target) -> io::Result<bool> {
    let found = match fs::symlink_metadata(&target.path) {
        Ok(found) => found,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(true),
        Err(error) => return Err(error),
    };
    match target.format {
        Format::Sqlite => Ok(found.is_file() && is_our_database(&target.path)?),
        Format::Csv | Format::Parquet => {
            Ok(found.is_dir() && is_our_folder(&target.path, target.format)?)
        }
    }
}

/// Returns whether a file is an SQLite database with the application id of exports, which is stored at byte
/// 68 of its header.
fn is_our_database(path: &Path) -> io::Result<bool> {
    let mut header = [0; 72];
    match File::open(path)?.read_exact(&mut header) {
        Ok(()) => {}
        Err(error) if error.kind() == ErrorKind::UnexpectedEof => return Ok(false),
        Err(error) => return Err(error),
    }
    Ok(header.starts_with(b"SQLite format 3\0") && header[68..] == APPLICATION.to_be_bytes())
}

/// Returns whether a folder is empty, or holds a dictionary table and only files of known tables.
fn is_our_folder(path: &Path, format: Format) -> io::Result<bool> {
    let files = entries(path)?;
    let file = |table: &str| format!("{table}.{}", format.as_str());
    let ours: BTreeSet<String> = table::NAMES.iter().map(|name| file(name)).collect();
    let complete = files.contains(&file("dictionary"));
    Ok(files.is_empty() || (complete && files.iter().all(|name| ours.contains(name))))
}

fn entries(folder: &Path) -> io::Result<BTreeSet<String>> {
    let entries = fs::read_dir(folder)?;
    entries
        .map(|entry| Ok(entry?.file_name().to_string_lossy().into_owned()))
        .collect()
}
