//! Serde types of the case-file entries that describe a program.
use serde::Deserialize;
use std::{collections::BTreeMap, path::PathBuf};

/// Part of a case file that is read only for the kind `command`, whose models are programs of the user's own.
#[derive(Debug, Deserialize)]
pub(super) struct CommandCaseFile {
    pub(super) model: ModelEntry,
    pub(super) conditions: Vec<ConditionEntry>,
    pub(super) channels: Vec<ChannelEntry>,
}

/// Table `[model]` of the case file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ModelEntry {
    #[serde(rename = "kind")]
    _kind: String,
    pub(super) entry: String,
    #[serde(default)]
    pub(super) command: Vec<String>,
    #[serde(default)]
    pub(super) version: Vec<String>,
    #[serde(default)]
    pub(super) files: Vec<PathBuf>,
    pub(super) deadline_s: f64,
    #[serde(default)]
    pub(super) repeatable: bool,
    pub(super) reference_tolerance: Option<f64>,
    #[serde(default)]
    pub(super) verdicts: BTreeMap<String, String>,
    #[serde(default)]
    pub(super) inputs: Vec<InputEntry>,
    pub(super) outputs: Vec<OutputEntry>,
    #[serde(default)]
    pub(super) equations: Vec<EquationEntry>,
    #[serde(default)]
    pub(super) parameters: BTreeMap<String, ParameterEntry>,
}

/// Input file that is written for each set of parameter values before the program runs; exactly one of
/// `template`, `braces` and `dakota` states its form.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct InputEntry {
    pub(super) file: String,
    pub(super) template: Option<PathBuf>,
    pub(super) braces: Option<PathBuf>,
    pub(super) dakota: Option<String>,
    /// Analysis components of a Dakota parameters file.
    #[serde(default)]
    pub(super) components: Vec<String>,
}

/// Output file that the program writes, with the form in which it is read.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct OutputEntry {
    pub(super) file: String,
    pub(super) instructions: Option<PathBuf>,
    pub(super) dakota: Option<Vec<String>>,
    /// Whether a Dakota results file holds gradients where they are requested.
    #[serde(default)]
    pub(super) gradients: bool,
}

/// Value that is computed from the parameters alone, without running the program.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct EquationEntry {
    pub(super) name: String,
    pub(super) terms: Vec<TermEntry>,
}

/// Term of an equation: a parameter, or its logarithm, multiplied by a factor.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TermEntry {
    pub(super) parameter: String,
    pub(super) factor: f64,
    #[serde(default)]
    pub(super) log: bool,
}

/// Name, factor and offset with which an unknown is written to the program's input files.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ParameterEntry {
    pub(super) name: Option<String>,
    #[serde(default = "one")]
    pub(super) factor: f64,
    #[serde(default)]
    pub(super) offset: f64,
}

const fn one() -> f64 {
    1.0
}

/// Keys of a `[[conditions]]` table that only the kind `command` reads.
#[derive(Debug, Deserialize)]
pub(super) struct ConditionEntry {
    #[serde(default)]
    pub(super) values: BTreeMap<String, f64>,
}

/// Keys of a `[[channels]]` table that only the kind `command` reads.
#[derive(Debug, Deserialize)]
pub(super) struct ChannelEntry {
    pub(super) name: String,
    pub(super) source: Option<SourceEntry>,
}

/// Source of a channel's values in the program's output: named values, a table column or a JSON pointer.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SourceEntry {
    /// Names of single output values, one for each abscissa point of the channel.
    pub(super) named: Option<Vec<String>>,
    /// Name of the output file from which the channel's values are read.
    pub(super) file: Option<String>,
    /// Name of the output table's column with the channel's values.
    pub(super) column: Option<String>,
    /// JSON pointer to the channel's values in the output file.
    pub(super) values: Option<String>,
    /// Column or JSON pointer of the abscissa values that belong to the channel's values.
    pub(super) at: Option<String>,
}
