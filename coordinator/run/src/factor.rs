//! Factors of a sweep: settings of a search with their levels, `--factor KEY=A,B,C`.
use crate::settings::refuse;
use search::strategy::{Preset, Settings};
use study::orthogonal::Factor;
use support::Problem;

const JOINT: char = '+';

/// Parses a factor (setting with its levels) from the command line: `KEY=A,B,C`.
///
/// # Errors
/// If no levels follow an equals sign.
pub fn parse(text: &str) -> Result<Factor, String> {
    let (name, levels) = text
        .split_once('=')
        .ok_or("write the factor as KEY=A,B,C, for example population=40,80,120")?;
    Ok(Factor::new(name.trim(), levels.split(',').map(str::trim)))
}

/// Formats a factor as on the command line: `KEY=A,B,C`.
pub(crate) fn argument(factor: &Factor) -> String {
    format!("{}={}", factor.name, factor.levels.join(","))
}

/// Returns the keys of the settings that a factor varies together.
pub(crate) fn keys(factor: &Factor) -> impl Iterator<Item = &str> {
    factor.name.split(JOINT)
}

/// Sets the settings that a factor varies to one of its levels.
///
/// # Errors
/// If the preset lacks one of the settings, or a value is not allowed.
pub(crate) fn set(
    factor: &Factor,
    level: usize,
    preset: &Preset,
    settings: &mut Settings,
) -> Result<(), Problem> {
    for key in keys(factor) {
        let set = preset.set(settings, key, &factor.levels[level]);
        set.map_err(|error| refuse(preset, &error))?;
    }
    Ok(())
}

/// Checks factors against a preset: the preset must have every key and allow every level, and no key or level
/// may occur twice.
///
/// # Errors
/// The first violation, with its remedy.
pub(crate) fn check(
    factors: &[Factor],
    preset: &Preset,
    settings: &Settings,
) -> Result<(), Problem> {
    let mut named: Vec<&str> = Vec::new();
    for factor in factors {
        let twice = |message: String| Problem {
            message,
            remedy: "give every setting, and every value of a setting, only once".to_owned(),
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
                    "factor {}: the value {words} is given twice",
                    factor.name
                )));
            }
            met.push(settings);
        }
    }
    Ok(())
}
