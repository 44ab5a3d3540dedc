//! Nuisance parameters of a record as unknowns of every model, in standard deviations from their absent
//! value.
//!
//! An added effect replaces the nuisance parameter that stands for it; its size is then the whole size of the
//! effect.
use crate::model::parameter::absent;
use protocol::announce::EffectDescriptor;
use record::{Acts, Nuisance};
use record::{Curves, Record};
use search::least_squares::{Prior, Variable};

/// Bound of a nuisance parameter: largest distance from its absent value (prior standard deviations).
const FARTHEST: f64 = 30.0;
/// Initial finite-difference step of a nuisance parameter (prior standard deviations).
const STEP: f64 = 0.5;

/// Nuisance parameter, with the effect of the library that it stands for.
#[derive(Clone, Debug)]
pub struct NuisanceParameter {
    /// Measurement error that the parameter describes.
    pub nuisance: Nuisance,
    /// Library effect that simulates the measurement error, and the index of its size parameter; `None` for
    /// the gain of a channel.
    effect: Option<(EffectDescriptor, usize)>,
    /// Largest allowed distance of the parameter from its absent value (prior standard deviations).
    pub(crate) farthest: f64,
}

impl NuisanceParameter {
    /// Collects the nuisance parameters that a library can simulate or that need no simulation. Those with a
    /// standard deviation of zero are left out.
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

    /// Returns the library effect that simulates the nuisance parameter, and the index of its size parameter.
    pub(crate) fn effect(&self) -> Option<(&EffectDescriptor, usize)> {
        self.effect.as_ref().map(|(effect, k)| (effect, *k))
    }

    /// Returns whether the nuisance parameter stands for the effect `id`.
    pub(crate) fn is(&self, id: &str) -> bool {
        self.effect.is_some() && self.nuisance.id == id
    }

    /// Removes the limit of the parameter, so that only its prior holds it.
    pub(crate) const fn release(&mut self) {
        self.farthest = FARTHEST;
    }

    /// Returns the nuisance parameter as a variable of the search.
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

    /// Converts a value of the nuisance parameter from prior standard deviations into units of the scale of
    /// the effect's parameter; zero for a gain.
    pub(crate) fn in_scales(&self, x: f64) -> f64 {
        self.effect().map_or(0.0, |(effect, k)| {
            x * self.nuisance.deviation / effect.parameters[k].scale
        })
    }

    /// Returns the index of the channel whose gain the nuisance parameter is; `None` if it is no gain of a
    /// channel of the record.
    pub(crate) fn channel(&self, record: &Record) -> Option<usize> {
        let Acts::Gain { curve } = self.nuisance.acts else {
            return None;
        };
        record.channels.iter().position(|own| own.curve == curve)
    }
}

/// Collects the library effects that simulate nuisance parameters, each effect once, with its scaled
/// parameter values. `nuisances` gives each nuisance parameter with its value (prior standard deviations).
pub(crate) fn effects<'a>(
    nuisances: impl Iterator<Item = (&'a NuisanceParameter, f64)>,
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

/// Multiplies simulated curves by the gains that the nuisance parameters describe, channel by channel.
pub(crate) fn apply_gains<'a, I: Iterator<Item = (&'a NuisanceParameter, f64)>>(
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
