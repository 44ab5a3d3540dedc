//! A named choice of strategy and settings: what the command line offers, sets and lists.
use super::{
    ask_tell::Strategy,
    setting::{Setting, SettingsError},
    settings::Settings,
};
use crate::space::Space;

/// A named choice of strategy and settings.
pub struct Preset {
    /// As given on the command line.
    pub name: &'static str,
    /// One line for help texts.
    pub summary: &'static str,
    /// The strategy: [`super::settings::Recipe::STRATEGY`].
    pub strategy: &'static str,
    /// The settings for a plan.
    pub settings: fn(&Plan<'_>) -> Settings,
    /// What of them can be set by name.
    pub groups: &'static [Group],
    /// What tests may demand of it.
    pub promise: Promise,
    /// Makes the search: [`super::settings::build_as`] of the strategy's settings.
    pub build: Build,
}

/// Makes a search of settings over a space, from a seed.
pub type Build = fn(&Settings, &Space, u64) -> Result<Box<dyn Strategy>, SettingsError>;

/// What settings may depend on.
#[derive(Clone, Copy, Debug)]
pub struct Plan<'a> {
    /// The space that is searched.
    pub space: &'a Space,
    /// How many workers are planned.
    pub workers: usize,
}

/// A part of the settings with a table of its own.
#[derive(Clone, Copy, Debug)]
pub struct Group {
    /// What stands before each key.
    pub named: &'static str,
    /// Where the part stands in the settings, as a JSON pointer.
    pub place: &'static str,
    /// Its table.
    pub table: &'static [Setting],
    /// Fields of the table that mean nothing here.
    pub without: &'static [&'static str],
}

impl Group {
    /// All settings of a strategy that has no parts.
    pub const fn whole(table: &'static [Setting]) -> Self {
        Self {
            named: "",
            place: "",
            table,
            without: &[],
        }
    }
}

/// A setting of a preset.
#[derive(Clone, Debug, PartialEq)]
pub struct Named {
    /// As given on the command line.
    pub key: String,
    /// What it may be, and what it means.
    pub setting: Setting,
    /// Where it stands in the settings, as a JSON pointer.
    place: String,
}

/// What tests may demand of a preset beside the laws that all of them obey; the functions are those
/// of [`crate::test_function`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Promise {
    /// Fitness below which it ends on functions of one basin.
    pub one_basin: f64,
    /// Fitness below which it ends on a function of many.
    pub many_basins: f64,
    /// How near it comes to a minimum in every gene (coordinate).
    pub distance: f64,
    /// Whether its first individual is the recommended one.
    pub opens_at_recommended: bool,
    /// Evaluations within which it finds a narrow valley on a plateau, if it does.
    pub valley: Option<usize>,
    /// Whether the seed decides where it goes.
    pub chance: bool,
}

impl Preset {
    /// Everything that can be set by name, in order.
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

    /// Sets one by name; what it is now, in words.
    ///
    /// # Errors
    /// If there is none of that name, or it may not be that.
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
    /// Its value in settings of its preset, in words.
    pub fn value(&self, settings: &Settings) -> Option<String> {
        let value = settings.at(&self.place)?;
        Some(self.setting.show(value))
    }
}
