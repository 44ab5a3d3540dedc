//! Factors of a sweep: settings of a search with the values that they take, `--factor KEY=A,B,C`.
use super::settings::refuse;
use crate::cli::output::problem::Problem;
use search::strategy::{Preset, Settings};
use study::orthogonal::Factor;

/// What stands between the names of settings that take their values together.
const JOINT: char = '+';

/// From a command line: `KEY=A,B,C`.
pub(crate) fn parse(text: &str) -> Result<Factor, String> {
    let (name, levels) = text
        .split_once('=')
        .ok_or("write KEY=A,B,C, as population=40,80,120")?;
    Ok(Factor::new(name.trim(), levels.split(',').map(str::trim)))
}

/// The same again.
pub(crate) fn words(factor: &Factor) -> String {
    format!("{}={}", factor.name, factor.levels.join(","))
}

/// The settings that a factor sets.
pub(crate) fn keys(factor: &Factor) -> impl Iterator<Item = &str> {
    factor.name.split(JOINT)
}

/// Sets a factor to one of its levels.
///
/// # Errors
/// If a preset has no such setting, or it may not be that.
pub(crate) fn set(
    factor: &Factor,
    level: usize,
    preset: &Preset,
    settings: &mut Settings,
) -> Result<(), Problem> {
    for key in keys(factor) {
        let set = preset.set(settings, key, &factor.levels[level]);
        set.map_err(|error| refuse(preset, error))?;
    }
    Ok(())
}

/// Refuses factors that a preset does not have, values that they may not take, and what is named twice.
///
/// # Errors
/// The first of them, with what there is.
pub(crate) fn check(
    factors: &[Factor],
    preset: &Preset,
    settings: &Settings,
) -> Result<(), Problem> {
    let mut named: Vec<&str> = Vec::new();
    for factor in factors {
        let twice = |message: String| Problem {
            message,
            remedy: "name every setting, and every value of it, once".to_owned(),
        };
        for key in keys(factor) {
            if named.contains(&key) {
                return Err(twice(format!(
                    "factor {}: `{key}` is set twice",
                    factor.name
                )));
            }
            named.push(key);
        }
        let mut met: Vec<Settings> = Vec::new();
        for (level, words) in factor.levels.iter().enumerate() {
            let mut settings = settings.clone();
            let done = set(factor, level, preset, &mut settings);
            done.map_err(|error| Problem {
                message: format!("factor {}: {}", factor.name, error.message),
                remedy: error.remedy,
            })?;
            if met.contains(&settings) {
                return Err(twice(format!(
                    "factor {}: {words} stands twice",
                    factor.name
                )));
            }
            met.push(settings);
        }
    }
    Ok(())
}
