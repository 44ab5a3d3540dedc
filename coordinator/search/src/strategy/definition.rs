//! Presets: named choices of strategy and settings, as the command line lists and modifies them.
use super::{
    ask_tell::Strategy,
    setting::{Setting, SettingsError},
    settings::Settings,
};
use crate::space::Space;

/// Named choice of strategy and settings.
pub struct Preset {
    /// Name of the preset on the command line.
    pub name: &'static str,
    /// Summary of the preset for help texts, one line.
    pub summary: &'static str,
    /// Name of the strategy: [`super::settings::StrategySettings::STRATEGY`].
    pub strategy: &'static str,
    /// Function that returns the preset's settings for a run with the given search space and number of
    /// workers.
    pub settings: fn(&SearchPlan<'_>) -> Settings,
    /// Groups of the preset's settings that can be set by name on the command line.
    pub groups: &'static [SettingGroup],
    /// Largest number of slots of which the search keeps at least half busy, on the shipped case (projected:
    /// `docs/measurements.md`, "Scaling").
    pub slots: u64,
    /// Function that builds the search from the preset's settings: [`super::settings::build_as`] of its
    /// strategy.
    pub build: Build,
}

/// Function that builds a search from settings, a space and a seed.
pub type Build = fn(&Settings, &Space, u64) -> Result<Box<dyn Strategy>, SettingsError>;

/// Search space and number of workers of a planned run, on which default settings may depend.
#[derive(Clone, Copy, Debug)]
pub struct SearchPlan<'a> {
    /// Search space.
    pub space: &'a Space,
    /// Planned number of workers of the run.
    pub workers: usize,
}

/// Group of a preset's settings, such as those of its line scan, with its own table of setting names.
#[derive(Clone, Copy, Debug)]
pub struct SettingGroup {
    /// Prefix of the command-line keys of the settings in this group.
    pub prefix: &'static str,
    /// JSON pointer from the preset's settings to the object that holds this group.
    pub pointer: &'static str,
    /// Table of the settings in this group, with their allowed values.
    pub table: &'static [Setting],
    /// Names of settings in the group's table that are not offered because they have no effect in this
    /// preset.
    pub excluded: &'static [&'static str],
}

impl SettingGroup {
    /// Creates the only group of a preset whose settings are not divided into groups.
    pub const fn whole(table: &'static [Setting]) -> Self {
        Self {
            prefix: "",
            pointer: "",
            table,
            excluded: &[],
        }
    }
}

/// Setting of a preset, with its key on the command line.
#[derive(Clone, Debug, PartialEq)]
pub struct PresetSetting {
    /// Key of the setting on the command line, as in `--set KEY=VALUE`.
    pub key: String,
    /// Allowed values and meaning of the setting.
    pub setting: Setting,
    /// JSON pointer to the value within the preset's settings.
    place: String,
}

impl Preset {
    /// Returns all settings of the preset that can be set by name, in the order of its tables.
    pub fn settable(&self) -> Vec<PresetSetting> {
        let of = |group: &SettingGroup, setting: &Setting| PresetSetting {
            key: format!("{}{}", group.prefix, setting.field),
            setting: *setting,
            place: format!("{}/{}", group.pointer, setting.field),
        };
        let groups = self.groups.iter();
        let all = groups.flat_map(|group| {
            let meant = |setting: &&Setting| !group.excluded.contains(&setting.field);
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
        let named = self.settable();
        let Some(found) = named.iter().find(|one| one.key == key) else {
            return Err(SettingsError::Unknown {
                key: key.to_owned(),
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

impl PresetSetting {
    /// Returns the value of the setting in settings of its preset, as text.
    pub fn value(&self, settings: &Settings) -> Option<String> {
        let value = settings.at(&self.place)?;
        Some(self.setting.show(value))
    }
}
