//! The machine of a case: what a case of this kind says to its own model alone.
use super::{
    BackHead, Beam, Contact, Crank, FrontHead, LoadCard, ModalHead, Rod, Ropes, RunSettings,
    Suspension, TwinRopes,
};
use crate::{
    case::{Case, ModelSettings},
    wire::{self, WireError},
};
use serde::{Deserialize, Serialize};

/// A pumping unit under its working conditions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Machine {
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
    /// Speed and load under each condition of the case, in its order.
    pub conditions: Vec<WorkingCondition>,
    /// How a run is started, sampled and integrated.
    pub run: RunSettings,
}

/// What a condition of a case means to the machine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WorkingCondition {
    /// Crank speed [revolutions per minute].
    pub speed_rpm: f64,
    /// Counterweight moment at the crank [N m].
    pub counterweight_moment_n_m: f64,
    /// Load at the suspension point.
    pub card: LoadCard,
}

impl Machine {
    /// The kind of model, as cases and workers name it: double horse heads.
    pub const KIND: &'static str = "dhh";

    /// The machine of a case.
    ///
    /// # Errors
    /// [`WireError::Malformed`] for a case of another kind, or settings of another version.
    pub fn of(case: &Case) -> Result<Self, WireError> {
        if case.model.kind != Self::KIND {
            return Err(WireError::Malformed {
                reason: format!("its model is `{}`, not `{}`", case.model.kind, Self::KIND),
            });
        }
        wire::decode(&case.model.settings)
    }

    /// As a case carries it.
    ///
    /// # Errors
    /// [`WireError::TooLong`] beyond what a message may hold.
    pub fn settings(&self) -> Result<ModelSettings, WireError> {
        Ok(ModelSettings::exact(
            Self::KIND.to_owned(),
            wire::encode(self)?,
        ))
    }
}

/// A case of this kind with its machine.
#[derive(Clone, Debug, PartialEq)]
pub struct PumpingUnit {
    /// What every model's case says.
    pub case: Case,
    /// What this one's says beside.
    pub machine: Machine,
}

impl PumpingUnit {
    /// Takes the machine out of a case.
    ///
    /// # Errors
    /// As [`Machine::of`].
    pub fn of(case: Case) -> Result<Self, WireError> {
        let machine = Machine::of(&case)?;
        Ok(Self { case, machine })
    }

    /// Puts the machine, as it is now, into its case.
    ///
    /// # Errors
    /// As [`Machine::settings`].
    pub fn into_case(mut self) -> Result<Case, WireError> {
        self.case.model = self.machine.settings()?;
        Ok(self.case)
    }
}
