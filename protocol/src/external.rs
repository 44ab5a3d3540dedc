//! External model: a user's own program, with input files that are filled in, an executable that a worker is
//! allowed to start, and output files that are read back.
//!
//! The executable is defined in the worker's own list of allowed programs under the name of an *entry*; a
//! case states only this name. This module is independent of the file formats and of the meaning of the
//! numbers.
use crate::case::ModelSettings;
use crate::file::File;
use crate::id::ContentHash;
use crate::wire::{self, WireError};
use serde::{Deserialize, Serialize};

/// Kind of external models in case files. In messages a colon and the name of the entry follow, so that each
/// entry is a kind of its own, which a worker supports or not.
pub const KIND: &str = "command";

/// Maximum total size of all files of a case (bytes), because they travel with the case in one message.
pub const MOST_BYTES: usize = 12 << 20;

/// Returns the model kind, as used in messages, of an external program's entry in the list of allowed
/// programs.
pub fn kind_of(entry: &str) -> String {
    format!("{KIND}:{entry}")
}

/// Returns the entry's name in the list of allowed programs if a model kind in a message denotes an external
/// program.
pub fn entry_of(kind: &str) -> Option<&str> {
    kind.strip_prefix(KIND)?.strip_prefix(':')
}

/// Description of how an external program evaluates an individual: input files, output files and their
/// meaning.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct External {
    /// Files that are the same for every individual, copied into the program's folder before the input files
    /// are written.
    pub files: Vec<File>,
    /// Input files of the program, written for every individual.
    pub fills: Vec<InputFile>,
    /// Output files of the program, read after it has ended.
    pub readings: Vec<OutputFile>,
    /// Values computed from the parameters alone, without the program.
    pub equations: Vec<Equation>,
    /// Names and scaling of the case's unknowns in input files, in the case's order.
    pub parameters: Vec<Parameter>,
    /// Names and values that each condition of the case sets in addition to the unknowns.
    pub conditions: Vec<Vec<(String, f64)>>,
    /// Source of each channel's values, in the case's order.
    pub curves: Vec<ChannelSource>,
    /// Exit statuses by which the program reports a verdict on the individual, with the name of each verdict.
    pub verdicts: Vec<(i32, String)>,
}

/// Input file of an external program, written for every individual.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct InputFile {
    /// Path of the file below the program's folder.
    pub file: String,
    /// Format and template of the input file.
    pub form: InputFormat,
}

/// Format of an input file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum InputFormat {
    /// PEST template, given by the text of the `.tpl` file.
    Pest(String),
    /// Text template with `{name}` fields.
    Braces(String),
    /// Dakota parameters file.
    Dakota {
        /// Format of the file: `standard`, `aprepro` or `json`.
        form: String,
        /// Analysis components, texts that are passed on to the driver.
        components: Vec<String>,
    },
}

/// Output file of the program, with the method to read it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct OutputFile {
    /// Path of the file below the program's folder.
    pub file: String,
    /// Format of the output file.
    pub form: OutputFormat,
}

/// Format of an output file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum OutputFormat {
    /// Text file read by PEST instructions (the text of an `.ins` file); each observation yields a named
    /// value.
    Pest(String),
    /// Dakota results file; each function yields a named value.
    Dakota {
        /// Names of the functions in the file's order.
        functions: Vec<String>,
        /// Whether the program returns the gradients of the functions where they are requested.
        gradients: bool,
    },
    /// Table with columns of numbers under a header.
    Table,
    /// JSON object that contains the values.
    Object,
}

/// Value computed from the parameters: a weighted sum of them or of their logarithms.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Equation {
    /// Name of the computed value.
    pub name: String,
    /// Terms of the weighted sum.
    pub terms: Vec<EquationTerm>,
}

/// Term of an equation: a factor times a parameter or its logarithm.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EquationTerm {
    /// Name of the parameter in the term.
    pub parameter: String,
    /// Factor on the parameter or its logarithm.
    pub factor: f64,
    /// Whether the term uses the parameter's decimal logarithm.
    pub log: bool,
}

/// Name and scaling of an unknown in input files.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Parameter {
    /// Name of the parameter in input file templates.
    pub name: String,
    /// Factor in `factor x value + offset`, the number written into input files.
    pub factor: f64,
    /// Summand `offset` in `factor x value + offset`, the number written into input files.
    pub offset: f64,
}

/// Source of the values of a channel.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum ChannelSource {
    /// Named values read from output files, one per point of the channel's abscissa.
    Named(Vec<String>),
    /// Column of a table, interpolated to the channel's abscissa along another column of the table, or used
    /// unchanged.
    Column {
        /// Index of the table among the output files.
        reading: usize,
        /// Name of the abscissa column; `None` if the rows correspond to the channel's points.
        at: Option<String>,
        /// Name of the table column with the channel's values.
        column: String,
    },
    /// Number or list of numbers in a JSON object.
    Pointer {
        /// Index of the JSON file among the output files.
        reading: usize,
        /// JSON pointer to the channel's values.
        values: String,
        /// JSON pointer to the abscissa of the values; `None` if they correspond to the channel's points.
        at: Option<String>,
    },
}

impl External {
    /// Decodes the description of an external model from a case's settings.
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

    /// Returns the digest of all files, static and filled in, that are placed in the program's folder. A
    /// program interprets its input files like code, so a permission to run it covers only the files that
    /// were reviewed.
    pub fn digest(&self) -> String {
        let bytes = wire::encode(&(&self.files, &self.fills)).unwrap_or_default();
        ContentHash::of(&bytes).to_string()
    }
}
