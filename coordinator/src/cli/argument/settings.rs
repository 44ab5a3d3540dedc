//! Search settings given by name, `--set KEY=VALUE`, and the table of settings for the help text.
use clap::Args;
use run::settings::KeyValue;
use search::{
    strategy::{Preset, SearchPlan, definition::PresetSetting},
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
    pub(crate) set: Vec<KeyValue>,
}

fn pair(text: &str) -> Result<KeyValue, String> {
    let (key, value) = text
        .split_once('=')
        .ok_or("write KEY=VALUE, as population=40")?;
    Ok((key.trim().to_owned(), value.trim().to_owned()))
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
