//! A case, resolved: everything a worker needs to simulate a machine and to score it against its
//! records, as plain data with the unit in every name.
//!
//! The coordinator reads and validates case *files* and builds this; its encoded bytes travel as
//! one blob, named by their content hash. Nothing here knows of files, of TOML or of dynamics.
mod bad_unknown;
mod channel;
mod condition;
mod effect;
mod model;
mod objective;
mod unknown;

pub use bad_unknown::{BadUnknown, check_unknowns};
pub use channel::{Abscissa, Channel, ChannelRecord};
pub use condition::Condition;
pub use effect::{EffectSetting, merged};
pub use model::{ModelSettings, Repeats};
pub use objective::{Objective, Offset, Term};
pub use unknown::{Prior, Scale, Shares, Shift, Tie, Unknown, Valley};

use serde::{Deserialize, Serialize};

/// A machine, its records and what is asked of them. Its default is empty: enough for jobs that do nothing.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Case {
    /// Name of the machine.
    pub name: String,
    /// Which model simulates it, and what that model alone understands.
    pub model: ModelSettings,
    /// What the model has beside that: effects with their numbers.
    pub effects: Vec<EffectSetting>,
    /// Units in which the case states those numbers, effect by effect in the same order; a worker
    /// refuses one that is not its own. Empty where nobody stated any.
    pub effect_units: Vec<Vec<String>>,
    /// The unknown numbers, in the order of every individual's values; parameters of
    /// [`Self::effects`] start at the values that they have there.
    pub unknowns: Vec<Unknown>,
    /// Working conditions.
    pub conditions: Vec<Condition>,
    /// What a simulation shows under each condition, with what was measured of it.
    pub channels: Vec<Channel>,
    /// What a calibration minimises.
    pub objective: Objective,
}

impl Case {
    /// Position of a condition by its name.
    pub fn condition(&self, name: &str) -> Option<usize> {
        self.conditions
            .iter()
            .position(|condition| condition.name == name)
    }

    /// The channels of a condition with their places in [`Self::channels`], in the order in which
    /// replies give their curves.
    pub fn channels_of(&self, condition: usize) -> impl Iterator<Item = (usize, &Channel)> {
        let channels = self.channels.iter().enumerate();
        channels.filter(move |(_, channel)| channel.condition == condition)
    }

    /// The channels of a condition that were measured, with their places and records.
    pub fn measured(
        &self,
        condition: usize,
    ) -> impl Iterator<Item = (usize, &Channel, &ChannelRecord)> {
        self.channels_of(condition)
            .filter_map(|(at, channel)| Some((at, channel, channel.record.as_ref()?)))
    }

    /// Whether anything was measured under a condition.
    pub fn is_measured(&self, condition: usize) -> bool {
        self.measured(condition).next().is_some()
    }

    /// The unit of the channels that the objective sums; none where they have not one in common.
    pub fn objective_unit(&self) -> Option<&str> {
        let mut units = self.objective.terms.iter().filter_map(|term| {
            let channel = self.channels.iter().find(|it| it.name == term.channel)?;
            Some(channel.unit.as_str())
        });
        let first = units.next()?;
        units.all(|unit| unit == first).then_some(first)
    }

    /// The values that a search starts from, in declared units.
    pub fn start(&self) -> Vec<f64> {
        self.unknowns.iter().map(|unknown| unknown.start).collect()
    }

    /// Whether parameters of effects are among the unknowns: then every individual is a machine of
    /// its own.
    pub fn has_unknown_effects(&self) -> bool {
        let mut unknowns = self.unknowns.iter();
        unknowns.any(|unknown| unknown.of_effect().is_some())
    }
}
