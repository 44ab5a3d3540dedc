//! `case.toml` in the general form as it is written: keys and types.
use super::super::{effect::CaseEffect, loaded::Records, prior::PriorEntry};
use protocol::case::{Offset, Scale, Tie, Valley};
use serde::Deserialize;
use std::path::PathBuf;
use toml::Table;

/// A whole file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CaseFile {
    pub(super) name: String,
    #[serde(default)]
    pub(super) records: Records,
    pub(super) model: ModelEntry,
    pub(super) unknowns: Vec<UnknownEntry>,
    pub(super) conditions: Vec<ConditionEntry>,
    pub(super) channels: Vec<ChannelEntry>,
    pub(super) objective: Option<ObjectiveEntry>,
    #[serde(default)]
    pub(super) effects: Vec<CaseEffect>,
}

/// Which model, and what it alone understands.
#[derive(Debug, Deserialize)]
pub(super) struct ModelEntry {
    pub(super) kind: String,
    #[serde(flatten)]
    pub(super) own: Table,
}

/// One unknown number.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct UnknownEntry {
    pub(super) name: String,
    pub(super) title: Option<String>,
    pub(super) symbol: Option<String>,
    pub(super) unit: String,
    pub(super) scale: Scale,
    pub(super) start: Option<f64>,
    pub(super) lower: Option<f64>,
    pub(super) upper: Option<f64>,
    pub(super) trust: Option<[f64; 2]>,
    pub(super) absent: Option<f64>,
    #[serde(default)]
    pub(super) fixed: bool,
    pub(super) tie: Option<Tie>,
    pub(super) prior: Option<PriorEntry>,
    pub(super) valley: Option<Valley>,
    /// What differences move it by: a share of its value on a logarithmic scale, else in its unit.
    pub(super) difference: Option<f64>,
    pub(super) suspect: Option<String>,
}

/// One condition, with what the model alone understands of it.
#[derive(Debug, Deserialize)]
pub(super) struct ConditionEntry {
    pub(super) name: String,
    /// Whether its records take no part in any fit.
    #[serde(default)]
    pub(super) held_out: bool,
    #[serde(flatten)]
    pub(super) own: Table,
}

/// One quantity under one condition.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ChannelEntry {
    pub(super) name: String,
    pub(super) title: Option<String>,
    pub(super) unit: String,
    pub(super) condition: String,
    pub(super) abscissa: AbscissaEntry,
    pub(super) noise: Option<f64>,
    /// Correlation of its noise from one value to the next.
    pub(super) correlation: Option<f64>,
    /// What no law of the model is better than, one standard deviation.
    pub(super) model_error: Option<f64>,
    /// Whether its values have a zero; as the objective says unless stated.
    pub(super) offset: Option<Offset>,
    /// What of its record takes no part in a diagnosis' fits.
    #[serde(default)]
    pub(super) held_out: HeldOut,
    pub(super) record: Option<RecordEntry>,
    /// Where the model's program leaves it, if it is one of somebody's own: its kind reads that.
    #[serde(rename = "source")]
    _source: Option<Table>,
}

/// What of a record takes no part in the fits of a diagnosis.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged)]
pub(super) enum HeldOut {
    /// All of it, or nothing.
    Whole(bool),
    /// From one place to another, the ends among them.
    Segment(SegmentEntry),
}

/// A part of an abscissa.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SegmentEntry {
    pub(super) from: f64,
    pub(super) to: f64,
}

impl Default for HeldOut {
    fn default() -> Self {
        Self::Whole(false)
    }
}

/// The axis of a curve.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AbscissaEntry {
    pub(super) name: String,
    pub(super) unit: String,
    pub(super) period: Option<f64>,
    /// Where the curve is computed; a record states its own places.
    pub(super) points: Option<PointsEntry>,
}

/// Equally spaced places.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PointsEntry {
    pub(super) first: f64,
    pub(super) step: f64,
    pub(super) count: u32,
}

/// Where the record of a channel stands.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RecordEntry {
    pub(super) file: PathBuf,
    /// Column of the places.
    pub(super) at: String,
    /// Column of the values.
    pub(super) column: String,
    /// Column of the cycles' numbers.
    pub(super) cycle: Option<String>,
    /// Column of the values' weights.
    pub(super) weight: Option<String>,
    /// Which rows are this channel's: a column of words, and its word.
    pub(super) rows: Option<RowsEntry>,
}

/// Which rows of a table are meant.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RowsEntry {
    pub(super) column: String,
    pub(super) is: String,
}

/// What a calibration minimises.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ObjectiveEntry {
    pub(super) condition: Names,
    pub(super) terms: Vec<TermEntry>,
    pub(super) offset: Offset,
}

/// One name, or several.
#[derive(Debug, Deserialize)]
#[serde(untagged, expecting = "a name, or a list of names")]
pub(super) enum Names {
    One(String),
    Several(Vec<String>),
}

impl Names {
    pub(super) fn all(&self) -> &[String] {
        match self {
            Self::One(name) => std::slice::from_ref(name),
            Self::Several(names) => names,
        }
    }
}

/// A channel of the objective.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TermEntry {
    pub(super) channel: String,
    pub(super) weight: f64,
}
