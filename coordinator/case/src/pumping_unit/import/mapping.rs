//! Mapping files: how the columns of raw files become a record or a load card.
use super::logger::{Layout, Quantity, Time};
use crate::{
    document::{Document, DocumentStep},
    error::CaseError,
};
use serde::Deserialize;
use std::{collections::BTreeMap, path::PathBuf};

/// Mapping of the files of a data logger to a gauge record.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RecordMapping {
    /// Raw files in the order of time, relative to the mapping file.
    pub(super) files: Vec<PathBuf>,
    pub(super) table: Layout,
    pub(super) time: Time,
    pub(super) angle: AngleEntry,
    /// Column of each curve, by the curve's name in the record.
    pub(super) curves: BTreeMap<String, CurveEntry>,
}

/// Mapping of a dynamometer's file to a load card.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CardMapping {
    /// The raw file, relative to the mapping file.
    pub(super) files: Vec<PathBuf>,
    /// Layout of a table; absent for a file of Theta's format (`.DYN`).
    pub(super) table: Option<Layout>,
    pub(super) card: CardEntry,
}

/// `[card]` table of a mapping.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CardEntry {
    /// Position of the polished rod, positive upwards; stated with a table.
    pub(super) position: Option<Quantity>,
    /// Load of the polished rod; stated with a table.
    pub(super) load: Option<Quantity>,
    /// Order of the points in time.
    #[serde(default)]
    pub(super) order: Order,
    /// Strokes per minute at which the card was taken; unknown where the file does not state them.
    pub(super) strokes_per_minute: Option<f64>,
}

/// Order of the points of a card.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Order {
    /// As the rod moved.
    #[default]
    Forward,
    /// From the last to the first.
    Reversed,
}

/// `[angle]` table of a mapping: an angle column or one pulse a turn.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AngleEntry {
    column: Option<String>,
    unit: Option<String>,
    bottom_dead_centre_deg: Option<f64>,
    direction: Option<Direction>,
    pulse: Option<String>,
    level: Option<f64>,
    edge: Option<Edge>,
    pulse_deg: Option<f64>,
    /// Standard deviation of the angle's zero \[deg\].
    pub(super) uncertainty_deg: f64,
}

/// Whether the numbers of an angle column grow or fall while the crank turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Direction {
    Increasing,
    Decreasing,
}

/// Edge of a pulse that marks its angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Edge {
    Rising,
    Falling,
}

/// Source of the crank angle, as a mapping states it.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Angle {
    /// Column of angles.
    Column {
        column: String,
        unit: String,
        /// Number of the column at bottom dead centre \[deg\].
        bottom_dead_centre_deg: f64,
        direction: Direction,
    },
    /// Column with one pulse a turn.
    Pulse {
        column: String,
        /// Number of the column at the edge.
        level: f64,
        edge: Edge,
        /// Crank angle from bottom dead centre at the edge \[deg\].
        pulse_deg: f64,
    },
}

impl Angle {
    /// Returns the name of the column of the angle or of the pulse.
    pub(super) fn column(&self) -> &str {
        match self {
            Self::Column { column, .. } | Self::Pulse { column, .. } => column,
        }
    }
}

impl AngleEntry {
    /// Returns the source of the angle.
    ///
    /// # Errors
    /// Returns an error for a key that is missing, or one of the other source.
    pub(super) fn angle(&self, document: &Document) -> Result<Angle, CaseError> {
        let fault = |problem: &str, help: &str| {
            document.field(&[DocumentStep::Key("angle")], "{ .. }", problem, help)
        };
        let lacks = |key: &str, meaning: &str| fault(&format!("a table with `{key}`"), meaning);
        match (&self.column, &self.pulse) {
            (Some(column), None) => {
                if self.level.is_some() || self.edge.is_some() || self.pulse_deg.is_some() {
                    return Err(fault(
                        "`level`, `edge` and `pulse_deg` only with `pulse`",
                        "remove them, or state `pulse` in place of `column`",
                    ));
                }
                Ok(Angle::Column {
                    column: column.clone(),
                    unit: self.unit.clone().ok_or_else(|| {
                        lacks("unit", "state the unit of the angle: deg, rad or rev")
                    })?,
                    bottom_dead_centre_deg: self.bottom_dead_centre_deg.ok_or_else(|| {
                        lacks(
                            "bottom_dead_centre_deg",
                            "state the number of the column, in degrees, while the polished rod is lowest",
                        )
                    })?,
                    direction: self.direction.ok_or_else(|| {
                        lacks("direction", "state \"increasing\" or \"decreasing\"")
                    })?,
                })
            }
            (None, Some(column)) => {
                if self.unit.is_some()
                    || self.direction.is_some()
                    || self.bottom_dead_centre_deg.is_some()
                {
                    return Err(fault(
                        "`unit`, `direction` and `bottom_dead_centre_deg` only with `column`",
                        "remove them, or state `column` in place of `pulse`",
                    ));
                }
                Ok(Angle::Pulse {
                    column: column.clone(),
                    level: self
                        .level
                        .ok_or_else(|| lacks("level", "state the number of the column at the edge"))?,
                    edge: self.edge.unwrap_or(Edge::Rising),
                    pulse_deg: self.pulse_deg.ok_or_else(|| {
                        lacks(
                            "pulse_deg",
                            "state the crank angle from bottom dead centre at which the pulse comes",
                        )
                    })?,
                })
            }
            (Some(_), Some(_)) | (None, None) => Err(fault(
                "either `column` (an angle) or `pulse` (one pulse a turn)",
                "state one of the two",
            )),
        }
    }
}

/// Column of a curve, and how its numbers become values.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CurveEntry {
    /// Name of the column in the header.
    pub(super) column: String,
    /// Unit of the numbers, after `factor`.
    pub(super) unit: String,
    /// Factor on the numbers, such as units per volt; -1 reverses the sign.
    #[serde(default = "one")]
    pub(super) factor: f64,
    /// Young's modulus with which strain becomes stress \[GPa\].
    pub(super) young_gpa: Option<f64>,
    /// Gauge factor with which a bridge's `mV/V` becomes strain.
    pub(super) gauge_factor: Option<f64>,
    /// Number of active arms of the bridge: 1 of a quarter bridge, up to 4 of a full one.
    pub(super) active_arms: Option<f64>,
}

const fn one() -> f64 {
    1.0
}
