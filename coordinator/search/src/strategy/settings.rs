//! Settings of a search as JSON data, of a form common to all strategies.
use super::{ask_tell::Strategy, setting::SettingsError};
use crate::space::Space;
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use serde_json::Value;

const STRATEGY: &str = "strategy";

/// Settings of one strategy, from which its search can be built.
pub trait StrategySettings: Serialize + DeserializeOwned {
    /// Name of the strategy, as stored in run folders.
    const STRATEGY: &'static str;

    /// Builds the search of this strategy over a space, from a seed.
    ///
    /// # Errors
    /// If a setting lies outside its range.
    fn build(&self, space: &Space, seed: u64) -> Result<Box<dyn Strategy>, SettingsError>;
}

/// Settings of a search, including the name of its strategy; together with the space and a seed they
/// determine the search to the last bit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Settings(Value);

impl Settings {
    /// Wraps the settings of one strategy as general settings, together with the strategy's name.
    pub fn of<R: StrategySettings>(recipe: &R) -> Self {
        // plain data: numbers, words, lists
        let mut values = serde_json::to_value(recipe).unwrap_or_default();
        values[STRATEGY] = Value::from(R::STRATEGY);
        Self(values)
    }

    /// Returns the name of the strategy that the settings belong to.
    pub fn strategy(&self) -> &str {
        self.0[STRATEGY].as_str().unwrap_or_default()
    }

    /// Returns the settings as the strategy's own type.
    ///
    /// # Errors
    /// If the settings belong to another strategy, or do not have the form of its settings.
    pub fn read<R: StrategySettings>(&self) -> Result<R, SettingsError> {
        let problem = |problem: String| SettingsError::Form {
            strategy: self.strategy().to_owned(),
            problem,
        };
        if self.strategy() != R::STRATEGY {
            return Err(problem(format!(
                "they belong to another strategy, not to `{}`",
                R::STRATEGY
            )));
        }
        let mut values = self.0.clone();
        if let Some(fields) = values.as_object_mut() {
            fields.remove(STRATEGY);
        }
        serde_json::from_value(values).map_err(|error| problem(error.to_string()))
    }

    pub(super) fn at(&self, place: &str) -> Option<&Value> {
        self.0.pointer(place)
    }

    pub(super) fn at_mut(&mut self, place: &str) -> Option<&mut Value> {
        self.0.pointer_mut(place)
    }
}

/// Builds the search of strategy `S` from general settings.
///
/// # Errors
/// If the settings belong to another strategy, or a setting lies outside its range.
pub fn build_as<R: StrategySettings>(
    settings: &Settings,
    space: &Space,
    seed: u64,
) -> Result<Box<dyn Strategy>, SettingsError> {
    settings.read::<R>()?.build(space, seed)
}
