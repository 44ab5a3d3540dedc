//! A verdict of the program that is judged, as its JSON says it.
use anyhow::Context as _;
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// What is read of a verdict: the contract of `horsehead diagnose CASE --output json`.
#[derive(Clone, Debug, Default, Deserialize)]
pub struct Verdict {
    /// `nothing_detected`, `named`, `ambiguous`, `unlisted` or `unresolved`.
    pub verdict: String,
    /// Added effects, then those that these may be mistaken for.
    #[serde(default)]
    pub effects: Vec<Named>,
    /// Rounds, with what each added and could not tell apart.
    #[serde(default)]
    pub rounds: Vec<Round>,
    /// Sizes below which an effect could not have been seen.
    #[serde(default)]
    pub detection_limits: Vec<Limit>,
    /// Share of the gap that closed.
    #[serde(default)]
    pub gap: Gap,
    /// Effects that the unknowns take up, so that the record cannot show them.
    #[serde(default)]
    pub absorbed: Vec<Absorbed>,
    /// What the instruments are off by.
    #[serde(default)]
    pub nuisances: Vec<Nuisance>,
}

/// An effect that the record cannot show.
#[derive(Clone, Debug, Deserialize)]
pub struct Absorbed {
    /// What it is.
    pub id: String,
}

/// What an instrument is off by.
#[derive(Clone, Debug, Deserialize)]
pub struct Nuisance {
    /// The effect that it is, or the gain of a channel.
    pub id: String,
    /// Which of its numbers.
    pub parameter: String,
    /// The 95 % interval.
    pub ci95: [f64; 2],
}

/// An effect of a verdict.
#[derive(Clone, Debug, Default, Deserialize)]
pub struct Named {
    /// What it is.
    pub id: String,
    /// Whether it was added to the model.
    #[serde(default)]
    pub added: bool,
    /// Its numbers.
    #[serde(default)]
    pub parameters: BTreeMap<String, Size>,
}

/// A number of an effect.
#[derive(Clone, Debug, Deserialize)]
pub struct Size {
    /// Value.
    pub value: f64,
    /// The 95 % interval; null where there is none.
    pub ci95: Option<[Option<f64>; 2]>,
}

/// A round of a verdict.
#[derive(Clone, Debug, Default, Deserialize)]
pub struct Round {
    /// What it added.
    pub added: Option<String>,
    /// What it could not tell apart.
    #[serde(default)]
    pub set: Vec<String>,
}

/// A detection limit.
#[derive(Clone, Debug, Deserialize)]
pub struct Limit {
    /// The effect.
    pub id: String,
    /// Which of its numbers.
    pub parameter: String,
    /// Null where recalibration absorbs the effect.
    pub size: Option<f64>,
}

/// How far gaps closed.
#[derive(Clone, Debug, Default, Deserialize)]
pub struct Gap {
    other_condition: Option<Closed>,
}

#[derive(Clone, Debug, Deserialize)]
struct Closed {
    closed: Option<f64>,
}

impl Verdict {
    /// Reads one.
    ///
    /// # Errors
    /// A file that cannot be read or is no verdict.
    pub fn load(path: &Path) -> anyhow::Result<Self> {
        let bytes = fs::read(path).with_context(|| format!("reading {}", path.display()))?;
        serde_json::from_slice(&bytes)
            .with_context(|| format!("{} is no verdict of a diagnosis", path.display()))
    }

    /// Whether it says that something of some kind is there.
    pub fn claims(&self) -> bool {
        matches!(self.verdict.as_str(), "named" | "ambiguous" | "unlisted")
    }

    /// Whether it names effects.
    pub fn has_names(&self) -> bool {
        matches!(self.verdict.as_str(), "named" | "ambiguous")
    }

    /// Share of the gap that closed under the other condition.
    pub fn closed_elsewhere(&self) -> Option<f64> {
        self.gap.other_condition.as_ref()?.closed
    }

    /// Effects that it added to the model.
    pub fn added(&self) -> impl Iterator<Item = &str> {
        let named = self.has_names();
        let added = self.effects.iter().filter(move |e| named && e.added);
        added.map(|e| e.id.as_str())
    }

    /// What a name may stand for: the set of the round that added it.
    pub fn set_of<'a>(&'a self, id: &'a str) -> BTreeSet<&'a str> {
        let round = self.rounds.iter().find(|r| r.added.as_deref() == Some(id));
        let set = round.map(|r| r.set.iter().map(String::as_str));
        set.into_iter().flatten().chain([id]).collect()
    }
}
