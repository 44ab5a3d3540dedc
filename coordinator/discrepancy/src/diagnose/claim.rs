//! Sizes and common traits of the effects that a diagnosis names, collected from its fit and estimates.
use crate::baseline::base::Baseline;
use crate::baseline::session::Session;
use crate::diagnose::plausibility::Size;
use crate::estimate::effect_size::{Estimate, ParameterEstimate};
use crate::estimate::spread::Spread;
use crate::hypothesis::candidate::WorkingCandidate;
use crate::hypothesis::round::WorkingRound;
use crate::model::{self, fit::Fit};
use crate::thresholds::MOST_NAMES;
use nalgebra::{Complex, DVector};
use protocol::announce::{ParameterDescriptor, Role};

/// Returns the estimated sizes of all effects in the answer of a diagnosis.
pub(crate) fn claim<L>(session: &Session<'_, L>, answer: &Fit, effects: &[Estimate]) -> Vec<Size> {
    let spread = Spread::of(&session.base.record.metric, answer);
    let added = 0..answer.model.added.len();
    let sizes = added.filter_map(|position| sizes(answer, position, effects, &spread));
    sizes.flatten().collect()
}

/// Returns the estimated sizes of the effect at a position among those of the answer; `None` where it has no estimate.
fn sizes(
    answer: &Fit,
    position: usize,
    effects: &[Estimate],
    spread: &Spread,
) -> Option<Vec<Size>> {
    let effect = &answer.model.added[position];
    let found = effects.iter().find(|own| own.id == effect.id)?;
    let first = answer.model.first_of(position);
    let places: Vec<usize> = model::sizes(effect).iter().map(|k| first + k).collect();
    let together_absent = spread.region_contains_zero(answer.x(), &places);
    let both = effect.parameters.iter().zip(&found.parameters);
    let sizes = both.filter(|(p, _)| p.role == Role::Size);
    let size = |(p, own): (&ParameterDescriptor, &ParameterEstimate)| {
        let mut nuisances = answer.model.nuisances.iter();
        let tolerated =
            nuisances.find(|one| one.is(&effect.id) && one.nuisance.parameter == p.name);
        Size {
            effect: effect.id.clone(),
            parameter: p.name.clone(),
            value: own.value,
            interval: own.interval,
            together_absent,
            bounds: [p.lower, p.upper],
            absent: p.absent,
            tolerance: tolerated.map(|one| one.nuisance.deviation),
        }
    };
    Some(sizes.map(size).collect())
}

/// Returns the reason why the ambiguity set of a round cannot be reported as answer, if there is one: too
/// many effects, or effects that have neither joint, channel nor order in common.
pub(crate) fn no_answer(base: &Baseline, round: &WorkingRound) -> Option<String> {
    let of_set = |id: &String| round.candidates.iter().find(|own| own.effect.id == *id);
    let members: Vec<&WorkingCandidate> = round.set.iter().filter_map(of_set).collect();
    let traits: Vec<Traits> = members.iter().map(|own| Traits::of(base, own)).collect();
    let common = Common::of(&traits);
    if round.set.len() > MOST_NAMES {
        return Some(format!(
            "{} effects explain the residual about equally well ({}); {}",
            round.set.len(),
            round.set.join(", "),
            common.words(base)
        ));
    }
    (members.len() > 1 && common.is_nothing()).then(|| {
        format!(
            "{} explain the residual about equally well and have neither joint nor order nor channel in common",
            round.set.join(", ")
        )
    })
}

/// Traits of an effect: the joint at which it acts, and the channel and order in which it is strongest.
struct Traits {
    joint: String,
    channel: Option<usize>,
    order: Option<usize>,
}

impl Traits {
    fn of(base: &Baseline, suspect: &WorkingCandidate) -> Self {
        let sizes = suspect.score.as_ref().map(|score| score.size.clone());
        let shown = sizes
            .filter(|sizes| sizes.len() == suspect.signature.ncols())
            .map(|sizes| {
                base.fit
                    .tangent()
                    .project(&(&suspect.signature * DVector::from_vec(sizes)))
            });
        let waves = shown
            .map(|shown| base.record.metric.waves(&shown))
            .unwrap_or_default();
        let power = |own: &Vec<Complex<f64>>| own.iter().map(Complex::norm_sqr).sum::<f64>();
        let highest = waves.iter().map(Vec::len).max().unwrap_or_default();
        let of_order = |k: usize| -> f64 {
            let own = waves.iter().filter_map(|own| own.get(k));
            own.map(Complex::norm_sqr).sum()
        };
        Self {
            joint: suspect.effect.joint.clone(),
            channel: strongest(waves.iter().map(power)),
            order: strongest((0..highest).map(of_order)),
        }
    }
}

/// Returns the index of the largest of several powers.
fn strongest(powers: impl Iterator<Item = f64>) -> Option<usize> {
    let by_power = |(_, a): &(usize, f64), (_, b): &(usize, f64)| a.total_cmp(b);
    powers.enumerate().max_by(by_power).map(|(k, _)| k)
}

/// Joint, channel and order that several effects have in common.
struct Common {
    joint: Option<String>,
    channel: Option<usize>,
    order: Option<usize>,
}

impl Common {
    fn of(all: &[Traits]) -> Self {
        let [first, rest @ ..] = all else {
            return Self {
                joint: None,
                channel: None,
                order: None,
            };
        };
        let shared = |same: &dyn Fn(&Traits) -> bool| rest.iter().all(same);
        Self {
            joint: shared(&|own| own.joint == first.joint)
                .then(|| first.joint.clone())
                .filter(|joint| !joint.is_empty()),
            channel: first
                .channel
                .filter(|c| shared(&|own| own.channel == Some(*c))),
            order: first.order.filter(|k| shared(&|own| own.order == Some(*k))),
        }
    }

    const fn is_nothing(&self) -> bool {
        self.joint.is_none() && self.channel.is_none() && self.order.is_none()
    }

    fn words(&self, base: &Baseline) -> String {
        let channels = &base.record.record.channels;
        let channel = self.channel.and_then(|c| channels.get(c));
        let parts = [
            self.joint
                .as_ref()
                .map(|joint| format!("act at the {}", joint.replace('_', " "))),
            channel.map(|own| format!("show most in {}", own.channel.title)),
            self.order
                .map(|k| format!("are strongest in order {}", k + 1)),
        ];
        let parts: Vec<String> = parts.into_iter().flatten().collect();
        if parts.is_empty() {
            "they have neither joint nor order nor channel in common".to_owned()
        } else {
            format!("all of them {}", parts.join(", "))
        }
    }
}
