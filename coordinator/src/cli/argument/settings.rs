//! Search settings given by name: parses `--set KEY=VALUE`, applies the values to a preset, and renders the
//! table of settings for the help text.
use crate::cli::output::problem::Problem;
use clap::Args;
use search::{
    strategy::{CATALOGUE, Preset, SearchPlan, Settings, SettingsError, definition::PresetSetting},
    test_function::RESONANCE,
};
use std::{collections::BTreeMap, fmt::Write as _};

/// Settings that replace those of the preset.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct SettingsChoice {
    /// Set one of the preset's settings; may be given several times, or with commas. The long help
    /// (--help) lists them.
    #[arg(
        long,
        value_name = "KEY=VALUE",
        value_delimiter = ',',
        env = "HORSEHEAD_SET",
        value_parser = pair
    )]
    pub(crate) set: Vec<(String, String)>,
}

fn pair(text: &str) -> Result<(String, String), String> {
    let (key, value) = text
        .split_once('=')
        .ok_or("write KEY=VALUE, as population=40")?;
    Ok((key.trim().to_owned(), value.trim().to_owned()))
}

/// Settings of a search after the command line's `--set` values have been applied.
#[derive(Clone, Debug)]
pub(crate) struct ResolvedSettings {
    /// Complete settings of the search: those of the preset, with the values given by `--set` in their place.
    pub(crate) settings: Settings,
    pub(crate) set: Vec<String>,
}

impl SettingsChoice {
    /// Returns the settings of a preset for a plan, with the values given by `--set` in place of the
    /// preset's.
    ///
    /// # Errors
    /// If a key is unknown or a value is not allowed for its setting.
    pub(crate) fn choose(
        &self,
        preset: &Preset,
        plan: &SearchPlan<'_>,
    ) -> Result<ResolvedSettings, Problem> {
        let usual = (preset.settings)(plan);
        let mut settings = usual.clone();
        for (key, value) in &self.set {
            let set = preset.set(&mut settings, key, value);
            set.map_err(|error| refuse(preset, error))?;
        }
        let differs = |one: &PresetSetting| {
            let (usual, value) = (one.value(&usual), one.value(&settings));
            let typed = one.setting.follows_workers && self.names(&one.key);
            (typed || usual != value).then(|| format!("{}={}", one.key, value.unwrap_or_default()))
        };
        let set = preset.settable().iter().filter_map(differs).collect();
        Ok(ResolvedSettings { settings, set })
    }

    /// Returns whether the user gave the setting `key` by `--set`.
    pub(crate) fn names(&self, key: &str) -> bool {
        self.set.iter().any(|(typed, _)| typed == key)
    }

    /// Copies from an earlier session every setting whose default depends on the number of workers and that
    /// was not set anew, so that a run can be resumed with a different number of workers.
    pub(crate) fn keep_worker_dependent(
        &self,
        chosen: &mut ResolvedSettings,
        preset: &Preset,
        earlier: Option<&Settings>,
    ) {
        let named = preset.settable();
        let follow = named.iter().filter(|one| one.setting.follows_workers);
        for one in follow.filter(|one| !self.names(&one.key)) {
            let of_run = earlier.filter(|earlier| earlier.strategy() == preset.strategy);
            let value = of_run.and_then(|earlier| one.value(earlier));
            if let Some(value) = value.or_else(|| one.value(&chosen.settings)) {
                // a value of the table is always taken
                if let Ok(shown) = preset.set(&mut chosen.settings, &one.key, &value) {
                    chosen.set.push(format!("{}={shown}", one.key));
                }
            }
        }
    }
}

/// Converts the error for a rejected setting into a message and a remedy: the nearest known key, or where the
/// allowed values are listed.
pub(crate) fn refuse(preset: &Preset, error: SettingsError) -> Problem {
    let message = format!("preset {}: {error}", preset.name);
    let help = if let SettingsError::Unknown { key, known } = error {
        let alike = |one: &&String| strsim::normalized_damerau_levenshtein(&key, one);
        let near = known.iter().max_by(|a, b| alike(a).total_cmp(&alike(b)));
        let near = near.map_or_else(String::new, |near| format!("did you mean `{near}`? "));
        format!("{near}it has: {}", known.join(", "))
    } else {
        "`horsehead calibrate --help` lists what every setting may be".to_owned()
    };
    Problem {
        message,
        remedy: help,
    }
}

/// Renders the table of all settings for the help text: allowed values, the value in every preset that has
/// the setting, and its meaning.
pub(crate) fn table() -> String {
    // of a function that has everything on which a default of the table depends
    let space = RESONANCE.space();
    let plan = SearchPlan {
        space: &space,
        workers: 1,
    };
    let mut text = String::new();
    let mut listed: Vec<String> = Vec::new();
    for one in CATALOGUE.iter().flat_map(Preset::settable) {
        if listed.contains(&one.key) {
            continue;
        }
        let allowed = one.setting.allowed();
        let _infallible = writeln!(
            text,
            "  {}={allowed}\n      {}\n      [{}]",
            one.key,
            one.setting.meaning,
            usual(&one.key, &plan)
        );
        listed.push(one.key);
    }
    text
}

/// Formats the default values of a setting, grouped by preset, for example `quick 32; paper, window 80`.
fn usual(key: &str, plan: &SearchPlan<'_>) -> String {
    let mut by_value: BTreeMap<String, Vec<&str>> = BTreeMap::new();
    for preset in CATALOGUE {
        let named = preset.settable();
        let Some(one) = named.iter().find(|one| one.key == key) else {
            continue;
        };
        let value = if one.setting.follows_workers {
            Some("by the workers".to_owned())
        } else {
            one.value(&(preset.settings)(plan))
        };
        let presets = by_value.entry(value.unwrap_or_default()).or_default();
        presets.push(preset.name);
    }
    let words = by_value.iter();
    let words = words.map(|(value, presets)| format!("{} {value}", presets.join(", ")));
    words.collect::<Vec<_>>().join("; ")
}
