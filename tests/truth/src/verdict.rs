//! Verdict of the program under test, read from its JSON output.
use anyhow::Context as _;
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// Parts of the output of `horsehead diagnose CASE --output json` that are used here; the field names are
/// that output's contract.
#[derive(Clone, Debug, Default, Deserialize)]
pub struct Verdict {
    /// Overall result of the diagnosis: `nothing_detected`, `named`, `ambiguous`, `unlisted` or `unresolved`.
    pub verdict: String,
    /// Whether the verdict explains the record in part only.
    #[serde(default)]
    pub in_part: bool,
    /// Effects estimated by the diagnosis: those added to the model, then other members of their ambiguity
    /// sets (effects that the record cannot tell apart).
    #[serde(default)]
    pub effects: Vec<EffectEstimate>,
    /// Rounds of the diagnosis; each adds one effect and lists the effects it could not be told apart from.
    #[serde(default)]
    pub rounds: Vec<Round>,
    /// Smallest sizes of effects that the diagnosis can detect.
    #[serde(default)]
    pub detection_limits: Vec<Limit>,
    /// Shares of the unexplained measured variance (gap) that the added effects explain.
    #[serde(default)]
    pub gap: Gap,
    /// Effects that changes of the unknown coefficients imitate, so that the record cannot reveal them.
    #[serde(default)]
    pub absorbed: Vec<Absorbed>,
    /// Estimated nuisance parameters of the instruments.
    #[serde(default)]
    pub nuisances: Vec<Nuisance>,
}

/// Effect that the diagnosis cannot detect in the record because changes of the unknown model coefficients
/// imitate it.
#[derive(Clone, Debug, Deserialize)]
pub struct Absorbed {
    /// Identifier of the effect that the record cannot reveal.
    pub id: String,
}

/// Estimated nuisance parameter of an instrument.
#[derive(Clone, Debug, Deserialize)]
pub struct Nuisance {
    /// Identifier of the instrument effect or of the channel gain to which the parameter belongs.
    pub id: String,
    /// Name of the nuisance parameter within its effect or gain.
    pub parameter: String,
    /// 95 % confidence interval of the parameter.
    pub ci95: [f64; 2],
}

/// Effect listed in a verdict, with its estimated parameters.
#[derive(Clone, Debug, Default, Deserialize)]
pub struct EffectEstimate {
    /// Identifier of the effect.
    pub id: String,
    /// Whether the diagnosis added the effect to the model, rather than only listing it in an ambiguity set.
    #[serde(default)]
    pub added: bool,
    /// Estimated parameters of the effect by name.
    #[serde(default)]
    pub parameters: BTreeMap<String, Size>,
}

/// Estimated value of an effect's parameter, with its confidence interval.
#[derive(Clone, Debug, Deserialize)]
pub struct Size {
    /// Estimated parameter value.
    pub value: f64,
    /// 95 % confidence interval of the parameter; `None` if the diagnosis gives none.
    pub ci95: Option<[Option<f64>; 2]>,
}

/// Round of a diagnosis, in which at most one effect is added to the model.
#[derive(Clone, Debug, Default, Deserialize)]
pub struct Round {
    /// Identifier of the effect added in this round, if any.
    pub added: Option<String>,
    /// Ambiguity set: identifiers of effects that this round could not distinguish.
    #[serde(default)]
    pub set: Vec<String>,
}

/// Smallest detectable size of an effect.
#[derive(Clone, Debug, Deserialize)]
pub struct Limit {
    /// Identifier of the effect to which the detection limit belongs.
    pub id: String,
    /// Name of the parameter that measures the size of the effect.
    pub parameter: String,
    /// Smallest detectable value of the parameter; `None` if changed model coefficients imitate the effect at
    /// any size.
    pub size: Option<f64>,
}

/// Shares of the unexplained measured variance (gap) that the added effects explain.
#[derive(Clone, Debug, Default, Deserialize)]
pub struct Gap {
    other_condition: Option<Closed>,
}

#[derive(Clone, Debug, Deserialize)]
struct Closed {
    closed: Option<f64>,
}

impl Verdict {
    /// Reads a verdict from a file with the JSON output of a diagnosis.
    ///
    /// # Errors
    /// A file that cannot be read or is no verdict.
    pub fn load(path: &Path) -> anyhow::Result<Self> {
        let bytes = fs::read(path).with_context(|| format!("reading {}", path.display()))?;
        serde_json::from_slice(&bytes).with_context(|| {
            format!(
                "{} is not a valid verdict of `horsehead diagnose CASE --output json`",
                path.display()
            )
        })
    }

    /// Returns whether the verdict claims that some effect is present, whether or not it can name the effect.
    pub fn claims(&self) -> bool {
        matches!(self.verdict.as_str(), "named" | "ambiguous" | "unlisted")
    }

    /// Returns whether the verdict names specific effects, alone or as an ambiguity set.
    pub fn has_names(&self) -> bool {
        matches!(self.verdict.as_str(), "named" | "ambiguous")
    }

    /// Returns the share of the gap (unexplained variance) that the added effects close under the other
    /// working condition.
    pub fn gap_closed_in_other_condition(&self) -> Option<f64> {
        self.gap.other_condition.as_ref()?.closed
    }

    /// Returns the identifiers of the effects added to the model; none unless the verdict names effects.
    pub fn added(&self) -> impl Iterator<Item = &str> {
        let named = self.has_names();
        let added = self.effects.iter().filter(move |e| named && e.added);
        added.map(|e| e.id.as_str())
    }

    /// Returns the ambiguity set of the round that added the effect `id`, including `id` itself.
    pub fn ambiguity_set<'a>(&'a self, id: &'a str) -> BTreeSet<&'a str> {
        let round = self.rounds.iter().find(|r| r.added.as_deref() == Some(id));
        let set = round.map(|r| r.set.iter().map(String::as_str));
        set.into_iter().flatten().chain([id]).collect()
    }
}
