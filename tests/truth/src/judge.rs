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

/// What became of a single hidden effect. Every set is one of these.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// It is the first name.
    Right,
    /// It is in the set of the first name.
    InSet,
    /// It is not named, and listed as what the record cannot show.
    Absorbed,
    /// It is not named.
    Missed,
    /// Something else is named whose set does not hold it.
    False,
}

impl Outcome {
    /// Every outcome, with its words.
    pub const ALL: [(Self, &'static str); 5] = [
        (Self::Right, "first name right"),
        (Self::InSet, "in the set of another name"),
        (Self::Absorbed, "not named, listed as absorbed"),
        (Self::Missed, "not named"),
        (Self::False, "another name, whose set does not hold it"),
    ];
}

impl Trial {
    /// What became of its first hidden effect.
    pub fn outcome(&self) -> Outcome {
        if self.first_is_right() {
            Outcome::Right
        } else if self.covered() {
            Outcome::InSet
        } else if !self.names_nobody() {
            Outcome::False
        } else if self.said_absorbed() {
            Outcome::Absorbed
        } else {
            Outcome::Missed
        }
    }

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

    /// Size of the first hidden effect in units of the detection limit that a diagnosis of an empty set with the same noise,
    /// cycles and channels printed for it; none where there is no such set, or the record cannot show the effect. The
    /// limit that its own diagnosis prints knows what is hidden.
    pub fn over_limit(&self, all: &[Self]) -> Option<f64> {
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

    /// Relative errors of the hidden effects' sizes that are named, and whether their intervals hold them.
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
