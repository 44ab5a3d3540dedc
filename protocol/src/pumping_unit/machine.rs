//! Machine data of a case: settings that only the pumping-unit model reads.
use super::{
    BackHead, Beam, Contact, Crank, FrontHead, LoadCard, ModalHead, Rod, Ropes, RunSettings,
    Suspension, TwinRopes,
};
use crate::{
    case::{Case, ModelSettings},
    wire::{self, WireError},
};
use serde::{Deserialize, Serialize};

/// Number of intervals of the rope's arc over which its normal force on the back head is recorded.
const LOAD_INTERVALS: u32 = 24;

/// Pumping unit and its working conditions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// Acceleration of gravity, downwards [m/s2].
    pub gravity_m_s2: f64,
    /// Walking beam with all parts rigidly attached to it.
    pub beam: Beam,
    /// Crank with prescribed motion.
    pub crank: Crank,
    /// Connecting rods and crossbeam.
    pub rod: Rod,
    /// Carrier bar with clamp and load cell.
    pub suspension: Suspension,
    /// Back rope and front rope.
    pub ropes: Ropes,
    /// Contact between rope and heads.
    pub contact: Contact,
    /// Front head: circular arc about the beam pivot.
    pub front_head: FrontHead,
    /// Back head: circular arc about its own centre, flexible.
    pub back_head: BackHead,
    /// Modes and influence lines of the back head.
    pub modal_head: ModalHead,
    /// Twin ropes on each head; `None` for a machine with single ropes.
    pub twin_ropes: Option<TwinRopes>,
    /// Speed and load of each condition of the case, in the case's order.
    pub conditions: Vec<WorkingCondition>,
    /// Settings of start, sampling and time integration of a simulation.
    pub run: RunSettings,
}

/// Operating data of the machine under one condition of a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WorkingCondition {
    /// Crank speed [revolutions per minute].
    pub speed_rpm: f64,
    /// Counterweight moment at the crank [N m].
    pub counterweight_moment_n_m: f64,
    /// Load at the suspension point as a function of the crank angle.
    pub card: LoadCard,
}

impl Machine {
    /// Name of this kind of model in cases and announcements: double horse head.
    pub const KIND: &'static str = "dhh";

    /// Decodes the pumping unit from the model settings of a case.
    ///
    /// # Errors
    /// [`WireError::Malformed`] for a case of another kind of model, or for settings of another version.
    pub fn of(case: &Case) -> Result<Self, WireError> {
        if case.model.kind != Self::KIND {
            return Err(WireError::Malformed {
                reason: format!(
                    "the case's model is `{}`, not `{}`",
                    case.model.kind,
                    Self::KIND
                ),
            });
        }
        wire::decode(&case.model.settings)
    }

    /// Encodes the pumping unit as the model settings of a case.
    ///
    /// # Errors
    /// [`WireError::TooLong`] beyond the size limit of a message.
    pub fn settings(&self) -> Result<ModelSettings, WireError> {
        Ok(ModelSettings::exact(
            Self::KIND.to_owned(),
            wire::encode(self)?,
        ))
    }

    /// Returns the ends of the intervals of the rope's arc over which its normal force on the back head is recorded:
    /// equally spaced from the rope's fixed end to the end of the arc of the head's tables \[deg\]; empty for a head
    /// without tables.
    pub fn load_breaks_deg(&self) -> Vec<f64> {
        let (from, to) = (
            self.back_head.rope_anchor_deg,
            self.modal_head.arc_deg.last(),
        );
        let Some(&to) = to.filter(|to| **to > from) else {
            return Vec::new();
        };
        let at = |k: u32| from + (to - from) * f64::from(k) / f64::from(LOAD_INTERVALS);
        (0..=LOAD_INTERVALS).map(at).collect()
    }
}

/// Case of a pumping unit with its decoded machine.
#[derive(Clone, Debug, PartialEq)]
pub struct PumpingUnit {
    /// Case, in the form common to all models.
    pub case: Case,
    /// Decoded machine data.
    pub machine: Machine,
}

impl PumpingUnit {
    /// Decodes the machine data of a case and keeps them with the case.
    ///
    /// # Errors
    /// Those of [`Machine::of`].
    pub fn of(case: Case) -> Result<Self, WireError> {
        let machine = Machine::of(&case)?;
        Ok(Self { case, machine })
    }

    /// Returns the case with its model settings replaced by the current machine data.
    ///
    /// # Errors
    /// Those of [`Machine::settings`].
    pub fn into_case(mut self) -> Result<Case, WireError> {
        self.case.model = self.machine.settings()?;
        Ok(self.case)
    }
}
