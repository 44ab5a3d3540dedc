//! A case, resolved: everything a worker needs to simulate a machine and to score it against its
//! records, as plain data with the unit in every name.
//!
//! The coordinator reads and validates case *files* and builds this; its encoded bytes travel as
//! one blob, named by their content hash. Nothing here knows of files, of TOML or of dynamics.
mod condition;
mod effect;
mod gene;
mod head;
mod machine;
mod objective;
mod twin;

pub use condition::{Condition, GaugeRecord, GaugeTrace, LoadCard, Smoothing};
pub use effect::{EffectSetting, merged};
pub use gene::{Coefficient, Gene, Quantity, Scale};
pub use head::{Influence, ModalHead, StressRecovery};
pub use machine::{
    BackHead, Beam, Contact, Crank, FrontHead, Rod, RopeEnds, Ropes, Suspension, TurnSense,
};
pub use objective::{Objective, Offset};
pub use twin::{TwinHead, TwinRopes};

use serde::{Deserialize, Serialize};

/// A machine, its records and what is asked of them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Case {
    /// Name of the machine.
    pub name: String,
    /// Acceleration of gravity, downwards [m/s2].
    pub gravity_m_s2: f64,
    /// Walking beam with everything rigid on it.
    pub beam: Beam,
    /// Prescribed crank.
    pub crank: Crank,
    /// Connecting rods and crossbeam.
    pub rod: Rod,
    /// Carrier bar with clamp and load cell.
    pub suspension: Suspension,
    /// Both ropes.
    pub ropes: Ropes,
    /// Contact between rope and heads.
    pub contact: Contact,
    /// Front head: an arc about the beam pivot.
    pub front_head: FrontHead,
    /// Back head: an arc about its own centre, flexible.
    pub back_head: BackHead,
    /// Modes and influence lines of the back head.
    pub modal_head: ModalHead,
    /// Two ropes on each head in place of one, if there are.
    pub twin_ropes: Option<TwinRopes>,
    /// What the machine has beside the above: effects with their numbers.
    pub effects: Vec<EffectSetting>,
    /// Units in which the case states those numbers, effect by effect in the same order; a worker
    /// refuses one that is not its own. Empty where nobody stated any.
    pub effect_units: Vec<Vec<String>>,
    /// The unknown numbers, in the order of every gene vector: coefficients, then parameters of
    /// [`Self::effects`], whose values there are the recommended ones.
    pub genes: Vec<Gene>,
    /// Working conditions with their records.
    pub conditions: Vec<Condition>,
    /// What a calibration minimises.
    pub objective: Objective,
    /// How a run is started, sampled and integrated.
    pub run: RunSettings,
}

/// How a run is started, sampled and integrated.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunSettings {
    /// Spacing of the output on crank angle \[deg\]; divides 360.
    pub output_step_deg: f64,
    /// Crank angle that is run before the recorded revolution \[deg\].
    pub lead_in_deg: f64,
    /// Time in which the crank is brought from rest to full speed \[s\].
    pub ramp_s: f64,
    /// Method of integration.
    pub integrator: Integrator,
    /// Spectral radius at infinite frequency of [`Integrator::GeneralizedAlpha`], 0 to 1 \[1\].
    #[serde(default = "half")]
    pub spectral_radius: f64,
    /// Longest step \[s\]; it bounds how coarsely the rope's own modes are resolved. It holds where the
    /// beam swings slowly on its ropes; stiffer ropes get shorter steps in proportion.
    pub longest_step_s: f64,
    /// Tolerance of the integrator, relative to its built-in error scales.
    pub tolerance: f64,
    /// Number of head modes that are simulated.
    pub modes: usize,
    /// Newton iterations that one run may take before it is given up.
    #[serde(default = "iterations")]
    pub iteration_budget: u64,
}

const fn iterations() -> u64 {
    25_000
}

const fn half() -> f64 {
    0.5
}

/// Methods of integration.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Integrator {
    /// Second order, two implicit stages a step.
    TrBdf2,
    /// Fourth order, five implicit stages a step.
    Esdirk4,
    /// Rosenbrock method of fourth order: six linear solutions a step, a new factorisation each.
    Rodas4,
    /// Generalised-alpha, second order, one implicit stage a step.
    GeneralizedAlpha,
    /// Backward differentiation of variable step, orders 1 and 2.
    Bdf,
    /// The same with orders 1 to 5, for comparison: they are unstable on lightly damped modes.
    Bdf5,
}

impl Integrator {
    /// Every method.
    pub const ALL: [Self; 6] = [
        Self::TrBdf2,
        Self::Esdirk4,
        Self::Rodas4,
        Self::GeneralizedAlpha,
        Self::Bdf,
        Self::Bdf5,
    ];

    /// As written in case files.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::TrBdf2 => "tr_bdf2",
            Self::Esdirk4 => "esdirk4",
            Self::Rodas4 => "rodas4",
            Self::GeneralizedAlpha => "generalized_alpha",
            Self::Bdf => "bdf",
            Self::Bdf5 => "bdf5",
        }
    }
}

impl Case {
    /// Position of a condition by its name.
    pub fn condition(&self, name: &str) -> Option<usize> {
        self.conditions
            .iter()
            .position(|condition| condition.name == name)
    }

    /// The recommended gene vector, in declared units.
    pub fn recommended(&self) -> Vec<f64> {
        self.genes.iter().map(|gene| gene.recommended).collect()
    }

    /// Whether parameters of effects are among the genes: then every individual is a machine of its
    /// own.
    pub fn has_effect_genes(&self) -> bool {
        self.genes.iter().any(|gene| gene.quantity.is_of_effect())
    }
}
