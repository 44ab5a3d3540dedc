//! Serde types of `case.toml` in its general form.
use super::super::{
    diagnose::DiagnoseEntry, effect::CaseEffect, fitted_conditions::FittedConditions,
    loaded::Records, prior::PriorEntry,
};
use protocol::case::{ChannelLimit, Offset, Scale, Tie, Valley};
use serde::Deserialize;
use std::path::PathBuf;
use toml::Table;

/// Content of a `case.toml` in its general form.
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
    /// Settings of a diagnosis.
    #[serde(default)]
    pub(super) diagnose: DiagnoseEntry,
    #[serde(default)]
    pub(super) effects: Vec<CaseEffect>,
}

/// `[model]` table: kind of the model, and the settings that only the model interprets.
#[derive(Debug, Deserialize)]
pub(super) struct ModelEntry {
    pub(super) kind: String,
    #[serde(flatten)]
    pub(super) own: Table,
}

/// Unknown of the case: a number to be searched.
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
    /// Finite-difference step for derivatives by the unknown: a share of the value on a logarithmic scale,
    /// otherwise in the unknown's unit.
    pub(super) difference: Option<f64>,
    pub(super) suspect: Option<String>,
}

/// `[[conditions]]` table: a condition, with settings that only the model interprets.
#[derive(Debug, Deserialize)]
pub(super) struct ConditionEntry {
    pub(super) name: String,
    /// Whether all records of the condition are held out from the fits.
    #[serde(default)]
    pub(super) held_out: bool,
    #[serde(flatten)]
    pub(super) own: Table,
}

/// `[[channels]]` table: a quantity under one condition.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ChannelEntry {
    pub(super) name: String,
    pub(super) title: Option<String>,
    pub(super) unit: String,
    pub(super) condition: String,
    pub(super) abscissa: AbscissaEntry,
    pub(super) noise: Option<f64>,
    /// Correlation of the channel's noise between successive values.
    pub(super) correlation: Option<f64>,
    /// Standard deviation of the model error of the channel, below which no model is expected to fit.
    pub(super) model_error: Option<f64>,
    /// Treatment of the sensor's zero for this channel: whether absolute values are compared (fixed), or
    /// values after removal of the mean difference (free); the objective's treatment unless stated.
    pub(super) offset: Option<Offset>,
    /// Side on which the record limits the channel, if it is not to be met.
    pub(super) limit: Option<ChannelLimit>,
    /// Part of the record that is held out from the fits of a diagnosis.
    #[serde(default)]
    pub(super) held_out: HeldOutEntry,
    pub(super) record: Option<RecordEntry>,
    /// Source of the values in the output of a user's program, for the kind `command`.
    pub(super) source: Option<Table>,
}

/// Part of a record that is held out from the fits of a diagnosis.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged)]
pub(super) enum HeldOutEntry {
    /// Boolean form: the whole record is held out if true, none of it if false.
    Whole(bool),
    /// Interval of the abscissa, including its ends, whose values are held out.
    Segment(SegmentEntry),
}

/// Interval of a channel's abscissa that is held out from the fits.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SegmentEntry {
    pub(super) from: f64,
    pub(super) to: f64,
}

impl Default for HeldOutEntry {
    fn default() -> Self {
        Self::Whole(false)
    }
}

/// Abscissa of a channel: its name, unit, period and points.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AbscissaEntry {
    pub(super) name: String,
    pub(super) unit: String,
    pub(super) period: Option<f64>,
    /// Abscissa points of a channel without a record; a record states its own points.
    pub(super) points: Option<PointsEntry>,
}

/// Equally spaced abscissa points: the first point, the spacing and the number.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PointsEntry {
    pub(super) first: f64,
    pub(super) step: f64,
    pub(super) count: u32,
}

/// File of a channel's measured record, and the columns to be read from it.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RecordEntry {
    pub(super) file: PathBuf,
    /// Name of the record's column with the abscissa points.
    pub(super) at: String,
    /// Name of the record's column with the measured values.
    pub(super) column: String,
    /// Name of the record's column with the cycle numbers.
    pub(super) cycle: Option<String>,
    /// Name of the record's column with the weights of the values.
    pub(super) weight: Option<String>,
    /// Filter for the rows of the record file that belong to this channel.
    pub(super) rows: Option<RowsEntry>,
}

/// Filter for rows of a record file: those with the text `is` in a column are read.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RowsEntry {
    pub(super) column: String,
    pub(super) is: String,
}

/// Objective that a calibration minimises.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ObjectiveEntry {
    pub(super) condition: FittedConditions,
    pub(super) terms: Vec<TermEntry>,
    pub(super) offset: Offset,
}

/// Term of the objective: a channel and its weight.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TermEntry {
    pub(super) channel: String,
    pub(super) weight: f64,
}
