//! Presets: named choices of strategy and settings, as the command line lists and modifies them.
use super::{
    ask_tell::Strategy,
    setting::{Setting, SettingsError},
    settings::Settings,
};
use crate::space::Space;

/// Named choice of strategy and settings.
pub struct Preset {
    /// Name on the command line.
    pub name: &'static str,
    /// Summary for help texts, one line.
    pub summary: &'static str,
    /// Name of the strategy: [`super::settings::Recipe::STRATEGY`].
    pub strategy: &'static str,
    /// Function that returns the settings for a plan.
    pub settings: fn(&Plan<'_>) -> Settings,
    /// Groups of settings that can be set by name.
    pub groups: &'static [Group],
    /// Accuracy and properties that tests may demand of the preset.
    pub promise: Promise,
    /// Function that builds the search: [`super::settings::build_as`] of the strategy's settings.
    pub build: Build,
}

/// Function that builds a search from settings, a space and a seed.
pub type Build = fn(&Settings, &Space, u64) -> Result<Box<dyn Strategy>, SettingsError>;

/// Circumstances of a run on which default settings may depend.
#[derive(Clone, Copy, Debug)]
pub struct Plan<'a> {
    /// Search space.
    pub space: &'a Space,
    /// Planned number of workers.
    pub workers: usize,
}

/// Part of the settings with its own table of keys.
#[derive(Clone, Copy, Debug)]
pub struct Group {
    /// Prefix of each key.
    pub named: &'static str,
    /// Position of the part in the settings, as a JSON pointer.
    pub place: &'static str,
    /// Table of the part's settings.
    pub table: &'static [Setting],
    /// Fields of the table that have no effect in this preset.
    pub without: &'static [&'static str],
}

impl Group {
    /// Creates the group of all settings of a strategy without parts.
    pub const fn whole(table: &'static [Setting]) -> Self {
        Self {
            named: "",
            place: "",
            table,
            without: &[],
        }
    }
}

/// Setting of a preset, with its key on the command line.
#[derive(Clone, Debug, PartialEq)]
pub struct Named {
    /// Key on the command line.
    pub key: String,
    /// Allowed values and meaning.
    pub setting: Setting,
    /// Position in the settings, as a JSON pointer.
    place: String,
}

/// Accuracy and properties that tests may demand of a preset, in addition to the requirements on all presets;
/// measured on the functions of [`crate::test_function`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Promise {
    /// Upper bound on the final fitness for functions with one basin of attraction.
    pub one_basin: f64,
    /// Upper bound on the final fitness for a function with many basins of attraction.
    pub many_basins: f64,
    /// Upper bound on the distance from the minimum in every gene (coordinate).
    pub distance: f64,
    /// Whether the first individual is the recommended one.
    pub opens_at_recommended: bool,
    /// Maximum number of evaluations to find a narrow valley on a plateau; `None` if the preset does not find
    /// such valleys.
    pub valley: Option<usize>,
    /// Whether the result depends on the seed.
    pub chance: bool,
}

impl Preset {
    /// Returns all settings that can be set by name, in order.
    pub fn named(&self) -> Vec<Named> {
        let of = |group: &Group, setting: &Setting| Named {
            key: format!("{}{}", group.named, setting.field),
            setting: *setting,
            place: format!("{}/{}", group.place, setting.field),
        };
        let groups = self.groups.iter();
        let all = groups.flat_map(|group| {
            let meant = |setting: &&Setting| !group.without.contains(&setting.field);
            let table = group.table.iter().filter(meant);
            table.map(move |setting| of(group, setting))
        });
        all.collect()
    }

    /// Sets a setting by name; returns the new value as text.
    ///
    /// # Errors
    /// If there is no setting of that name, or the value is not allowed.
    pub fn set(
        &self,
        settings: &mut Settings,
        key: &str,
        text: &str,
    ) -> Result<String, SettingsError> {
        let named = self.named();
        let Some(found) = named.iter().find(|one| one.key == key) else {
            return Err(SettingsError::Unknown {
                key: key.to_owned(),
                known: named.into_iter().map(|one| one.key).collect(),
            });
        };
        let value = found.setting.parse(text);
        let value = value.ok_or_else(|| found.setting.refusal(key, text))?;
        let shown = found.setting.show(&value);
        let place = settings.at_mut(&found.place);
        let absent = || SettingsError::Absent {
            key: key.to_owned(),
        };
        *place.ok_or_else(absent)? = value;
        Ok(shown)
    }
}

impl Named {
    /// Returns the value of the setting in settings of its preset, as text.
    pub fn value(&self, settings: &Settings) -> Option<String> {
        let value = settings.at(&self.place)?;
        Some(self.setting.show(value))
    }
}
