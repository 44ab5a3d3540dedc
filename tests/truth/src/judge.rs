//! What a verdict is worth, once the answer is open.
use crate::plan::{Answer, AnswerEffect, Stratum};
use crate::verdict::{Limit, Verdict};

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
