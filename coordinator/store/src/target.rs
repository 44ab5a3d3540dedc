//! Where an export goes: written beside its place and moved there when it is complete, so that a
//! reader finds the old one or the new one. What is not an export of ours is left alone.
use super::{
    book::Sink,
    csv::CsvFiles,
    error::StoreError,
    parquet::ParquetFiles,
    sqlite::{APPLICATION, Database},
    table,
};
use std::{
    collections::BTreeSet,
    fs::{self, File},
    io::{self, ErrorKind, Read as _},
    path::{Path, PathBuf},
};
use tempfile::TempDir;

/// In which form tables are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// One SQLite database.
    Sqlite,
    /// A folder with one CSV file per table.
    Csv,
    /// A folder with one Parquet file per table.
    Parquet,
}

impl Format {
    /// Its name.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Sqlite => "sqlite",
            Self::Csv => "csv",
            Self::Parquet => "parquet",
        }
    }

    /// Name of the file or folder within a run's folder.
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

/// Where to write, and in which form.
#[derive(Clone, Debug)]
pub struct Target {
    /// The file, or the folder.
    pub path: PathBuf,
    /// The form.
    pub format: Format,
    /// Whether something else that is there may be replaced: a file as a whole, in a folder the
    /// files of the same names.
    pub force: bool,
}

/// Name of the export while it is written.
const DRAFT: &str = "export";

/// An export that is being written.
#[derive(Debug)]
pub(super) struct Draft {
    target: Target,
    scratch: TempDir,
}

impl Draft {
    /// Makes room for an export.
    ///
    /// # Errors
    /// [`StoreError::Foreign`] if something else is in its place, [`StoreError::Io`] if one cannot
    /// write there.
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

    /// What writes it.
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

    /// Puts the complete export into its place; the paths of its files.
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

/// The folder that something lies in.
fn parent(path: &Path) -> PathBuf {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent.to_owned(),
        Some(_) | None => PathBuf::from("."),
    }
}

/// Whether nothing is there, or an export of the same form.
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

/// A database's header names its format, and at byte 68 the application whose file it is.
fn is_our_database(path: &Path) -> io::Result<bool> {
    let mut header = [0; 72];
    match File::open(path)?.read_exact(&mut header) {
        Ok(()) => {}
        Err(error) if error.kind() == ErrorKind::UnexpectedEof => return Ok(false),
        Err(error) => return Err(error),
    }
    Ok(header.starts_with(b"SQLite format 3\0") && header[68..] == APPLICATION.to_be_bytes())
}

/// A folder of ours has a dictionary and nothing that is not in it.
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
