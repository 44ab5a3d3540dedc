//! What verdicts are worth, once the answers are open.
use crate::interval::clopper_pearson;
use crate::plan::{Answer, AnswerEffect, Stratum};
use anyhow::Context as _;
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// What is read of a verdict: the contract of `horsehead diagnose --output json`.
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
    value: f64,
    /// The 95 % interval; null where there is none.
    ci95: Option<[Option<f64>; 2]>,
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
    id: String,
    parameter: String,
    /// Null where recalibration absorbs the effect.
    size: Option<f64>,
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
    fn claims(&self) -> bool {
        matches!(self.verdict.as_str(), "named" | "ambiguous" | "unlisted")
    }

    fn has_names(&self) -> bool {
        matches!(self.verdict.as_str(), "named" | "ambiguous")
    }

    /// Effects that it added to the model.
    fn added(&self) -> impl Iterator<Item = &str> {
        let named = self.has_names();
        let added = self.effects.iter().filter(move |e| named && e.added);
        added.map(|e| e.id.as_str())
    }

    /// What a name may stand for: the set of the round that added it.
    fn set_of<'a>(&'a self, id: &'a str) -> BTreeSet<&'a str> {
        let round = self.rounds.iter().find(|r| r.added.as_deref() == Some(id));
        let set = round.map(|r| r.set.iter().map(String::as_str));
        set.into_iter().flatten().chain([id]).collect()
    }
}

/// One set with its answer and its verdict.
#[derive(Clone, Debug)]
pub struct Trial {
    /// Name of the set.
    pub name: String,
    /// What was hidden.
    pub answer: Answer,
    /// What was said.
    pub verdict: Verdict,
}

impl Trial {
    fn hides(&self, id: &str) -> bool {
        self.answer.effects.iter().any(|effect| effect.id == id)
    }

    /// Names that are right.
    fn right(&self) -> usize {
        self.verdict.added().filter(|id| self.hides(id)).count()
    }

    /// Names that are wrong, with sets that do not hold the truth.
    fn false_names(&self) -> usize {
        let wrong = |id: &&str| !self.verdict.set_of(id).iter().any(|id| self.hides(id));
        self.verdict.added().filter(wrong).count()
    }

    /// Whether the first name's set holds the truth.
    fn covered(&self) -> bool {
        self.verdict
            .added()
            .next()
            .is_some_and(|first| self.verdict.set_of(first).iter().any(|id| self.hides(id)))
    }

    fn first_is_right(&self) -> bool {
        self.verdict.added().next().is_some_and(|id| self.hides(id))
    }

    /// Size of the first hidden effect in units of the verdict's own detection limit, where it has one
    /// for it.
    pub fn over_limit(&self) -> Option<f64> {
        let effect = self.answer.effects.first()?;
        let own = |limit: &&Limit| limit.id == effect.id && same(&limit.parameter, effect);
        let limit = self.verdict.detection_limits.iter().find(own)?.size?;
        Some(effect.value.abs() / limit.abs())
    }

    /// Relative error of the first hidden effect's size, and whether its interval holds it.
    fn size_error(&self) -> Option<(f64, bool)> {
        let effect = self.answer.effects.first()?;
        let found = self
            .verdict
            .effects
            .iter()
            .find(|e| e.added && e.id == effect.id)?;
        let size = found.parameters.get(&effect.parameter)?;
        let covered = match size.ci95 {
            Some([Some(lower), Some(upper)]) => (lower..=upper).contains(&effect.value),
            _ => false,
        };
        Some(((size.value / effect.value - 1.0).abs(), covered))
    }
}

/// Whether a limit's parameter is the one that was drawn; where effects have one number for each gauge
/// (`step_1`), any of them.
fn same(parameter: &str, effect: &AnswerEffect) -> bool {
    let stem = parameter.trim_end_matches(|c: char| c.is_ascii_digit());
    parameter == effect.parameter || stem.trim_end_matches('_') == effect.parameter
}

