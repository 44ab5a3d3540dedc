//! Effects that were asked for by name, checked against the catalogue and put in its order.
use super::catalogue::catalogue;
use super::descriptor::Descriptor;
use crate::model::hook::Effect;
use std::sync::Arc;

/// An effect asked for by name, with values in declared units; what is not named stays absent
/// (sizes) or typical (shapes).
#[derive(Clone, Debug, PartialEq)]
pub struct Asked<'a> {
    /// Identifier of the effect.
    pub id: &'a str,
    /// Names and values of its parameters.
    pub parameters: Vec<(&'a str, f64)>,
}

/// Effects that a machine has: checked, in the order of the catalogue. An effect all of whose sizes
/// are absent is left out, so that it cannot change a bit.
#[derive(Clone, Debug, Default)]
pub struct Selection {
    effects: Vec<Arc<dyn Effect>>,
}

/// An effect that cannot be added; `effect` is its position among those asked for.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refused {
    /// No effect of that name.
    #[error("there is no effect `{id}`")]
    UnknownEffect {
        /// Position.
        effect: usize,
        /// What was asked for.
        id: String,
    },
    /// The effect has no parameter of that name.
    #[error("the effect `{id}` has no parameter `{name}`")]
    UnknownParameter {
        /// Position.
        effect: usize,
        /// The effect.
        id: String,
        /// What was asked for.
        name: String,
    },
    /// The same effect, or the same parameter, twice.
    #[error("`{name}` is given twice")]
    Twice {
        /// Position.
        effect: usize,
        /// Effect or parameter.
        name: String,
    },
    /// A value that is not a number, or not between the parameter's bounds.
    #[error("is {value}; it must lie between {lower} and {upper} {unit}")]
    OutOfBounds {
        /// Position.
        effect: usize,
        /// The parameter.
        name: &'static str,
        /// Its value.
        value: f64,
        /// Least value.
        lower: f64,
        /// Greatest value.
        upper: f64,
        /// Unit of all three.
        unit: &'static str,
    },
}

impl Refused {
    /// Position of the effect among those asked for.
    pub const fn effect(&self) -> usize {
        match self {
            Self::UnknownEffect { effect, .. }
            | Self::UnknownParameter { effect, .. }
            | Self::Twice { effect, .. }
            | Self::OutOfBounds { effect, .. } => *effect,
        }
    }

    /// The parameter that is wrong, if it is one.
    pub fn parameter(&self) -> Option<&str> {
        match self {
            Self::UnknownParameter { name, .. } => Some(name),
            Self::OutOfBounds { name, .. } => Some(name),
            Self::UnknownEffect { .. } | Self::Twice { .. } => None,
        }
    }
}

impl Selection {
    /// Checks what was asked for, and puts it in the order of the catalogue.
    ///
    /// # Errors
    /// The first thing that is wrong; see [`Refused`].
    pub fn new(asked: &[Asked<'_>]) -> Result<Self, Refused> {
        let chosen = chosen(asked)?;
        let present = chosen.iter().filter(|one| !one.is_absent());
        Ok(Self {
            effects: present.map(Chosen::build).collect(),
        })
    }

    /// The effects, for [`Machine::with_effects`](crate::model::Machine::with_effects).
    pub fn effects(&self) -> &[Arc<dyn Effect>] {
        &self.effects
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.effects.is_empty()
    }
}

/// An effect of the catalogue with a value for each of its parameters, in declared units.
#[derive(Clone, Debug)]
pub(crate) struct Chosen {
    /// Place in the catalogue.
    at: usize,
    /// Values of all parameters, absent or not.
    pub(crate) values: Vec<f64>,
}

impl Chosen {
    /// What it says of itself.
    pub(crate) fn descriptor(&self) -> &'static Descriptor {
        &catalogue()[self.at]
    }

    /// Place in the catalogue, which is the order in which effects act.
    pub(crate) const fn place(&self) -> usize {
        self.at
    }

    /// Whether its values leave it absent.
    pub(crate) fn is_absent(&self) -> bool {
        self.descriptor().is_absent(&self.values)
    }

    /// The effect, be it absent or not.
    pub(crate) fn build(&self) -> Arc<dyn Effect> {
        self.descriptor().build(&self.values)
    }
}

/// Checks what was asked for, and puts it in the order of the catalogue; what is absent stays.
///
/// # Errors
/// The first thing that is wrong; see [`Refused`].
pub(crate) fn chosen(asked: &[Asked<'_>]) -> Result<Vec<Chosen>, Refused> {
    let mut chosen: Vec<Chosen> = Vec::new();
    for (effect, one) in asked.iter().enumerate() {
        let Some(at) = catalogue().iter().position(|d| d.id == one.id) else {
            return Err(Refused::UnknownEffect {
                effect,
                id: one.id.to_owned(),
            });
        };
        if chosen.iter().any(|other| other.at == at) {
            return Err(Refused::Twice {
                effect,
                name: one.id.to_owned(),
            });
        }
        let values = values(effect, at, one)?;
        chosen.push(Chosen { at, values });
    }
    chosen.sort_by_key(|one| one.at);
    Ok(chosen)
}

/// Values of all parameters, in declared units.
fn values(effect: usize, at: usize, asked: &Asked<'_>) -> Result<Vec<f64>, Refused> {
    let descriptor = &catalogue()[at];
    let mut values: Vec<f64> = descriptor.parameters.iter().map(|p| p.absent).collect();
    for (k, &(name, value)) in asked.parameters.iter().enumerate() {
        let Some(place) = descriptor.parameter(name) else {
            return Err(Refused::UnknownParameter {
                effect,
                id: asked.id.to_owned(),
                name: name.to_owned(),
            });
        };
        if asked.parameters[..k]
            .iter()
            .any(|(other, _)| *other == name)
        {
            return Err(Refused::Twice {
                effect,
                name: format!("{}.{name}", asked.id),
            });
        }
        let p = &descriptor.parameters[place];
        if !(p.lower..=p.upper).contains(&value) {
            return Err(Refused::OutOfBounds {
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
