//! Search settings given by name: parses `--set KEY=VALUE`, applies the values to a preset, and renders the
//! table of settings for the help text.
use crate::cli::output::problem::Problem;
use clap::Args;
use search::{
    strategy::{CATALOGUE, Preset, SearchPlan, Settings, SettingsError, definition::PresetSetting},
    test_function::RESONANCE,
};

/// Settings that replace those of the preset.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct SettingsChoice {
    /// Set one of the preset's settings, which `horsehead presets NAME` lists; may be given several times, or
    /// with commas.
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
            set.map_err(|error| refuse(preset, &error))?;
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

/// Similarity from which a mistyped key counts as another one: `populaton` is 0.9 like `population` and 0.4
/// like `points`.
const ALIKE: f64 = 0.6;

/// Converts the error for a rejected setting into a message and a remedy: the nearest known key, of this preset
/// or of another one, and the command that lists the settings.
pub(crate) fn refuse(preset: &Preset, error: &SettingsError) -> Problem {
    let name = preset.name;
    let message = format!("preset {name}: {error}");
    let list = format!("`horsehead presets {name}` lists its settings");
    let near = if let SettingsError::Unknown { key, .. } = error {
        nearest(key, preset)
    } else {
        None
    };
    let remedy = match near {
        Some((near, own)) if own.name == name => format!("did you mean `{near}`? {list}"),
        Some((near, _)) => {
            let has = |preset: &&Preset| preset.settable().iter().any(|one| one.key == near);
            let others: Vec<&str> = CATALOGUE.iter().filter(has).map(|one| one.name).collect();
            format!("`{near}` is a setting of {}; {list}", others.join(", "))
        }
        None => list,
    };
    Problem { message, remedy }
}

/// Returns the setting whose key is most like the given one, with its preset; a setting of `first` comes before
/// equal ones of other presets.
fn nearest<'a>(key: &str, first: &'a Preset) -> Option<(String, &'a Preset)> {
    let presets = std::iter::once(first).chain(CATALOGUE);
    let all = presets.flat_map(|preset| {
        let settable = preset.settable().into_iter();
        settable.map(move |one| (one.key, preset))
    });
    let alike = all.map(|(near, preset)| {
        let alike = strsim::normalized_damerau_levenshtein(key, &near);
        (alike, near, preset)
    });
    let near = alike.filter(|(alike, ..)| *alike >= ALIKE);
    // of equals the first
    let best = near.reduce(|best, one| if one.0 > best.0 { one } else { best })?;
    Some((best.1, best.2))
}

/// Returns the table of a preset's settings: key with allowed values, the value in this preset, and the
/// meaning.
pub(crate) fn table(preset: &Preset) -> String {
    // of a function that has everything on which a default depends
    let space = RESONANCE.space();
    let plan = SearchPlan {
        space: &space,
        workers: 1,
    };
    let usual = (preset.settings)(&plan);
    let one = |one: PresetSetting| {
        let value = match one.value(&usual) {
            _ if one.setting.follows_workers => "by the workers".to_owned(),
            value => value.unwrap_or_default(),
        };
        let (key, allowed, meaning) = (&one.key, one.setting.allowed(), one.setting.meaning);
        format!("  {key} = {value}\n      {meaning} ({allowed})\n")
    };
    preset.settable().into_iter().map(one).collect()
}
