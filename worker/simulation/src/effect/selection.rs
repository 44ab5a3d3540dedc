//! Selection of effects by name, checked against the catalogue and sorted into its order.
use super::catalogue::catalogue;
use super::descriptor::Descriptor;
use crate::model::extension::Effect;
use std::sync::Arc;

/// Requested effect with parameter values in declared units; an omitted size takes its absent value, an
/// omitted shape its typical value.
#[derive(Clone, Debug, PartialEq)]
pub struct EffectRequest<'a> {
    /// Identifier of the effect.
    pub id: &'a str,
    /// Names and values of the requested effect's parameters.
    pub parameters: Vec<(&'a str, f64)>,
}

/// Effects of a machine, checked and in the order of the catalogue. An effect whose sizes are all absent is
/// left out, so that it cannot change a bit of the results.
#[derive(Clone, Debug, Default)]
pub struct Selection {
    effects: Vec<Arc<dyn Effect>>,
}

/// Reason why a requested effect is refused; `effect` is its index in the request.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SelectionError {
    /// Identifier that no effect of the catalogue has.
    #[error("there is no effect `{id}`")]
    UnknownEffect {
        /// Index of the effect in the request.
        effect: usize,
        /// Requested identifier.
        id: String,
    },
    /// Parameter name that the requested effect does not have.
    #[error("the effect `{id}` has no parameter `{name}`")]
    UnknownParameter {
        /// Index, in the request, of the effect with the unknown parameter.
        effect: usize,
        /// Identifier of the effect with the unknown parameter.
        id: String,
        /// Parameter name that is unknown.
        name: String,
    },
    /// Effect or parameter that is given twice.
    #[error("`{name}` is given twice")]
    Duplicate {
        /// Index of the repeated effect in the request.
        effect: usize,
        /// Name of the repeated item: an effect identifier, or `effect.parameter`.
        name: String,
    },
    /// Value that is not a number or outside the parameter's bounds.
    #[error("is {value}; it must lie between {lower} and {upper} {unit}")]
    OutOfBounds {
        /// Index, in the request, of the effect with the refused value.
        effect: usize,
        /// Name of the parameter with the refused value.
        name: &'static str,
        /// Refused parameter value, in the declared unit.
        value: f64,
        /// Lower bound of the parameter.
        lower: f64,
        /// Upper bound of the parameter.
        upper: f64,
        /// Unit of the value and the bounds.
        unit: &'static str,
    },
}

impl SelectionError {
    /// Returns the index, in the request, of the effect that was refused.
    pub const fn effect(&self) -> usize {
        match self {
            Self::UnknownEffect { effect, .. }
            | Self::UnknownParameter { effect, .. }
            | Self::Duplicate { effect, .. }
            | Self::OutOfBounds { effect, .. } => *effect,
        }
    }

    /// Returns the name of the refused parameter, or `None` if the effect as a whole was refused.
    pub fn parameter(&self) -> Option<&str> {
        match self {
            Self::UnknownParameter { name, .. } => Some(name),
            Self::OutOfBounds { name, .. } => Some(name),
            Self::UnknownEffect { .. } | Self::Duplicate { .. } => None,
        }
    }
}

impl Selection {
    /// Checks the requested effects and sorts them into the order of the catalogue.
    ///
    /// # Errors
    /// The first error found; see [`SelectionError`].
    pub fn new(asked: &[EffectRequest<'_>]) -> Result<Self, SelectionError> {
        let chosen = chosen(asked)?;
        let present = chosen.iter().filter(|one| !one.is_absent());
        Ok(Self {
            effects: present.map(ResolvedEffect::build).collect(),
        })
    }

    /// Returns the effects, for [`Machine::with_effects`](crate::model::Machine::with_effects).
    pub fn effects(&self) -> &[Arc<dyn Effect>] {
        &self.effects
    }

    /// Returns whether no effect is selected.
    pub fn is_empty(&self) -> bool {
        self.effects.is_empty()
    }
}

/// An effect of the catalogue with a value for each of its parameters, in declared units.
#[derive(Clone, Debug)]
pub(crate) struct ResolvedEffect {
    at: usize,
    /// Values of all parameters of the effect, including absent ones, in declared units.
    pub(crate) values: Vec<f64>,
}

impl ResolvedEffect {
    pub(crate) fn descriptor(&self) -> &'static Descriptor {
        &catalogue()[self.at]
    }

    /// Returns the effect's index in the catalogue, which is the order in which effects act.
    pub(crate) const fn place(&self) -> usize {
        self.at
    }

    /// Returns whether all size parameters have their absent values, so that the effect vanishes.
    pub(crate) fn is_absent(&self) -> bool {
        self.descriptor().is_absent(&self.values)
    }

    /// Builds the effect from its values, even if all its sizes are absent.
    pub(crate) fn build(&self) -> Arc<dyn Effect> {
        self.descriptor().build(&self.values)
    }
}

/// Checks the requested effects and sorts them into the order of the catalogue; effects whose sizes are all
/// absent are kept.
///
/// # Errors
/// The first error found; see [`SelectionError`].
pub(crate) fn chosen(asked: &[EffectRequest<'_>]) -> Result<Vec<ResolvedEffect>, SelectionError> {
    let mut chosen: Vec<ResolvedEffect> = Vec::new();
    for (effect, one) in asked.iter().enumerate() {
        let Some(at) = catalogue().iter().position(|d| d.id == one.id) else {
            return Err(SelectionError::UnknownEffect {
                effect,
                id: one.id.to_owned(),
            });
        };
        if chosen.iter().any(|other| other.at == at) {
            return Err(SelectionError::Duplicate {
                effect,
                name: one.id.to_owned(),
            });
        }
        let values = values(effect, at, one)?;
        chosen.push(ResolvedEffect { at, values });
    }
    chosen.sort_by_key(|one| one.at);
    Ok(chosen)
}

/// Returns the values of all parameters of a requested effect, in declared units.
fn values(effect: usize, at: usize, asked: &EffectRequest<'_>) -> Result<Vec<f64>, SelectionError> {
    let descriptor = &catalogue()[at];
    let mut values: Vec<f64> = descriptor.parameters.iter().map(|p| p.absent).collect();
    for (k, &(name, value)) in asked.parameters.iter().enumerate() {
        let Some(place) = descriptor.parameter(name) else {
            return Err(SelectionError::UnknownParameter {
                effect,
                id: asked.id.to_owned(),
                name: name.to_owned(),
            });
        };
        if asked.parameters[..k]
            .iter()
            .any(|(other, _)| *other == name)
        {
            return Err(SelectionError::Duplicate {
                effect,
                name: format!("{}.{name}", asked.id),
            });
        }
        let p = &descriptor.parameters[place];
        if !(p.lower..=p.upper).contains(&value) {
            return Err(SelectionError::OutOfBounds {
                effect,
                name: p.name,
                value,
                lower: p.lower,
                upper: p.upper,
                unit: p.unit.symbol(),
            });
        }
        values[place] = value;
    }
    Ok(values)
}
