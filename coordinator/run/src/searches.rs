//! Searches of a sweep: base settings varied by factors and seeds, each search with the same budget of
//! evaluations.
use crate::{
    command_line::quote,
    factor::{self, check},
    settings::{self, KeyValue},
};
use anyhow::Context as _;
use search::{
    space::Space,
    strategy::{Preset, SearchPlan, Settings, build, preset},
};
use serde::{Deserialize, Serialize};
use study::orthogonal::{Factor, TrialRun};
use study::{Search, SearchResult};
use support::Problem;

/// Names of the settings (such as generations) that limit the length of a search; every preset has at least
/// one.
const LENGTHS: [&str; 3] = ["generations", "evaluations", "points"];

/// Largest number of generations, evaluations or points to which the budget sets a search's length.
const LONGEST: u64 = 1_000_000;

/// Default number of evaluations per search, used if none is given and no factor limits the length.
const EVALUATIONS: u64 = 1000;

/// Settings of the searches of a sweep that determine its result.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Searches {
    /// Name of the preset whose settings the factors vary.
    pub preset: String,
    /// Base settings of the searches, before factor levels are applied.
    pub settings: Settings,
    /// Factors of the sweep: varied settings with their levels.
    pub factors: Vec<Factor>,
    /// Number of evaluations of each search; `None` if a factor sets the length of the search.
    pub evaluations: Option<u64>,
    /// Seeds with which the search of every combination of levels is repeated.
    pub seeds: Vec<u64>,
}

impl Searches {
    /// Creates and checks the searches of a sweep; also returns the settings that were given by `--set`, as
    /// `key=value`.
    ///
    /// # Errors
    /// If the preset has no such setting, a value is not allowed, or a setting is named twice.
    pub fn new(
        space: &Space,
        preset: &Preset,
        set: &[KeyValue],
        factors: Vec<Factor>,
        (evaluations, seeds): (Option<u64>, Vec<u64>),
    ) -> Result<(Self, Vec<String>), Problem> {
        // what follows the number of workers is that of one: any crew finds the same
        let plan = SearchPlan { space, workers: 1 };
        let chosen = settings::choose(set, preset, &plan)?;
        check(&factors, preset, &chosen.settings)?;
        let varied = |key: &str| {
            factors
                .iter()
                .any(|own| factor::keys(own).any(|own| own == key))
        };
        let has = |key: &str| preset.settable().iter().any(|one| one.key == key);
        let free = |key: &str| has(key) && !varied(key) && !settings::is_given(set, key);
        let usual = Some(EVALUATIONS).filter(|_| !LENGTHS.into_iter().any(varied));
        let evaluations = evaluations.or(usual);
        let mut settings = chosen.settings;
        let mut set = |key: &str, value: u64| {
            let done = preset.set(&mut settings, key, &value.to_string());
            done.map(drop).map_err(|error| Problem {
                message: format!("preset {}: {error}", preset.name),
                remedy: format!("choose another number of evaluations, or set {key}"),
            })
        };
        if let Some(budget) = evaluations {
            for length in LENGTHS.into_iter().filter(|length| free(length)) {
                // a generation takes an evaluation at least: the budget alone ends the search
                set(length, budget.min(LONGEST))?;
            }
        }
        if free("speculation") {
            // the same search, without evaluations that are discarded: others keep the slots busy
            set("speculation", 1)?;
        }
        let searches = Self {
            preset: preset.name.to_owned(),
            settings,
            factors,
            evaluations,
            seeds,
        };
        Ok((searches, chosen.set))
    }

    /// Returns the searches for all rows (combinations of factor levels) with every seed.
    ///
    /// # Errors
    /// If the settings of a row are invalid.
    pub fn list(&self, space: &Space, rows: &[Vec<usize>]) -> anyhow::Result<Vec<Search>> {
        let preset = preset(&self.preset).context("the catalogue has lost a preset")?;
        let mut all = Vec::with_capacity(rows.len() * self.seeds.len());
        for row in rows {
            let mut settings = self.settings.clone();
            for (factor, level) in self.factors.iter().zip(row) {
                factor::set(factor, *level, preset, &mut settings)?;
            }
            for seed in &self.seeds {
                build(&settings, space, *seed).map_err(|error| Problem {
                    message: format!("{}: {error}", self.words(row)),
                    remedy: "choose other levels, or other settings with --set".to_owned(),
                })?;
                all.push(Search {
                    settings: settings.clone(),
                    seed: *seed,
                    evaluations: self.evaluations,
                });
            }
        }
        Ok(all)
    }

    /// Formats a row (combination of factor levels) as text, for example `population=40
    /// mutation_probability=0.1`.
    pub fn words(&self, row: &[usize]) -> String {
        let one = |(factor, level): (&Factor, &usize)| {
            format!("{}={}", factor.name, factor.levels[*level])
        };
        let words: Vec<String> = self.factors.iter().zip(row).map(one).collect();
        words.join(" ")
    }

    /// Combines the results of the searches with their levels and seeds, in the order of [`Searches::list`].
    pub fn tried(&self, rows: &[Vec<usize>], found: &[SearchResult]) -> Vec<TrialRun> {
        let asked = rows
            .iter()
            .flat_map(|row| self.seeds.iter().map(move |seed| (row, seed)));
        let one = |((row, seed), found): ((&Vec<usize>, &u64), &SearchResult)| TrialRun {
            levels: row.clone(),
            seed: *seed,
            objective: found
                .best
                .as_ref()
                .filter(|best| best.complete)
                .map(|best| best.fitness),
            evaluations: found.evaluations,
        };
        asked.zip(found).map(one).collect()
    }

    /// Returns the command line options that define the searches of this sweep, each word preceded by a
    /// space.
    pub fn arguments(&self) -> String {
        let mut text = String::new();
        for factor in &self.factors {
            text.extend([" --factor ", &quote(&factor::argument(factor))]);
        }
        if let Some(evaluations) = self.evaluations {
            text.extend([" --evaluations ", &evaluations.to_string()]);
        }
        text + " --seeds " + &self.seeds.len().to_string()
    }
}
