//! Plan of the requested columns: validation, and construction of the perturbed machines for effect
//! parameters.
use super::column::{Coefficient, Column, Missing};
use super::differences::{Difference, REMEMBERING, SMOOTH, TOUCHING};
use super::source::Differing;
use crate::effect::{Asked, Chosen, Role, chosen};
use crate::model::Machine;
use crate::model::description::Description;
use crate::model::hook::Hooks;
use crate::model::layout::Motion;

/// Constituents of a machine: description, number of modes, effects.
#[derive(Clone, Copy, Debug)]
pub struct Origin<'a> {
    /// Description without effects.
    pub description: &'a Description,
    /// Number of head modes that are kept.
    pub modes: usize,
    /// Effects with their values.
    pub effects: &'a [Asked<'a>],
}

/// Error: a column that cannot be computed as requested; `column` is its position.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refused {
    /// Invalid effect or parameter value.
    #[error("column {column}: {refused}")]
    Effect {
        /// Position of the column.
        column: usize,
        /// Reason of the refusal.
        refused: crate::effect::Refused,
    },
    /// Effect that the machine already has, requested with further values.
    #[error(
        "column {column}: the machine already has the effect `{effect}`; leave the values of the column empty"
    )]
    Present {
        /// Position of the column.
        column: usize,
        /// Identifier of the effect.
        effect: String,
    },
    /// Invalid effects of the machine itself.
    #[error(transparent)]
    Machine(#[from] crate::effect::Refused),
}

/// Validated columns that a run is to compute.
#[derive(Debug)]
pub struct Plan {
    pub(super) ways: Vec<Way>,
}

/// Method by which a column is computed.
#[derive(Debug)]
pub(super) enum Way {
    /// Derivative with respect to a coefficient of rope or contact.
    Coefficient(Coefficient),
    /// Difference of two machines with perturbed parameters.
    Beside {
        machines: Box<[Machine; 2]>,
        difference: Difference,
        differing: Differing,
    },
    /// Hooks of a force that is linear in its amplitude, at amplitude 1.
    Pieces(Box<Hooks>),
    Nothing,
    Missing(Missing),
}

impl Plan {
    /// Validates the columns and builds the machines that they require; `machine` is the one that will be
    /// simulated, built from `origin`.
    ///
    /// # Errors
    /// [`Refused`] for the first invalid column.
    pub fn new(
        origin: &Origin<'_>,
        machine: &Machine,
        columns: &[Column],
    ) -> Result<Self, Refused> {
        let own = chosen(origin.effects)?;
        let ways = columns.iter().enumerate().map(|(at, column)| match column {
            // nothing is twisted in the plane
            Column::Coefficient(Coefficient::Kb4 | Coefficient::Cb4)
                if machine.layout.motion == Motion::Plane =>
            {
                Ok(Way::Nothing)
            }
            Column::Coefficient(coefficient) => Ok(Way::Coefficient(*coefficient)),
            Column::Parameter {
                effect,
                parameter,
                values,
            } => {
                let (effects, varied) = with(&own, at, effect, values)?;
                let descriptor = effects[varied].descriptor();
                let Some(k) = descriptor.parameter(parameter) else {
                    let refused = crate::effect::Refused::UnknownParameter {
                        effect: varied,
                        id: effect.clone(),
                        name: parameter.clone(),
                    };
                    return Err(Refused::Effect {
                        column: at,
                        refused,
                    });
                };
                Ok(way(origin, machine, &effects, (varied, k)))
            }
        });
        Ok(Self {
            ways: ways.collect::<Result<_, _>>()?,
        })
    }

    /// Returns the number of columns.
    pub const fn len(&self) -> usize {
        self.ways.len()
    }

    /// Returns whether the plan has no columns.
    pub const fn is_empty(&self) -> bool {
        self.ways.is_empty()
    }
}

/// Returns the machine's effects including the given one, and the index of that effect.
fn with(
    own: &[Chosen],
    column: usize,
    effect: &str,
    values: &[(String, f64)],
) -> Result<(Vec<Chosen>, usize), Refused> {
    let has = |one: &Chosen| one.descriptor().id == effect;
    let mut effects = own.to_vec();
    if let Some(at) = effects.iter().position(|one| has(one) && !one.is_absent()) {
        return if values.is_empty() {
            Ok((effects, at))
        } else {
            Err(Refused::Present {
                column,
                effect: effect.to_owned(),
            })
        };
    }
    effects.retain(|one| !has(one));
    let asked = Asked {
        id: effect,
        parameters: values.iter().map(|(name, x)| (&**name, *x)).collect(),
    };
    let refused = |refused| Refused::Effect { column, refused };
    effects.extend(chosen(&[asked]).map_err(refused)?);
    effects.sort_by_key(Chosen::place);
    let at = effects.iter().position(has).unwrap_or(0);
    Ok((effects, at))
}

/// Chooses the method for the column of parameter `k` of the effect at index `varied`.
fn way(
    origin: &Origin<'_>,
    machine: &Machine,
    effects: &[Chosen],
    (varied, k): (usize, usize),
) -> Way {
    let one = &effects[varied];
    let parameter = &one.descriptor().parameters[k];
    if parameter.role == Role::Shape && one.is_absent() {
        return Way::Nothing;
    }
    if parameter.whole {
        return Way::Missing(Missing::Whole);
    }
    // what is beside laws with a past changes what they remember
    if one.descriptor().generic && !machine.hooks.has_axial() {
        let mut unit = one.clone();
        unit.values[k] = 1.0;
        return machine
            .pieces_of(&*unit.build())
            .map_or(Way::Missing(Missing::NoMachine), |hooks| {
                Way::Pieces(Box::new(hooks))
            });
    }
    let built = |share: f64| {
        let difference = Difference::within(parameter, one.values[k], share);
        let machines = difference.steps.map(|step| {
            let mut effects = effects.to_vec();
            effects[varied].values[k] += step;
            beside(origin, machine, &effects, varied)
        });
        let [Some(first), Some(second)] = machines else {
            return Err(Missing::NoMachine);
        };
        if first.layout != machine.layout || second.layout != machine.layout {
            return Err(Missing::Coordinates);
        }
        let differing = Differing::between(machine, &first, one.descriptor().place);
        Ok((Box::new([first, second]), difference, differing))
    };
    let made = built(SMOOTH).and_then(|smooth| match smooth.2.terms {
        Some((terms, _)) if terms.contact.contains(&true) => built(TOUCHING),
        Some((terms, _)) if terms.joints || terms.pulls => built(REMEMBERING),
        _ => Ok(smooth),
    });
    match made {
        Err(missing) => Way::Missing(missing),
        Ok((machines, difference, differing)) => Way::Beside {
            machines,
            difference,
            differing,
        },
    }
}

/// Builds a machine with the effects that are present and with effect `stays`, even if it is absent. Returns
/// `None` if the machine is invalid.
fn beside(
    origin: &Origin<'_>,
    machine: &Machine,
    effects: &[Chosen],
    stays: usize,
) -> Option<Machine> {
    let present = effects.iter().enumerate();
    let present = present.filter(|(at, one)| *at == stays || !one.is_absent());
    let built: Vec<_> = present.map(|(_, one)| one.build()).collect();
    let beside = Machine::with_effects(origin.description.clone(), origin.modes, &built).ok()?;
    let space = machine.layout.motion == Motion::Space && beside.layout.motion == Motion::Plane;
    Some(if space { beside.in_space() } else { beside })
}
