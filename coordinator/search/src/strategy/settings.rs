//! The settings of a search as data, whichever strategy it is.
use super::{ask_tell::Strategy, setting::SettingsError};
use crate::space::Space;
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use serde_json::Value;

/// Where the name of the strategy stands.
const STRATEGY: &str = "strategy";

/// The settings of one strategy, and the search that they make.
pub trait Recipe: Serialize + DeserializeOwned {
    /// Name of the strategy, as run folders keep it.
    const STRATEGY: &'static str;

    /// The search over a space, from a seed.
    ///
    /// # Errors
    /// If a setting lies outside its range.
    fn build(&self, space: &Space, seed: u64) -> Result<Box<dyn Strategy>, SettingsError>;
}

/// The settings of a search, the name of its strategy among them: with the space and a seed they
/// decide it to the last bit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Settings(Value);

impl Settings {
    /// Those of a strategy.
    pub fn of<R: Recipe>(recipe: &R) -> Self {
        // plain data: numbers, words, lists
        let mut values = serde_json::to_value(recipe).unwrap_or_default();
        values[STRATEGY] = Value::from(R::STRATEGY);
        Self(values)
    }

    /// The strategy that they are of.
    pub fn strategy(&self) -> &str {
        self.0[STRATEGY].as_str().unwrap_or_default()
    }

    /// As the strategy's own settings.
    ///
    /// # Errors
    /// If they are of another strategy, or not of the form that it has.
    pub fn read<R: Recipe>(&self) -> Result<R, SettingsError> {
        let problem = |problem: String| SettingsError::Form {
            strategy: self.strategy().to_owned(),
            problem,
        };
        if self.strategy() != R::STRATEGY {
            return Err(problem(format!("they are not of `{}`", R::STRATEGY)));
        }
        let mut values = self.0.clone();
        if let Some(fields) = values.as_object_mut() {
            fields.remove(STRATEGY);
        }
        serde_json::from_value(values).map_err(|error| problem(error.to_string()))
    }

    /// The value at a place, as a JSON pointer.
    pub(super) fn at(&self, place: &str) -> Option<&Value> {
        self.0.pointer(place)
    }

    /// The same, to change it.
    pub(super) fn at_mut(&mut self, place: &str) -> Option<&mut Value> {
        self.0.pointer_mut(place)
    }
}

/// The search that settings of a strategy make.
///
/// # Errors
/// If they are of another strategy, or one lies outside its range.
pub fn build_as<R: Recipe>(
    settings: &Settings,
    space: &Space,
    seed: u64,
) -> Result<Box<dyn Strategy>, SettingsError> {
    settings.read::<R>()?.build(space, seed)
}
