//! The parameters of an effect as unknowns: in units of their physical scale, from their absent value.
//! A size is absent where the effect is not there; a shape has a value even then.
use protocol::announce::{EffectDescriptor, ParameterDescriptor, Role, Sign};
use protocol::case::EffectSetting;
use search::least_squares::{Prior, Variable};
use std::slice::Iter;

/// Prior standard deviation of a size, in units of its scale.
const SIZE_DEVIATION: f64 = 2.0;

/// A parameter as an unknown, in units of its scale from its absent value.
pub(crate) fn variable(parameter: &ParameterDescriptor) -> Variable {
    let scaled = |value: f64| (value - parameter.absent) / parameter.scale;
    let (lower, upper) = (scaled(parameter.lower), scaled(parameter.upper));
    let lower = match parameter.sign {
        Sign::Positive if parameter.role == Role::Size => lower.max(0.0),
        Sign::Positive | Sign::Either => lower,
    };
    let (start, deviation) = match parameter.role {
        Role::Size => (0.0, SIZE_DEVIATION),
        Role::Shape => (scaled(parameter.typical), 0.5 * (upper - lower)),
    };
    Variable {
        start,
        lower,
        upper,
        step: 0.05,
        longest: f64::INFINITY,
        prior: Some(Prior {
            mean: start,
            deviation,
        }),
    }
}

/// An effect with the values of a scaled vector; one entry per parameter.
pub(crate) fn setting(effect: &EffectDescriptor, scaled: &[f64]) -> EffectSetting {
    let value = |(p, u): (&ParameterDescriptor, &f64)| {
        let value = (p.absent + u * p.scale).clamp(p.lower, p.upper);
        (p.name.clone(), value)
    };
    EffectSetting {
        id: effect.id.clone(),
        parameters: effect.parameters.iter().zip(scaled).map(value).collect(),
    }
}

/// Values of an effect that is not there: sizes absent, shapes typical; scaled.
pub fn absent(effect: &EffectDescriptor) -> Vec<f64> {
    effect
        .parameters
        .iter()
        .map(|p| variable(p).start)
        .collect()
}

/// Positions of an effect's sizes among its parameters.
pub fn sizes(effect: &EffectDescriptor) -> Vec<usize> {
    positions(effect, Role::Size)
}

/// Positions of an effect's shapes among its parameters.
pub fn shapes(effect: &EffectDescriptor) -> Vec<usize> {
    positions(effect, Role::Shape)
}

fn positions(effect: &EffectDescriptor, role: Role) -> Vec<usize> {
    let parameters = effect.parameters.iter().enumerate();
    parameters
        .filter(|(_, p)| p.role == role)
        .map(|(k, _)| k)
        .collect()
}

/// Bounds of a scaled parameter.
pub fn bounds(parameter: &ParameterDescriptor) -> [f64; 2] {
    let variable = variable(parameter);
    [variable.lower, variable.upper]
}

/// The typical value of a size, scaled.
pub(crate) fn typical(parameter: &ParameterDescriptor) -> f64 {
    (parameter.typical - parameter.absent) / parameter.scale
}

/// Scaled values of an effect at the typical sizes that are chosen by position, all others absent.
pub fn at_typical(effect: &EffectDescriptor, sizes: &[usize]) -> Vec<f64> {
    let mut own = absent(effect);
    for &k in sizes {
        own[k] = typical(&effect.parameters[k]);
    }
    own
}

/// Which of an effect's sizes cannot be negative.
pub(crate) fn positive(effect: &EffectDescriptor) -> Vec<bool> {
    let of = |k: usize| effect.parameters[k].sign == Sign::Positive;
    sizes(effect).into_iter().map(of).collect()
}

/// An effect's scaled values with its sizes at estimates, each within its bounds.
pub(crate) fn sized(
    effect: &EffectDescriptor,
    mut own: Vec<f64>,
    estimates: &mut Iter<'_, f64>,
) -> Vec<f64> {
    for (k, estimate) in sizes(effect).into_iter().zip(estimates) {
        let [lower, upper] = bounds(&effect.parameters[k]);
        own[k] = estimate.clamp(lower, upper);
    }
    own
}
