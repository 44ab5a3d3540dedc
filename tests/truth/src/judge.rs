//! What a verdict is worth, once the answer is open.
use crate::law::Nuisances;
use crate::plan::{Answer, AnswerEffect, Stratum};
use crate::verdict::{Limit, Nuisance, Verdict};

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
    pub fn right(&self) -> usize {
        self.verdict.added().filter(|id| self.hides(id)).count()
    }

    /// Names that are wrong, with sets that do not hold the truth.
    pub fn false_names(&self) -> usize {
        let wrong = |id: &&str| !self.verdict.set_of(id).iter().any(|id| self.hides(id));
        self.verdict.added().filter(wrong).count()
    }

    /// Whether the first name's set holds the truth.
    pub fn covered(&self) -> bool {
        self.verdict
            .added()
            .next()
            .is_some_and(|first| self.verdict.set_of(first).iter().any(|id| self.hides(id)))
    }

    /// Whether the first name is hidden.
    pub fn first_is_right(&self) -> bool {
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
    pub fn size_error(&self) -> Option<(f64, bool)> {
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

    /// Whether the verdict says that the record cannot show the first hidden effect.
    pub fn said_absorbed(&self) -> bool {
        let first = self.answer.effects.first();
        first.is_some_and(|effect| self.verdict.absorbed.iter().any(|own| own.id == effect.id))
    }

    /// Whether it names nothing and nobody.
    pub fn names_nobody(&self) -> bool {
        self.verdict.added().next().is_none()
    }

    /// Intervals of instruments that hold what was drawn, and how many there are; with an effect of the same
    /// kind hidden there is none.
    pub fn nuisances_held(&self) -> [usize; 2] {
        let judged = self.verdict.nuisances.iter().filter_map(|own| {
            let truth = drawn(&self.answer.nuisances, own)?;
            let named = self.hides(&own.id) || self.verdict.added().any(|id| id == own.id);
            (!named).then_some((own.ci95[0]..=own.ci95[1]).contains(&truth))
        });
        let judged: Vec<bool> = judged.collect();
        [judged.iter().filter(|held| **held).count(), judged.len()]
    }

    /// One word on a self.
    pub fn mark(&self) -> &'static str {
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
        } else if self.covered() {
            "in the set"
        } else if self.names_nobody() && self.said_absorbed() {
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

/// Whether a limit's parameter is the one that was drawn; where effects have one number for each gauge
/// (`step_1`), any of them.
fn same(parameter: &str, effect: &AnswerEffect) -> bool {
    let stem = parameter.trim_end_matches(|c: char| c.is_ascii_digit());
    parameter == effect.parameter || stem.trim_end_matches('_') == effect.parameter
}

/// What was drawn of what a verdict gives an interval of.
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
