//! Parameters of an effect as unknowns of a fit, in units of their physical scale and relative to the value
//! at which the effect is absent. A size parameter is zero where the effect is absent; a shape parameter has
//! a value even then.
use protocol::announce::{EffectDescriptor, ParameterDescriptor, Role, Sign};
use protocol::case::EffectSetting;
use search::least_squares::{Prior, Variable};
use std::slice::Iter;

/// Prior standard deviation of an effect's size parameter, in units of its scale.
const SIZE_DEVIATION: f64 = 2.0;

/// Returns a parameter as a variable of the search, in units of its scale from its absent value.
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

/// Returns the setting of an effect for a simulation, from the scaled values of its parameters.
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

/// Returns the scaled parameter values of an absent effect: zero for size parameters, typical for shape
/// parameters.
pub fn absent(effect: &EffectDescriptor) -> Vec<f64> {
    effect
        .parameters
        .iter()
        .map(|p| variable(p).start)
        .collect()
}

/// Returns the indices of an effect's size parameters among its parameters.
pub fn sizes(effect: &EffectDescriptor) -> Vec<usize> {
    positions(effect, Role::Size)
}

/// Returns the indices of an effect's shape parameters among its parameters.
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

/// Returns the bounds of a parameter in units of its scale.
pub fn bounds(parameter: &ParameterDescriptor) -> [f64; 2] {
    let variable = variable(parameter);
    [variable.lower, variable.upper]
}

/// Returns the typical value of a size in units of its scale.
pub(crate) fn typical(parameter: &ParameterDescriptor) -> f64 {
    (parameter.typical - parameter.absent) / parameter.scale
}

/// Returns the scaled parameter values of an effect with the size parameters at the indices `sizes` typical
/// and all others absent.
pub fn at_typical(effect: &EffectDescriptor, sizes: &[usize]) -> Vec<f64> {
    let mut own = absent(effect);
    for &k in sizes {
        own[k] = typical(&effect.parameters[k]);
    }
    own
}

/// Returns, for each size of an effect, whether it cannot be negative.
pub(crate) fn positive(effect: &EffectDescriptor) -> Vec<bool> {
    let of = |k: usize| effect.parameters[k].sign == Sign::Positive;
    sizes(effect).into_iter().map(of).collect()
}

/// Replaces the size parameters among the scaled values of an effect by estimates, each clamped to its
/// bounds.
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
