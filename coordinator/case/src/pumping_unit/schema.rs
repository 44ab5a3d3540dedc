//! Schema of `case.toml`: keys and their types. Allowed values are checked where the data that they concern
//! are read.
use super::{head::GaugePlace, recommended::Recommended};
use crate::{
    diagnose::DiagnoseEntry, effect::CaseEffect, fitted_conditions::FittedConditions,
    loaded::Records, prior::PriorEntry,
};
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

/// Content of a `case.toml`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CaseFile {
    pub(super) name: String,
    #[expect(
        dead_code,
        reason = "a key of the form; it was looked at before the rest was read"
    )]
    pub(super) model: ModelEntry,
    /// Origin of the gauge records; a test of the real machine unless stated.
    #[serde(default)]
    pub(super) records: Records,
    pub(super) gravity_m_s2: f64,
    pub(super) beam: Beam,
    pub(super) crank: Crank,
    pub(super) rod: Rod,
    pub(super) suspension: Suspension,
    pub(super) ropes: Ropes,
    /// Elastic constants that the formulas for recommended gene values use for the rope; steel unless stated.
    #[serde(default)]
    pub(super) rope_material: RopeMaterial,
    pub(super) contact: Contact,
    pub(super) front_head: FrontHead,
    pub(super) back_head: BackHead,
    pub(super) flexible_head: FlexibleHead,
    /// Settings of two parallel ropes on each head; absent for one rope per head.
    pub(super) twin_ropes: Option<TwinRopesEntry>,
    /// Effects (extra physical mechanisms) that the machine has beyond the plain model; none unless stated.
    #[serde(default)]
    pub(super) effects: Vec<CaseEffect>,
    /// Recommended value, bounds and prior of each rope and contact coefficient; every coefficient is
    /// required.
    pub(super) genes: BTreeMap<Coefficient, GeneEntry>,
    pub(super) conditions: Vec<ConditionEntry>,
    /// Objective of a calibration; required where there is a gauge record.
    pub(super) objective: Option<ObjectiveEntry>,
    /// Settings of a diagnosis.
    #[serde(default)]
    pub(super) diagnose: DiagnoseEntry,
    pub(super) run: RunSettings,
}

/// `[model]` table of a pumping-unit case, which states only the kind of the model.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ModelEntry {
    #[expect(
        dead_code,
        reason = "a key of the form; it was looked at before the rest was read"
    )]
    pub(super) kind: String,
}

/// Files and material of the reduced flexible back head.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FlexibleHead {
    /// JSON file with the modes of the back head.
    pub(super) modes_file: PathBuf,
    /// CSV file with the influence lines of the back head.
    pub(super) influence_file: PathBuf,
    /// Mesh file of the back head (MSH 4.1); absent where only the reduced model is available.
    pub(super) mesh_file: Option<PathBuf>,
    /// Method that recovers gauge stress from the modes; mode acceleration unless stated.
    #[serde(default)]
    pub(super) stress: StressRecovery,
    /// Density of the meshed head's material [kg/m3].
    pub(super) density_kg_m3: f64,
    /// Young's modulus of the meshed head's material \[GPa\]; steel unless stated.
    #[serde(default = "steel_gpa")]
    pub(super) young_gpa: f64,
    /// Poisson's ratio of the meshed head's material \[1\]; steel unless stated.
    #[serde(default = "steel_poisson")]
    pub(super) poisson: f64,
    /// Length of the unit in which the mesh is given \[m\].
    #[serde(default = "metre")]
    pub(super) mesh_unit_m: f64,
    /// Places of the gauges 1 to 4, from which the head is reduced; those in the modes file unless stated.
    pub(super) gauges: Option<BTreeMap<String, GaugePlace>>,
}

/// Elastic constants of the cylinders that represent the rope.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RopeMaterial {
    /// Young's modulus of the rope \[GPa\].
    pub(super) young_gpa: f64,
    /// Poisson's ratio of the rope \[1\].
    pub(super) poisson: f64,
}

impl Default for RopeMaterial {
    /// Returns the paper's constants: a Young's modulus of 200 GPa and a shear modulus of 80 GPa.
    fn default() -> Self {
        Self {
            young_gpa: 200.0,
            poisson: 0.25,
        }
    }
}

/// Settings of two ropes side by side on each head.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TwinRopesEntry {
    /// Distance of each rope from the machine's plane of motion \[m\].
    pub(super) offset_m: f64,
    /// Length of the back rope at -z minus that of the back rope at +z \[m\].
    #[serde(default)]
    pub(super) back_length_difference_m: f64,
    /// Length of the front rope at -z minus that of the front rope at +z \[m\].
    #[serde(default)]
    pub(super) front_length_difference_m: f64,
    /// Number of out-of-plane modes of the head that are simulated.
    #[serde(default = "six")]
    pub(super) modes: usize,
    /// JSON file with the back head's tables for a pair of ropes.
    pub(super) head_file: PathBuf,
}

const fn six() -> usize {
    6
}

const fn steel_gpa() -> f64 {
    206.0
}

const fn metre() -> f64 {
    1.0
}

const fn steel_poisson() -> f64 {
    0.3
}

/// Recommended value, bounds and prior that a case states for one rope or contact coefficient.
#[derive(Debug, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a table with bounds and unit; write `{ recommended = 1e8, lower = 1e6, upper = 1e10, unit = \"N/m\" }`"
)]
pub(super) struct GeneEntry {
    /// Recommended value of the coefficient in `unit`, or the formula that computes it.
    pub(super) recommended: Recommended,
    pub(super) lower: f64,
    pub(super) upper: f64,
    pub(super) unit: Unit,
    /// Prior of the coefficient in addition to its bounds.
    pub(super) prior: Option<PriorEntry>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ConditionEntry {
    pub(super) name: String,
    pub(super) speed_rpm: f64,
    pub(super) counterweight_moment_n_m: f64,
    pub(super) card_file: PathBuf,
    #[serde(default = "no_smoothing")]
    pub(super) smoothing: Smoothing,
    /// Gauge record of the condition; absent where the condition is simulated without measurements.
    pub(super) record_file: Option<PathBuf>,
}

const fn no_smoothing() -> Smoothing {
    Smoothing::None
}

/// Objective of a calibration: working conditions, weighted gauges, and weights of position and torque.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ObjectiveEntry {
    pub(super) condition: FittedConditions,
    pub(super) gauges: Vec<GaugeWeight>,
    /// Weight of the mean squared error of the rod position [MPa2/m2].
    pub(super) position_weight_mpa2_per_m2: Option<f64>,
    /// Weight of the mean squared error of the crank torque [MPa2/(kN m)2].
    pub(super) torque_weight_mpa2_per_kn2_m2: Option<f64>,
    pub(super) offset: Offset,
}

/// Gauge of the objective, with its weight.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GaugeWeight {
    pub(super) gauge: u8,
    pub(super) weight: f64,
    /// Whether the gauge is dropped from the objective if the record lacks its column.
    #[serde(default)]
    pub(super) optional: bool,
}
