//! `horsehead presets`: lists the presets of a search, or the settings of one.
use crate::cli::{
    argument::settings,
    output::{problem::EXIT_CODES, terminal},
};
use anyhow::Context as _;
use clap::{Args, builder::PossibleValuesParser};
use search::strategy::{CATALOGUE, Preset, preset};

/// List the ways to search that `calibrate --preset` offers, or the settings of one.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Examples:
  horsehead presets
  horsehead presets quick

{EXIT_CODES}"))]
pub(super) struct Arguments {
    /// Preset whose settings to list, with what each may be and what it is in this preset.
    #[arg(value_parser = PossibleValuesParser::new(CATALOGUE.iter().map(|preset| preset.name)))]
    name: Option<String>,
}

pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let text = match &arguments.name {
        None => format!(
            "{}\n`horsehead presets NAME` lists the settings of one; `--set KEY=VALUE` of `calibrate` changes them.\n",
            list()
        ),
        Some(name) => {
            let preset = preset(name).context("the catalogue has lost a preset")?;
            let Preset { name, summary, .. } = preset;
            format!("{name}: {summary}\n\n{}", settings::table(preset))
        }
    };
    terminal::write(&text)
}

/// Returns one line for each preset of the catalogue, with its summary.
fn list() -> String {
    let line = |preset: &Preset| format!("  {:<17}{}\n", preset.name, preset.summary);
    CATALOGUE.iter().map(line).collect()
}
