//! Search settings given by name, as `KEY=VALUE`: their values in place of those of a preset.
use search::strategy::{
    CATALOGUE, Preset, SearchPlan, Settings, SettingsError, definition::PresetSetting,
};
use support::Problem;

/// Key of a setting and its value, as typed.
pub type KeyValue = (String, String);

/// Settings of a search after those given by name have been applied.
#[derive(Clone, Debug)]
pub struct ResolvedSettings {
    /// Complete settings of the search: those of the preset, with the given values in their place.
    pub settings: Settings,
    /// Settings that differ from those of the preset, as `key=value`.
    pub set: Vec<String>,
}

/// Returns the settings of a preset for a plan, with the given values in place of the preset's.
///
/// # Errors
/// If a key is unknown or a value is not allowed for its setting.
pub fn choose(
    given: &[KeyValue],
    preset: &Preset,
    plan: &SearchPlan<'_>,
) -> Result<ResolvedSettings, Problem> {
    let usual = (preset.settings)(plan);
    let mut settings = usual.clone();
    for (key, value) in given {
        let set = preset.set(&mut settings, key, value);
        set.map_err(|error| refuse(preset, &error))?;
    }
    let differs = |one: &PresetSetting| {
        let (usual, value) = (one.value(&usual), one.value(&settings));
        let typed = one.setting.follows_workers && is_given(given, &one.key);
        (typed || usual != value).then(|| format!("{}={}", one.key, value.unwrap_or_default()))
    };
    let set = preset.settable().iter().filter_map(differs).collect();
    Ok(ResolvedSettings { settings, set })
}

/// Returns whether the setting `key` is among the given ones.
pub(crate) fn is_given(given: &[KeyValue], key: &str) -> bool {
    given.iter().any(|(typed, _)| typed == key)
}

/// Copies from an earlier session every setting whose default depends on the number of workers and that is not given
/// anew, so that a run can be resumed with a different number of workers.
pub fn keep_worker_dependent(
    given: &[KeyValue],
    chosen: &mut ResolvedSettings,
    preset: &Preset,
    earlier: Option<&Settings>,
) {
    let named = preset.settable();
    let follow = named.iter().filter(|one| one.setting.follows_workers);
    for one in follow.filter(|one| !is_given(given, &one.key)) {
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
