//! What a case says of a program, as it is written: keys and types.
use serde::Deserialize;
use std::{collections::BTreeMap, path::PathBuf};

/// As much of a case file as only this kind reads.
#[derive(Debug, Deserialize)]
pub(super) struct OwnFile {
    pub(super) model: ModelEntry,
    pub(super) conditions: Vec<ConditionEntry>,
    pub(super) channels: Vec<ChannelEntry>,
}

/// `[model]`.
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

/// A file that is written for every individual; exactly one of the three says how.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct InputEntry {
    pub(super) file: String,
    pub(super) template: Option<PathBuf>,
    pub(super) braces: Option<PathBuf>,
    pub(super) dakota: Option<String>,
}

/// A file that the program leaves.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct OutputEntry {
    pub(super) file: String,
    pub(super) instructions: Option<PathBuf>,
    pub(super) dakota: Option<Vec<String>>,
}

/// A value that follows from the parameters alone.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct EquationEntry {
    pub(super) name: String,
    pub(super) terms: Vec<TermEntry>,
}

/// A term of an equation.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TermEntry {
    pub(super) parameter: String,
    pub(super) factor: f64,
    #[serde(default)]
    pub(super) log: bool,
}

/// How an unknown is written.
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

/// A condition, as far as it is the program's.
#[derive(Debug, Deserialize)]
pub(super) struct ConditionEntry {
    #[serde(default)]
    pub(super) values: BTreeMap<String, f64>,
}

/// A channel, as far as it is the program's.
#[derive(Debug, Deserialize)]
pub(super) struct ChannelEntry {
    pub(super) name: String,
    pub(super) source: Option<SourceEntry>,
}

/// Where a channel's values come from.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SourceEntry {
    /// Named values.
    pub(super) named: Option<Vec<String>>,
    /// One of the outputs.
    pub(super) file: Option<String>,
    /// A column of it.
    pub(super) column: Option<String>,
    /// A JSON pointer into it.
    pub(super) values: Option<String>,
    /// Column or pointer of the places.
    pub(super) at: Option<String>,
}
