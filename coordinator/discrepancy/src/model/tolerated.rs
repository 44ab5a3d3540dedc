//! Nuisances of a record as unknowns of every model: in standard deviations from where they do nothing.
//!
//! An effect that is added takes the place of the nuisance that it is; then its size is all of it.
use crate::model::parameter::absent;
use crate::record::measured::{Curves, Record};
use crate::record::nuisance::{Acts, Nuisance};
use protocol::announce::EffectDescriptor;
use search::least_squares::{Prior, Variable};

/// Farthest from the absent value (standard deviations).
const FARTHEST: f64 = 30.0;
/// First difference step (standard deviations).
const STEP: f64 = 0.5;

/// A nuisance, and what of the library it is.
#[derive(Clone, Debug)]
pub struct Tolerated {
    /// What is known of it.
    pub nuisance: Nuisance,
    /// The effect that it is, and which of its parameters; nothing of a channel's gain.
    effect: Option<(EffectDescriptor, usize)>,
    /// Farthest from the absent value (standard deviations).
    pub(crate) farthest: f64,
}

impl Tolerated {
    /// Those of a measurement that a library can simulate, or that need no simulation; one that cannot be
    /// off is none.
    pub fn all(nuisances: &[Nuisance], library: &[EffectDescriptor]) -> Vec<Self> {
        let one = |nuisance: &Nuisance| {
            let effect = match nuisance.acts {
                Acts::Gain { .. } => None,
                Acts::Effect => {
                    let effect = library.iter().find(|effect| effect.id == nuisance.id)?;
                    let mut parameters = effect.parameters.iter();
                    let position = parameters.position(|p| p.name == nuisance.parameter)?;
                    Some((effect.clone(), position))
                }
            };
            (nuisance.deviation > 0.0).then(|| Self {
                nuisance: nuisance.clone(),
                effect,
                farthest: FARTHEST,
            })
        };
        nuisances.iter().filter_map(one).collect()
    }

    /// The effect that it is, and which of its parameters.
    pub(crate) fn effect(&self) -> Option<(&EffectDescriptor, usize)> {
        self.effect.as_ref().map(|(effect, k)| (effect, *k))
    }

    /// Whether it is this effect.
    pub(crate) fn is(&self, id: &str) -> bool {
        self.effect.is_some() && self.nuisance.id == id
    }

    /// As an unknown.
    pub(crate) fn variable(&self) -> Variable {
        let scaled = |bound: f64, absent: f64| (bound - absent) / self.nuisance.deviation;
        let [mut lower, mut upper] = [-self.farthest, self.farthest];
        if let Some((effect, k)) = self.effect() {
            let p = &effect.parameters[k];
            lower = lower.max(scaled(p.lower, p.absent));
            upper = upper.min(scaled(p.upper, p.absent));
        }
        if self.nuisance.never_negative {
            lower = 0.0;
        }
        Variable {
            start: 0.0,
            lower,
            upper,
            step: STEP,
            longest: f64::INFINITY,
            prior: Some(Prior {
                mean: 0.0,
                deviation: 1.0,
            }),
        }
    }

    /// What so many standard deviations are in scales of the effect's parameter; zero of a gain.
    pub(crate) fn in_scales(&self, x: f64) -> f64 {
        self.effect().map_or(0.0, |(effect, k)| {
            x * self.nuisance.deviation / effect.parameters[k].scale
        })
    }

    /// Its place among the channels of a record, if it is the gain of one of them.
    pub(crate) fn channel(&self, record: &Record) -> Option<usize> {
        let Acts::Gain { curve } = self.nuisance.acts else {
            return None;
        };
        record.channels.iter().position(|own| own.curve == curve)
    }
}

/// Scaled values of the effects that nuisances are, each once: `values` are those of the nuisances.
pub(crate) fn effects<'a>(
    nuisances: impl Iterator<Item = (&'a Tolerated, f64)>,
) -> Vec<(&'a EffectDescriptor, Vec<f64>)> {
    let mut all: Vec<(&EffectDescriptor, Vec<f64>)> = Vec::new();
    for (tolerated, x) in nuisances {
        let Some((effect, k)) = tolerated.effect() else {
            continue;
        };
        let known = all.iter().position(|(one, _)| one.id == effect.id);
        let at = known.unwrap_or_else(|| {
            all.push((effect, absent(effect)));
            all.len() - 1
        });
        all[at].1[k] += tolerated.in_scales(x);
    }
    all
}

/// Gives the channels of a record their gains.
pub(crate) fn read<'a, I: Iterator<Item = (&'a Tolerated, f64)>>(
    nuisances: I,
    record: &Record,
    curves: &mut Curves,
) {
    for (tolerated, x) in nuisances {
        if let Some(channel) = tolerated.channel(record) {
            let gain = 1.0 + x * tolerated.nuisance.deviation;
            for y in &mut curves[channel] {
                *y *= gain;
            }
        }
    }
}