/// Shares in words, with their intervals.
fn share(hits: usize, trials: usize) -> String {
    if trials == 0 {
        return "-".to_owned();
    }
    let [lower, upper] = clopper_pearson(hits, trials).map(|x| 100.0 * x);
    let percent = 100.0 * hits as f64 / trials as f64;
    format!("{hits}/{trials} = {percent:.0} % [{lower:.0}-{upper:.0}]")
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

/// The table: metrics by stratum, then every trial by itself.
///
/// # Errors
/// Never: text grows in memory.
pub fn table(trials: &[Trial], unjudged: usize) -> Result<String, std::fmt::Error> {
    let of = |stratum: Stratum| -> Vec<&Trial> {
        trials
            .iter()
            .filter(|t| t.answer.stratum == stratum)
            .collect()
    };
    let count =
        |set: &[&Trial], test: &dyn Fn(&Trial) -> bool| set.iter().filter(|t| test(t)).count();
    let mut out = String::new();
    let mut line = |metric: &str, target: &str, value: String| {
        writeln!(out, "| {metric} | {target} | {value} |")
    };
    line("metric", "target", "found [95 %]".to_owned())?;
    line("---", "---", "---".to_owned())?;
    let single = of(Stratum::Single);
    let large: Vec<&Trial> = single
        .iter()
        .copied()
        .filter(|t| t.over_limit().is_some_and(|x| x >= 3.0))
        .collect();
    let n = large.len();
    line(
        "single, at least 3 x limit: first name right",
        ">= 85 %",
        share(count(&large, &Trial::first_is_right), n),
    )?;
    line(
        "the same: set holds the truth",
        ">= 95 %",
        share(count(&large, &Trial::covered), n),
    )?;
    let n = single.len();
    line(
        "single, all: first name right",
        "",
        share(count(&single, &Trial::first_is_right), n),
    )?;
    let named: Vec<&Trial> = single
        .iter()
        .copied()
        .filter(|t| t.verdict.has_names())
        .collect();
    line(
        "single, named: set holds the truth",
        ">= 95 %",
        share(count(&named, &Trial::covered), named.len()),
    )?;
    let sets: Vec<f64> = named
        .iter()
        .filter_map(|t| {
            t.verdict
                .added()
                .next()
                .map(|id| t.verdict.set_of(id).len() as f64)
        })
        .collect();
    line("mean size of the set", "<= 2", mean(&sets))?;
    let false_names: usize = trials.iter().map(Trial::false_names).sum();
    let names: usize = trials.iter().map(|t| t.verdict.added().count()).sum();
    line(
        "false names of all names",
        "<= 10 %",
        share(false_names, names),
    )?;
    let zero = of(Stratum::Zero);
    line(
        "zero: any claim",
        "<= 5 %",
        share(count(&zero, &|t| t.verdict.claims()), zero.len()),
    )?;
    let double = of(Stratum::Double);
    let exact = |t: &Trial| t.right() == 2 && t.verdict.added().count() == 2;
    line(
        "double: exactly both",
        ">= 60 %",
        share(count(&double, &exact), double.len()),
    )?;
    line(
        "double: at least one",
        ">= 85 %",
        share(count(&double, &|t| t.right() > 0), double.len()),
    )?;
    let outside = of(Stratum::Outside);
    let detected: Vec<&Trial> = outside
        .iter()
        .copied()
        .filter(|t| t.verdict.verdict != "nothing_detected")
        .collect();
    let unlisted = |t: &Trial| t.verdict.verdict == "unlisted";
    line(
        "outside, detected: unlisted",
        ">= 90 %",
        share(count(&detected, &unlisted), detected.len()),
    )?;
    let below = of(Stratum::Below);
    line(
        "below the limit: any claim",
        "<= 5 %",
        share(count(&below, &|t| t.verdict.claims()), below.len()),
    )?;
    let sizes: Vec<(f64, bool)> = trials.iter().filter_map(Trial::size_error).collect();
    let error = median(sizes.iter().map(|(error, _)| 100.0 * error).collect());
    line(
        "size of a right name: median error",
        "<= 10 %",
        error.map_or("-".to_owned(), |e| format!("{e:.1} %")),
    )?;
    let covered = sizes.iter().filter(|(_, covered)| *covered).count();
    line(
        "its 95 % interval holds it",
        ">= 85 %",
        share(covered, sizes.len()),
    )?;
    let closed: Vec<f64> = trials
        .iter()
        .filter(|t| t.first_is_right())
        .filter_map(|t| t.verdict.gap.other_condition.as_ref()?.closed)
        .collect();
    line(
        "other condition: gap closed, median, right name",
        ">= 80 %",
        median(closed).map_or("-".to_owned(), |c| format!("{:.0} %", 100.0 * c)),
    )?;
    writeln!(
        out,
        "\n{} sets judged, {unjudged} without a verdict.\n",
        trials.len()
    )?;
    out.push_str(&list(trials)?);
    Ok(out)
}

fn mean(values: &[f64]) -> String {
    if values.is_empty() {
        return "-".to_owned();
    }
    format!("{:.2}", values.iter().sum::<f64>() / values.len() as f64)
}

/// Every trial: what was hidden, what was said.
fn list(trials: &[Trial]) -> Result<String, std::fmt::Error> {
    let mut out = String::new();
    writeln!(
        out,
        "| set | stratum | noise | hidden | times limit | verdict | named (set) | mark |"
    )?;
    writeln!(out, "|---|---|---|---|---|---|---|---|")?;
    let mut sorted: Vec<&Trial> = trials.iter().collect();
    sorted.sort_by_key(|t| {
        (
            t.answer.stratum,
            t.answer.effects.first().map(|e| e.id.clone()),
        )
    });
    for trial in sorted {
        let effects = trial.answer.effects.iter();
        let hidden: Vec<String> = effects
            .map(|e| format!("{} {:.3e} {}", e.id, e.value, e.unit))
            .collect();
        let names: Vec<String> = trial
            .verdict
            .added()
            .map(|id| {
                let set = trial.verdict.set_of(id);
                let others: Vec<&str> = set.into_iter().filter(|other| *other != id).collect();
                if others.is_empty() {
                    id.to_owned()
                } else {
                    format!("{id} ({})", others.join(", "))
                }
            })
            .collect();
        let over = trial
            .over_limit()
            .map_or("-".to_owned(), |x| format!("{x:.1}"));
        writeln!(
            out,
            "| {} | {} | {} | {} | {over} | {} | {} | {} |",
            trial.name,
            trial.answer.stratum.name(),
            trial.answer.noise,
            hidden.join(" + "),
            trial.verdict.verdict,
            names.join(" + "),
            mark(trial),
        )?;
    }
    Ok(out)
}

/// One word on a trial.
fn mark(trial: &Trial) -> &'static str {
    if trial.false_names() > 0 {
        "FALSE NAME"
    } else if trial.answer.effects.is_empty() {
        if trial.verdict.claims() {
            "FALSE CLAIM"
        } else {
            "right"
        }
    } else if trial.right() == trial.answer.effects.len() {
        "right"
    } else if trial.covered() {
        "in the set"
    } else if trial.verdict.verdict == "unlisted" {
        if trial.answer.stratum == Stratum::Outside {
            "right"
        } else {
            "unlisted"
        }
    } else {
        "missed"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answer(stratum: Stratum, ids: &[&str]) -> Answer {
        let effects = ids.iter().map(|id| AnswerEffect {
            id: (*id).to_owned(),
            listed: true,
            parameter: "force".to_owned(),
            value: 900.0,
            unit: "N".to_owned(),
            times_scale: 1.0,
            shape: BTreeMap::new(),
        });
        Answer {
            seed: 1,
            stratum,
            case: "case".to_owned(),
            noise: 1.0,
            cycles: 5,
            genes: BTreeMap::new(),
            effects: effects.collect(),
        }
    }

    fn trial(stratum: Stratum, ids: &[&str], verdict: &str) -> Trial {
        Trial {
            name: "set".to_owned(),
            answer: answer(stratum, ids),
            verdict: serde_json::from_str(verdict).unwrap(),
        }
    }

    const PACKING: &str = r#"{"verdict": "ambiguous",
        "effects": [
            {"id": "stuffing_box_friction", "added": true,
             "parameters": {"force": {"value": 990.0, "unit": "N", "ci95": [880.0, 1100.0]}}},
            {"id": "pivot_friction", "added": false, "parameters": {}}],
        "rounds": [{"added": "stuffing_box_friction", "set": ["stuffing_box_friction", "pivot_friction"]},
                   {"added": null, "set": []}],
        "detection_limits": [{"id": "stuffing_box_friction", "parameter": "force", "unit": "N", "size": 150.0},
                             {"id": "pivot_friction", "parameter": "moment", "unit": "N.m", "size": null}],
        "gap": {"other_condition": {"before": 0.1, "after": 0.01, "closed": 0.9, "ci95": null}}}"#;

    #[test]
    fn a_right_name_a_set_that_holds_the_truth_and_a_false_name() {
        let right = trial(Stratum::Single, &["stuffing_box_friction"], PACKING);
        assert!(right.first_is_right() && right.covered() && right.false_names() == 0);
        assert!((right.over_limit().unwrap() - 6.0).abs() < 1e-12);
        let (error, covered) = right.size_error().unwrap();
        assert!((error - 0.1).abs() < 1e-12 && covered);
        let alike = trial(Stratum::Single, &["pivot_friction"], PACKING);
        assert!(!alike.first_is_right() && alike.covered() && alike.false_names() == 0);
        let wrong = trial(Stratum::Single, &["gauge_drift"], PACKING);
        assert!(!wrong.covered() && wrong.false_names() == 1);
        assert_eq!(mark(&wrong), "FALSE NAME");
    }

    #[test]
    fn claims_are_counted_by_stratum() {
        let nothing = r#"{"verdict": "nothing_detected"}"#;
        let unlisted = r#"{"verdict": "unlisted", "effects": []}"#;
        let trials = [
            trial(Stratum::Zero, &[], nothing),
            trial(Stratum::Zero, &[], PACKING),
            trial(Stratum::Below, &["gauge_drift"], nothing),
            trial(Stratum::Outside, &["beam_gust"], unlisted),
            trial(Stratum::Outside, &["beam_gust"], nothing),
            trial(
                Stratum::Double,
                &["stuffing_box_friction", "gauge_drift"],
                PACKING,
            ),
            trial(Stratum::Single, &["stuffing_box_friction"], PACKING),
        ];
        let table = table(&trials, 2).unwrap();
        for line in [
            "| zero: any claim | <= 5 % | 1/2 = 50 % [1-99] |",
            "| below the limit: any claim | <= 5 % | 0/1 = 0 % [0-98] |",
            "| outside, detected: unlisted | >= 90 % | 1/1 = 100 % [2-100] |",
            "| double: exactly both | >= 60 % | 0/1 = 0 % [0-98] |",
            "| double: at least one | >= 85 % | 1/1 = 100 % [2-100] |",
            "| single, at least 3 x limit: first name right | >= 85 % | 1/1 = 100 % [2-100] |",
            "| false names of all names | <= 10 % | 1/3 = 33 % [1-91] |",
            "7 sets judged, 2 without a verdict.",
        ] {
            assert!(table.contains(line), "{line}\n{table}");
        }
    }
}
