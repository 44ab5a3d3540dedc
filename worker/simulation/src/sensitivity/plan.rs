//! Which columns are asked for: checked, and for every effect's parameter the machines beside it.
use super::column::{Coefficient, Column, Missing};
use super::differences::{Difference, REMEMBERING, SMOOTH, TOUCHING};
use super::source::Differing;
use crate::effect::{Asked, Chosen, Role, chosen};
use crate::model::Machine;
use crate::model::description::Description;
use crate::model::hook::Hooks;
use crate::model::layout::Motion;

/// What a machine was made of.
#[derive(Clone, Copy, Debug)]
pub struct Origin<'a> {
    /// Its description without effects.
    pub description: &'a Description,
    /// Number of head modes that are kept.
    pub modes: usize,
    /// Its effects.
    pub effects: &'a [Asked<'a>],
}

/// A column that cannot be asked for; `column` is its position.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refused {
    /// An effect or a value that cannot be.
    #[error("column {column}: {refused}")]
    Effect {
        /// Position.
        column: usize,
        /// What is wrong.
        refused: crate::effect::Refused,
    },
    /// The machine has the effect, with values of its own.
    #[error("column {column}: the machine has `{effect}` with values of its own; leave out others")]
    Present {
        /// Position.
        column: usize,
        /// The effect.
        effect: String,
    },
    /// The machine's own effects are refused.
    #[error(transparent)]
    Machine(#[from] crate::effect::Refused),
}

/// Columns that a run is asked for.
#[derive(Debug)]
pub struct Plan {
    pub(super) ways: Vec<Way>,
}

/// How a column comes about.
#[derive(Debug)]
pub(super) enum Way {
    /// Of a coefficient of the ropes.
    Coefficient(Coefficient),
    /// Of two machines beside the one that runs.
    Beside {
        machines: Box<[Machine; 2]>,
        difference: Difference,
        differing: Differing,
    },
    /// Of the pieces of a force that is linear in its size, at a size of 1.
    Pieces(Box<Hooks>),
    Nothing,
    Missing(Missing),
}

impl Plan {
    /// Checks columns and builds what they ask for; `machine` is the one that will run, made of
    /// `origin`.
    ///
    /// # Errors
    /// The first column that cannot be asked for.
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

    /// Number of columns.
    pub const fn len(&self) -> usize {
        self.ways.len()
    }

    /// Whether there are none.
    pub const fn is_empty(&self) -> bool {
        self.ways.is_empty()
    }
}

/// The machine's effects with a further one among them, and its place there.
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

/// How the column of parameter `k` of the effect at `varied` comes about.
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

/// A machine with effects, one of which may be absent and stays.
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
