//! Scoring of a diagnosis's verdicts against the true hidden effects.
use crate::law::Nuisances;
use crate::plan::{Answer, AnswerEffect, Stratum};
use crate::verdict::{Limit, Nuisance, Verdict};

/// Test set of records with its true answer and the verdict of the diagnosis.
#[derive(Clone, Debug)]
pub struct Trial {
    /// Name of the set of records.
    pub name: String,
    /// True hidden effects and other drawn values.
    pub answer: Answer,
    /// Verdict of the diagnosis on the set of records.
    pub verdict: Verdict,
}

/// Result for a set with a single hidden effect; the variants are exhaustive and exclude each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Named first: the hidden effect is the first effect named.
    NamedFirst,
    /// Indistinguishable: the hidden effect is in the ambiguity set of the first effect named.
    InAmbiguitySet,
    /// Unobservable: no effect is named, and the hidden effect is listed as absorbed by other unknowns.
    Absorbed,
    /// Missed: no effect is named, and the hidden effect is not listed as absorbed.
    Missed,
    /// Wrong: another effect is named, whose ambiguity set does not contain the hidden one.
    WrongName,
}

impl Outcome {
    /// All outcomes with their descriptions in the score table.
    pub const ALL: [(Self, &'static str); 5] = [
        (Self::NamedFirst, "first name right"),
        (Self::InAmbiguitySet, "in the set of another name"),
        (Self::Absorbed, "not named, listed as absorbed"),
        (Self::Missed, "not named"),
        (Self::WrongName, "another name, whose set does not hold it"),
    ];
}

impl Trial {
    /// Classifies the diagnosis's verdict with regard to the first hidden effect.
    pub fn outcome(&self) -> Outcome {
        if self.first_is_right() {
            Outcome::NamedFirst
        } else if self.first_set_contains_truth() {
            Outcome::InAmbiguitySet
        } else if !self.names_no_effect() {
            Outcome::WrongName
        } else if self.lists_absorbed() {
            Outcome::Absorbed
        } else {
            Outcome::Missed
        }
    }

    fn hides(&self, id: &str) -> bool {
        self.answer.effects.iter().any(|effect| effect.id == id)
    }

    /// Counts the named effects that are hidden in the set.
    pub fn right(&self) -> usize {
        self.verdict.added().filter(|id| self.hides(id)).count()
    }

    /// Counts the named effects whose ambiguity sets contain no hidden effect.
    pub fn false_names(&self) -> usize {
        let wrong = |id: &&str| {
            !self
                .verdict
                .ambiguity_set(id)
                .iter()
                .any(|id| self.hides(id))
        };
        self.verdict.added().filter(wrong).count()
    }

    /// Returns whether the ambiguity set of the first named effect contains a hidden effect.
    pub fn first_set_contains_truth(&self) -> bool {
        self.verdict.added().next().is_some_and(|first| {
            self.verdict
                .ambiguity_set(first)
                .iter()
                .any(|id| self.hides(id))
        })
    }

    /// Returns whether the first effect that the diagnosis named is one of those hidden in the record.
    pub fn first_is_right(&self) -> bool {
        self.verdict.added().next().is_some_and(|id| self.hides(id))
    }

    /// Computes the ratio of the first hidden effect's size to its detection limit: the median of the limits
    /// reported for sets without a hidden effect that have the same noise, cycles and channels. `None` if
    /// there is no such set, or the record cannot show the effect. The limit reported for the set itself is
    /// not used, because it depends on the hidden effect.
    pub fn size_over_detection_limit(&self, all: &[Self]) -> Option<f64> {
        let effect = self.answer.effects.first()?;
        let alike = |other: &&Self| {
            let (own, other) = (&self.answer, &other.answer);
            let noise = (other.noise - own.noise).abs() <= 1e-9 * own.noise;
            other.effects.is_empty()
                && noise
                && other.cycles == own.cycles
                && other.channels == own.channels
        };
        let own = |limit: &&Limit| limit.id == effect.id && same(&limit.parameter, effect);
        let empty = all.iter().filter(alike);
        let limits = empty.filter_map(|set| set.verdict.detection_limits.iter().find(own)?.size);
        let mut limits: Vec<f64> = limits.map(f64::abs).collect();
        limits.sort_by(f64::total_cmp);
        Some(effect.value.abs() / limits.get(limits.len() / 2)?)
    }

