//! Resolved case: all data that a worker needs to simulate a machine and to score it against its records, as
//! plain data with the unit in every name.
//!
//! The coordinator reads and validates case *files* and builds a [`Case`]; its encoded bytes travel as one
//! blob, identified by their content hash. This module is independent of files, of TOML and of dynamics.
mod bad_unknown;
mod channel;
mod condition;
mod effect;
mod model;
mod objective;
mod unknown;

pub use bad_unknown::{BadUnknown, check_unknowns};
pub use channel::{Abscissa, Channel, ChannelLimit, ChannelRecord};
pub use condition::Condition;
pub use effect::{EffectSetting, merged};
pub use model::{ModelSettings, Reproducibility};
pub use objective::{Objective, Offset, Term, WeightedCondition};
pub use unknown::{HeldRatios, Prior, Scale, Shift, Tie, Unknown, Valley};

use serde::{Deserialize, Serialize};

/// Machine with its measured records and its objective. The default is an empty case, which suffices for jobs
/// that simulate nothing.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Case {
    /// Name of the machine.
    pub name: String,
    /// Kind of model by which the machine is simulated, and its model-specific settings.
    pub model: ModelSettings,
    /// Effects added to the model, with their parameter values.
    pub effects: Vec<EffectSetting>,
    /// Units in which the case states the parameters of [`Self::effects`], per effect and in the same order;
    /// a worker refuses a unit other than its own. Empty if none were stated.
    pub effect_units: Vec<Vec<String>>,
    /// Unknowns, in the order of every individual's values; those that are parameters of [`Self::effects`]
    /// start at the values given there.
    pub unknowns: Vec<Unknown>,
    /// Working conditions under which the machine is simulated and measured.
    pub conditions: Vec<Condition>,
    /// Channels of the simulation under each condition, with their measured records.
    pub channels: Vec<Channel>,
    /// Objective that a calibration minimises.
    pub objective: Objective,
}

impl Case {
    /// Returns the index of a condition by its name.
    pub fn condition(&self, name: &str) -> Option<usize> {
        self.conditions
            .iter()
            .position(|condition| condition.name == name)
    }

    /// Returns the channels of a condition with their indices in [`Self::channels`], in the order of the
    /// curves in replies.
    pub fn channels_of(&self, condition: usize) -> impl Iterator<Item = (usize, &Channel)> {
        let channels = self.channels.iter().enumerate();
        channels.filter(move |(_, channel)| channel.condition == condition)
    }

    /// Returns the measured channels of a condition, with their indices in [`Self::channels`] and their
    /// records.
    pub fn measured(
        &self,
        condition: usize,
    ) -> impl Iterator<Item = (usize, &Channel, &ChannelRecord)> {
        self.channels_of(condition)
            .filter_map(|(at, channel)| Some((at, channel, channel.record.as_ref()?)))
    }

    /// Returns whether any channel of a condition was measured.
    pub fn is_measured(&self, condition: usize) -> bool {
        self.measured(condition).next().is_some()
    }

    /// Returns the common unit of the channels in the objective; `None` if their units differ.
    pub fn objective_unit(&self) -> Option<&str> {
        let mut units = self.objective.terms.iter().filter_map(|term| {
            let channel = self.channels.iter().find(|it| it.name == term.channel)?;
            Some(channel.unit.as_str())
        });
        let first = units.next()?;
        units.all(|unit| unit == first).then_some(first)
    }

    /// Returns the start values of the unknowns, in declared units.
    pub fn start(&self) -> Vec<f64> {
        self.unknowns.iter().map(|unknown| unknown.start).collect()
    }

    /// Returns whether any unknown is a parameter of an effect, in which case each individual needs a machine
    /// model of its own.
    pub fn has_unknown_effects(&self) -> bool {
        let mut unknowns = self.unknowns.iter();
        unknowns.any(|unknown| unknown.of_effect().is_some())
    }
}
