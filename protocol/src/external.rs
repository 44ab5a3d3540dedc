//! A model that is somebody's own program: files that are filled in, a program that a worker is allowed to
//! start, files that are read back.
//!
//! What is started stands in the worker's own list, under the name of an *entry*; a case names it and says no
//! more. Nothing here knows how files are written or read, nor what their numbers mean.
use crate::case::ModelSettings;
use crate::file::File;
use crate::id::ContentHash;
use crate::wire::{self, WireError};
use serde::{Deserialize, Serialize};

/// Kind of such models in case files. On the wire the name of the entry follows behind a colon, so that each
/// entry is a kind of its own, which a worker has or has not.
pub const KIND: &str = "command";

/// Most bytes of all files of a case together: they travel with it in one message.
pub const MOST_BYTES: usize = 12 << 20;

/// Kind on the wire of an entry's models.
pub fn kind_of(entry: &str) -> String {
    format!("{KIND}:{entry}")
}

/// The entry of a kind on the wire, if it is one of these.
pub fn entry_of(kind: &str) -> Option<&str> {
    kind.strip_prefix(KIND)?.strip_prefix(':')
}

/// How one evaluation goes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct External {
    /// Files that lie in the program's folder before anything is filled in.
    pub files: Vec<File>,
    /// Files that are written for every individual.
    pub fills: Vec<Fill>,
    /// Files that the program leaves.
    pub readings: Vec<Reading>,
    /// Values that follow from the parameters alone.
    pub equations: Vec<Equation>,
    /// How each unknown of the case is written, in the case's order.
    pub parameters: Vec<Parameter>,
    /// What each condition of the case sets beside the unknowns: names and values.
    pub conditions: Vec<Vec<(String, f64)>>,
    /// Where each channel of the case comes from, in the case's order.
    pub curves: Vec<Source>,
    /// Exit statuses that are verdicts of the program about the individual, with the word for each.
    pub verdicts: Vec<(i32, String)>,
}

/// A file that is written for every individual.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fill {
    /// Where it is written, below the program's folder.
    pub file: String,
    /// What is written.
    pub form: FillForm,
}

/// How a file is filled in.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum FillForm {
    /// A template of PEST: the text of its `.tpl` file.
    Pest(String),
    /// A text with `{name}`.
    Braces(String),
    /// Dakota's parameters file, in one of its forms: `standard`, `aprepro`, `json`.
    Dakota(String),
}

/// A file that the program leaves, and how values are found in it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Reading {
    /// Where it is found, below the program's folder.
    pub file: String,
    /// How it is read.
    pub form: ReadingForm,
}

/// How values are found in a file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum ReadingForm {
    /// Instructions of PEST: the text of the `.ins` file. Its observations are named values.
    Pest(String),
    /// Dakota's results file; the names of its functions, in its order, are named values.
    Dakota(Vec<String>),
    /// Columns under a header.
    Table,
    /// An object of JSON.
    Object,
}

/// A value that follows from the parameters: a weighted sum of them or of their logarithms.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Equation {
    /// Name of the value.
    pub name: String,
    /// What is added up.
    pub terms: Vec<EquationTerm>,
}

/// A term of an equation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EquationTerm {
    /// Name of the parameter.
    pub parameter: String,
    /// Its factor.
    pub factor: f64,
    /// Whether its decimal logarithm is taken.
    pub log: bool,
}

/// How an unknown is written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Parameter {
    /// Its name in templates.
    pub name: String,
    /// `factor x value + offset` is written.
    pub factor: f64,
    /// See [`Self::factor`].
    pub offset: f64,
}

/// Where the values of a channel come from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Source {
    /// Named values, one for each place.
    Named(Vec<String>),
    /// A column of a table, brought to the channel's places along another column, or as it is.
    Column {
        /// The table: its place among the readings.
        reading: usize,
        /// Column of its places; none where its rows are the channel's places.
        at: Option<String>,
        /// Column of its values.
        column: String,
    },
    /// A number or a list of numbers in an object.
    Pointer {
        /// The object: its place among the readings.
        reading: usize,
        /// JSON pointer of the values.
        values: String,
        /// The same of their places; none where they stand at the channel's places.
        at: Option<String>,
    },
}

impl External {
    /// Out of what a case carries.
    ///
    /// # Errors
    /// [`WireError::Malformed`] for settings of another kind or version.
    pub fn of(settings: &ModelSettings) -> Result<Self, WireError> {
        if entry_of(&settings.kind).is_none() {
            return Err(WireError::Malformed {
                reason: format!("its model is `{}`, not `{KIND}:ENTRY`", settings.kind),
            });
        }
        wire::decode(&settings.settings)
    }

    /// Names everything that comes to lie in the program's folder: files, and what is filled in. Programs read
    /// these as they read their own code, so that somebody who allowed the one has looked at the other.
    pub fn digest(&self) -> String {
        let bytes = wire::encode(&(&self.files, &self.fills)).unwrap_or_default();
        ContentHash::of(&bytes).to_string()
    }
}
