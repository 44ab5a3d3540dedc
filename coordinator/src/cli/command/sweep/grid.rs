//! File format of a settings grid: case, preset, fixed settings, and the values of the varied settings.
use case::document::{Document, DocumentStep};
use run::{searches::Searches, sweep_file::combinations};
use search::{
    space::Space,
    strategy::{CATALOGUE, preset},
};
use serde::Deserialize;
use std::{collections::BTreeMap, path::PathBuf};
use study::orthogonal::Factor;
use support::Problem;

/// Maximum number of searches in one sweep.
const MAX_SEARCHES: usize = 100_000;

/// Contents of a grid file, as parsed from TOML.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Grid {
    /// Case folder, relative to the folder of the grid file.
    pub(super) case: Option<PathBuf>,
    preset: Option<String>,
    /// Fixed settings shared by all searches of the grid.
    #[serde(default)]
    set: BTreeMap<String, toml::Value>,
    /// Levels (values to try) of every varied setting, by its name.
    #[serde(rename = "grid")]
    varied: BTreeMap<String, Vec<toml::Value>>,
    seeds: Option<Vec<u64>>,
    evaluations: Option<u64>,
}

impl Grid {
    /// Converts the grid into a list of searches and checks that each of them can be built.
    ///
    /// # Errors
    /// If a preset or setting is unknown, a value is not allowed, a list is empty, a seed is repeated, or
    /// there are too many searches.
    pub(super) fn searches(self, document: &Document, space: &Space) -> anyhow::Result<Searches> {
        let name = self.preset.as_deref().unwrap_or("paper");
        let Some(preset) = preset(name) else {
            let names: Vec<&str> = CATALOGUE.iter().map(|preset| preset.name).collect();
            let keys = [DocumentStep::Key("preset")];
            let help = "`horsehead calibrate --help` says what each does";
            return Err(document.field(&keys, name, names.join(", "), help).into());
        };
        let seeds = self.seeds.unwrap_or_else(|| vec![1]);
        let twice = seeds
            .iter()
            .enumerate()
            .any(|(at, seed)| seeds[..at].contains(seed));
        if seeds.is_empty() || twice {
            let value = format!("{seeds:?}");
            let help = "as seeds = [1, 2, 3]";
            let keys = [DocumentStep::Key("seeds")];
            return Err(document
                .field(&keys, value, "different seeds, one at least", help)
                .into());
        }
        if self.evaluations == Some(0) {
            let help = "a search needs one at least";
            let keys = [DocumentStep::Key("evaluations")];
            return Err(document.field(&keys, 0, "1 or more", help).into());
        }
        let word = |keys: &[DocumentStep<'_>], value: &toml::Value| match value {
            toml::Value::String(word) => Ok(word.clone()),
            toml::Value::Integer(_) | toml::Value::Float(_) | toml::Value::Boolean(_) => {
                Ok(value.to_string())
            }
            toml::Value::Datetime(_) | toml::Value::Array(_) | toml::Value::Table(_) => {
                let help = "write one value, as `calibrate --set` takes it";
                Err(document.field(keys, value, "a number, a word, true or false", help))
            }
        };
        let mut factors = Vec::new();
        for (key, values) in &self.varied {
            let keys = [DocumentStep::Key("grid"), DocumentStep::Key(key)];
            if values.is_empty() {
                let help = "as population = [40, 80]";
                return Err(document
                    .field(&keys, "[]", "one value at least", help)
                    .into());
            }
            let levels = values.iter().enumerate().map(|(index, value)| {
                let [table, key] = keys;
                word(&[table, key, DocumentStep::Index(index)], value)
            });
            factors.push(Factor::new(key, levels.collect::<Result<Vec<_>, _>>()?));
        }
        let set = self.set.iter().map(|(key, value)| {
            let keys = [DocumentStep::Key("set"), DocumentStep::Key(key)];
            Ok((key.clone(), word(&keys, value)?))
        });
        let set = set.collect::<anyhow::Result<Vec<_>>>()?;
        let named = |error: Problem| Problem {
            message: format!("{}: {}", document.path.display(), error.message),
            remedy: error.remedy,
        };
        let counts = factors
            .iter()
            .map(|factor| factor.levels.len())
            .chain([seeds.len()]);
        let count = counts.fold(1_usize, usize::saturating_mul);
        if count > MAX_SEARCHES {
            return Err(named(Problem {
                message: format!("{count} searches are too many"),
                remedy: format!("at most {MAX_SEARCHES}: take fewer values or seeds"),
            })
            .into());
        }
        let budget = (self.evaluations, seeds);
        let made = Searches::new(space, preset, &set, factors, budget);
        let (searches, _) = made.map_err(named)?;
        searches.list(space, &rows(&searches))?;
        Ok(searches)
    }
}

/// Returns every combination of levels of the varied settings, each as a list with one level index per
/// setting.
pub(super) fn rows(searches: &Searches) -> Vec<Vec<usize>> {
    let levels = searches.factors.iter().map(|factor| factor.levels.len());
    combinations(&levels.collect::<Vec<_>>())
}