    /// Returns, for each hidden effect that was named, the relative error of its size and whether its 95 %
    /// interval contains the true size.
    pub fn size_errors(&self) -> Vec<(f64, bool)> {
        let effects = self.answer.effects.iter();
        effects
            .filter_map(|effect| self.size_error(effect))
            .collect()
    }

    fn size_error(&self, effect: &AnswerEffect) -> Option<(f64, bool)> {
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

    /// Returns whether the verdict lists the first hidden effect as absorbed, i.e. not observable in the
    /// record.
    pub fn lists_absorbed(&self) -> bool {
        let first = self.answer.effects.first();
        first.is_some_and(|effect| self.verdict.absorbed.iter().any(|own| own.id == effect.id))
    }

    /// Returns whether the verdict names no effect.
    pub fn names_no_effect(&self) -> bool {
        self.verdict.added().next().is_none()
    }

    /// Counts the 95 % intervals of instrument nuisance parameters that contain the drawn value, and all such
    /// intervals; parameters whose effect is hidden or named are not counted.
    pub fn nuisances_held(&self) -> [usize; 2] {
        let judged = self.verdict.nuisances.iter().filter_map(|own| {
            let truth = drawn(&self.answer.nuisances, own)?;
            let named = self.hides(&own.id) || self.verdict.added().any(|id| id == own.id);
            (!named).then_some((own.ci95[0]..=own.ci95[1]).contains(&truth))
        });
        let judged: Vec<bool> = judged.collect();
        [judged.iter().filter(|held| **held).count(), judged.len()]
    }

    /// Returns a short label of the verdict's correctness for the report.
    pub fn label(&self) -> &'static str {
        if self.false_names() > 0 {
            "FALSE NAME"
        } else if self.answer.effects.is_empty() {
            if self.verdict.claims() {
                "FALSE CLAIM"
            } else {
                "right"
            }
        } else if self.right() == self.answer.effects.len() {
            "right"
        } else if self.first_set_contains_truth() {
            "in the set"
        } else if self.names_no_effect() && self.lists_absorbed() {
            "listed as absorbed"
        } else if self.verdict.verdict == "unlisted" {
            if self.answer.stratum == Stratum::Outside {
                "right"
            } else {
                "unlisted"
            }
        } else {
            "missed"
        }
    }
}

/// Returns whether a detection limit's parameter is the size parameter of a hidden effect; for effects with
/// one parameter per gauge (`step_1`), any gauge matches.
fn same(parameter: &str, effect: &AnswerEffect) -> bool {
    let stem = parameter.trim_end_matches(|c: char| c.is_ascii_digit());
    parameter == effect.parameter || stem.trim_end_matches('_') == effect.parameter
}

/// Returns the true (drawn) value of a nuisance parameter for which the verdict gives an interval; `None` if
/// none was drawn.
fn drawn(truth: &Nuisances, own: &Nuisance) -> Option<f64> {
    let gauge = own.parameter.strip_prefix("gain_").map(str::parse::<usize>);
    match (own.id.as_str(), gauge) {
        ("gauge_gain", Some(Ok(gauge))) => truth.gauge_factor.get(gauge.checked_sub(1)?).copied(),
        ("crank_angle_offset", _) => Some(truth.index_deg),
        ("amplifier_lag", _) => Some(truth.amplifier_lag_s),
        ("pivot_friction", _) => Some(truth.bearing_friction_nm),
        ("position_gain", _) => Some(truth.position),
        ("torque_gain", _) => Some(truth.torque),
        _ => None,
    }
}
