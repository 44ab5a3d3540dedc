//! Catalogue of the search presets that the command line offers.
use super::{
    ask_tell::Strategy,
    cma_es,
    definition::Preset,
    l_shade,
    memetic::{generations, window},
    random,
    setting::SettingsError,
    settings::Settings,
    staged,
};
use crate::space::Space;

/// All search presets, in the order in which help texts list them.
pub const CATALOGUE: &[Preset] = &[
    staged::QUICK,
    staged::MEMETIC_AND_SCANS,
    staged::LEAST_SQUARES,
    staged::DESCENT,
    staged::HYBRID,
    generations::PAPER,
    generations::PAPER_BATCH,
    window::WINDOW,
    cma_es::CMA_ES,
    l_shade::L_SHADE,
    random::RANDOM,
    random::LATIN_HYPERCUBE,
    random::SOBOL,
];

/// Returns the search preset with this name, if the catalogue has it.
pub fn preset(name: &str) -> Option<&'static Preset> {
    CATALOGUE.iter().find(|preset| preset.name == name)
}

/// Builds the search strategy that settings describe, over a space, from a seed.
///
/// # Errors
/// If the strategy is unknown, or a setting lies outside its range.
pub fn build(
    settings: &Settings,
    space: &Space,
    seed: u64,
) -> Result<Box<dyn Strategy>, SettingsError> {
    let strategy = settings.strategy();
    let known = CATALOGUE
        .iter()
        .find(|preset| preset.strategy == strategy)
        .ok_or_else(|| SettingsError::Form {
            strategy: strategy.to_owned(),
            problem: "this version has no such strategy".to_owned(),
        })?;
    (known.build)(settings, space, seed)
}
