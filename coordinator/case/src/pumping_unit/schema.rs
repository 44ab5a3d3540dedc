//! `case.toml` as it is written: the keys there are, and their types. What the values may be is
//! checked beside the data they name.
use super::recommended::Recommended;
use crate::{effect::CaseEffect, loaded::Records, prior::PriorEntry};
use protocol::{
    case::Offset,
    pumping_unit::{
        BackHead, Beam, Coefficient, Contact, Crank, FrontHead, Rod, Ropes, RunSettings, Smoothing,
        StressRecovery, Suspension,
    },
    unit::Unit,
};
use serde::Deserialize;
use std::{collections::BTreeMap, path::PathBuf};

/// A whole `case.toml`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CaseFile {
    pub(super) name: String,
    /// Which kind of model it is of.
    #[expect(
        dead_code,
        reason = "a key of the form; it was looked at before the rest was read"
    )]
    pub(super) model: ModelEntry,
    /// Where the gauge records come from; a test of the machine unless stated.
    #[serde(default)]
    pub(super) records: Records,
    pub(super) gravity_m_s2: f64,
    pub(super) beam: Beam,
    pub(super) crank: Crank,
    pub(super) rod: Rod,
    pub(super) suspension: Suspension,
    pub(super) ropes: Ropes,
    /// What formulas for the genes' recommended values take the rope for; steel unless stated.
    #[serde(default)]
    pub(super) rope_material: RopeMaterial,
    pub(super) contact: Contact,
    pub(super) front_head: FrontHead,
    pub(super) back_head: BackHead,
    pub(super) flexible_head: FlexibleHead,
    /// Two ropes on each head; one unless stated.
    pub(super) twin_ropes: Option<TwinRopesEntry>,
    /// What the machine has beside the above; nothing unless stated.
    #[serde(default)]
    pub(super) effects: Vec<CaseEffect>,
    /// One entry per coefficient; all are required.
    pub(super) genes: BTreeMap<Coefficient, GeneEntry>,
    pub(super) conditions: Vec<ConditionEntry>,
    /// What a calibration minimises; needed where there is a gauge record.
    pub(super) objective: Option<ObjectiveEntry>,
    pub(super) run: RunSettings,
}

/// The kind of model.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ModelEntry {
    #[expect(
        dead_code,
        reason = "a key of the form; it was looked at before the rest was read"
    )]
    pub(super) kind: String,
}

/// Where the reduced back head comes from.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FlexibleHead {
    /// Modes as JSON.
    pub(super) modes_file: PathBuf,
    /// Influence lines as CSV.
    pub(super) influence_file: PathBuf,
    /// Mesh as MSH 4.1; absent where only the reduction is at hand.
    pub(super) mesh_file: Option<PathBuf>,
    /// How gauge stress follows from the modes; by mode acceleration unless stated.
    #[serde(default)]
    pub(super) stress: StressRecovery,
    /// Density of the mesh [kg/m3].
    pub(super) density_kg_m3: f64,
    /// Young's modulus of the mesh \[GPa\]; steel unless stated.
    #[serde(default = "steel_gpa")]
    pub(super) young_gpa: f64,
    /// Poisson's ratio of the mesh \[1\]; steel unless stated.
    #[serde(default = "steel_poisson")]
    pub(super) poisson: f64,
}

/// Elasticity of the cylinders that stand for the rope.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RopeMaterial {
    /// Young's modulus \[GPa\].
    pub(super) young_gpa: f64,
    /// Poisson's ratio \[1\].
    pub(super) poisson: f64,
}

impl Default for RopeMaterial {
    /// The paper's: 200 GPa, and 80 GPa in shear.
    fn default() -> Self {
        Self {
            young_gpa: 200.0,
            poisson: 0.25,
        }
    }
}

/// Two ropes side by side on each head.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TwinRopesEntry {
    /// Distance of either rope from the machine's plane \[m\].
    pub(super) offset_m: f64,
    /// By how much the back rope at -z is longer than the one at +z \[m\].
    #[serde(default)]
    pub(super) back_length_difference_m: f64,
    /// The same of the front ropes \[m\].
    #[serde(default)]
    pub(super) front_length_difference_m: f64,
    /// Head modes out of the plane that are simulated.
    #[serde(default = "six")]
    pub(super) modes: usize,
    /// The head's tables for the pair, as JSON.
    pub(super) head_file: PathBuf,
}

const fn six() -> usize {
    6
}

const fn steel_gpa() -> f64 {
    206.0
}

const fn steel_poisson() -> f64 {
    0.3
}

/// One coefficient of the case.
#[derive(Debug, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a table with bounds and unit; write `{ recommended = 1e8, lower = 1e6, upper = 1e10, unit = \"N/m\" }`"
)]
pub(super) struct GeneEntry {
    /// In `unit`, or the formula that gives it.
    pub(super) recommended: Recommended,
    pub(super) lower: f64,
    pub(super) upper: f64,
    pub(super) unit: Unit,
    /// What is known beside the bounds.
    pub(super) prior: Option<PriorEntry>,
}

/// One working condition.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ConditionEntry {
    pub(super) name: String,
    pub(super) speed_rpm: f64,
    pub(super) counterweight_moment_n_m: f64,
    pub(super) card_file: PathBuf,
    #[serde(default = "no_smoothing")]
    pub(super) smoothing: Smoothing,
    /// Gauge record; absent where the condition is only simulated.
    pub(super) record_file: Option<PathBuf>,
}

const fn no_smoothing() -> Smoothing {
    Smoothing::None
}

/// What a calibration minimises.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ObjectiveEntry {
    pub(super) condition: String,
    pub(super) gauges: Vec<GaugeWeight>,
    pub(super) offset: Offset,
}

/// A gauge of the objective.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GaugeWeight {
    pub(super) gauge: u8,
    pub(super) weight: f64,
    /// Whether the objective does without it where the record lacks it.
    #[serde(default)]
    pub(super) optional: bool,
}
