//! Plan of the requested derivative columns: validation, and construction of machines with perturbed effect
//! parameters.
use super::column::{Coefficient, Column, Unavailable};
use super::differences::{Difference, HYSTERETIC_STEP, SMOOTH, TOUCHING};
use super::source::ChangedTerms;
use crate::effect::{EffectRequest, ResolvedEffect, Role, chosen};
use crate::model::Machine;
use crate::model::description::Description;
use crate::model::extension::Extensions;
use crate::model::layout::Motion;

/// Constituents from which machines with perturbed parameters are built: description, number of modes,
/// effects.
#[derive(Clone, Copy, Debug)]
pub struct ColumnOrigin<'a> {
    /// Description of the machine without effects.
    pub description: &'a Description,
    /// Number of head modes that are kept.
    pub modes: usize,
    /// Effects of the machine with their parameter values.
    pub effects: &'a [EffectRequest<'a>],
}

/// Error: a derivative that cannot be requested in this form; `column` is its position in the request.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlanError {
    /// Derivative with respect to a parameter of an invalid effect, or with an invalid parameter value.
    #[error("column {column}: {refused}")]
    Effect {
        /// Position of the invalid derivative in the request.
        column: usize,
        /// Reason why the effect or parameter value is invalid.
        refused: crate::effect::SelectionError,
    },
    /// Derivative that states parameter values for an effect that the machine already has.
    #[error(
        "column {column}: the machine already has the effect `{effect}`; leave the values of the column empty"
    )]
    Present {
        /// Position of the invalid derivative in the request.
        column: usize,
        /// Identifier of the effect that the machine already has.
        effect: String,
    },
    /// Invalid effect among those of the machine itself.
    #[error(transparent)]
    Machine(#[from] crate::effect::SelectionError),
}

/// Validated derivatives that a run is to compute, with the method for each.
#[derive(Debug)]
pub struct DerivativePlan {
    pub(super) methods: Vec<ColumnMethod>,
}

/// Method by which a requested derivative is computed.
#[derive(Debug)]
pub(super) enum ColumnMethod {
    /// Derivative with respect to a coefficient of rope or contact, computed in closed form where possible.
    Coefficient(Coefficient),
    /// Difference of two machines that are built with perturbed parameter values.
    Difference {
        machines: Box<[Machine; 2]>,
        difference: Difference,
        differing: ChangedTerms,
    },
    /// Force of an effect at amplitude 1, in whose amplitude the force is linear.
    Pieces(Box<Extensions>),
    Nothing,
    Missing(Unavailable),
}

impl DerivativePlan {
    /// Validates the requested derivatives and builds the perturbed machines that they require; `machine` is
    /// the one that will be simulated, built from `origin`.
    ///
    /// # Errors
    /// [`PlanError`] for the first invalid column.
    pub fn new(
        origin: &ColumnOrigin<'_>,
        machine: &Machine,
        columns: &[Column],
    ) -> Result<Self, PlanError> {
        let own = chosen(origin.effects)?;
        let methods = columns.iter().enumerate().map(|(at, column)| match column {
            // nothing is twisted in the plane
            Column::Coefficient(Coefficient::Kb4 | Coefficient::Cb4)
                if machine.layout.motion == Motion::Plane =>
            {
                Ok(ColumnMethod::Nothing)
            }
            Column::Coefficient(coefficient) => Ok(ColumnMethod::Coefficient(*coefficient)),
            Column::Parameter {
                effect,
                parameter,
                values,
            } => {
                let (effects, varied) = with(&own, at, effect, values)?;
                let descriptor = effects[varied].descriptor();
                let Some(k) = descriptor.parameter(parameter) else {
                    let refused = crate::effect::SelectionError::UnknownParameter {
                        effect: varied,
                        id: effect.clone(),
                        name: parameter.clone(),
                    };
                    return Err(PlanError::Effect {
                        column: at,
                        refused,
                    });
                };
                Ok(choose_method(origin, machine, &effects, (varied, k)))
            }
        });
        Ok(Self {
            methods: methods.collect::<Result<_, _>>()?,
        })
    }

    /// Returns the number of requested derivatives.
    pub const fn len(&self) -> usize {
        self.methods.len()
    }

    /// Returns whether no derivatives are requested.
    pub const fn is_empty(&self) -> bool {
        self.methods.is_empty()
    }
}

/// Returns the machine's effects together with the effect whose parameter is varied, and the index of that
/// effect in the list.
fn with(
    own: &[ResolvedEffect],
    column: usize,
    effect: &str,
    values: &[(String, f64)],
) -> Result<(Vec<ResolvedEffect>, usize), PlanError> {
    let has = |one: &ResolvedEffect| one.descriptor().id == effect;
    let mut effects = own.to_vec();
    if let Some(at) = effects.iter().position(|one| has(one) && !one.is_absent()) {
        return if values.is_empty() {
            Ok((effects, at))
        } else {
            Err(PlanError::Present {
                column,
                effect: effect.to_owned(),
            })
        };
    }
    effects.retain(|one| !has(one));
    let asked = EffectRequest {
        id: effect,
        parameters: values.iter().map(|(name, x)| (&**name, *x)).collect(),
    };
    let refused = |refused| PlanError::Effect { column, refused };
    effects.extend(chosen(&[asked]).map_err(refused)?);
    effects.sort_by_key(ResolvedEffect::place);
    let at = effects.iter().position(has).unwrap_or(0);
    Ok((effects, at))
}

/// Chooses the method for the derivative with respect to parameter `k` of the effect at index `varied`.
fn choose_method(
    origin: &ColumnOrigin<'_>,
    machine: &Machine,
    effects: &[ResolvedEffect],
    (varied, k): (usize, usize),
) -> ColumnMethod {
    let one = &effects[varied];
    let parameter = &one.descriptor().parameters[k];
    if parameter.role == Role::Shape && one.is_absent() {
        return ColumnMethod::Nothing;
    }
    if parameter.whole {
        return ColumnMethod::Missing(Unavailable::Integer);
    }
    // axial laws in space: each perturbed machine has a memory of its own, which changes with every parameter
    let axial_in_space = machine.extensions.has_axial() && machine.layout.motion == Motion::Space;
    if one.descriptor().generic && !axial_in_space {
        let mut unit = one.clone();
        unit.values[k] = 1.0;
        return machine.pieces_of(&*unit.build()).map_or(
            ColumnMethod::Missing(Unavailable::NoMachine),
            |extensions| ColumnMethod::Pieces(Box::new(extensions)),
        );
    }
    let axial = !machine.extensions.has_axial()
        || axial_in_space
        || machine
            .pieces_of(&*one.build())
            .map_or(true, |own| own.has_axial());
    let built = |share: f64| {
        let difference = Difference::within(parameter, one.values[k], share);
        let machines = difference.steps.map(|step| {
            let mut effects = effects.to_vec();
            effects[varied].values[k] += step;
            build_perturbed(origin, machine, &effects, varied)
        });
        let [Some(first), Some(second)] = machines else {
            return Err(Unavailable::NoMachine);
        };
        if first.layout != machine.layout || second.layout != machine.layout {
            return Err(Unavailable::Coordinates);
        }
        let by = (one.descriptor().place, axial);
        let differing = ChangedTerms::between(machine, &first, by);
        Ok((Box::new([first, second]), difference, differing))
    };
    let made = built(SMOOTH).and_then(|smooth| match smooth.2.terms {
        Some((terms, _)) if terms.contact.contains(&true) => built(TOUCHING),
        Some((terms, _)) if terms.joints || (terms.pulls && axial) => built(HYSTERETIC_STEP),
        _ => Ok(smooth),
    });
    match made {
        Err(missing) => ColumnMethod::Missing(missing),
        Ok((machines, difference, differing)) => ColumnMethod::Difference {
            machines,
            difference,
            differing,
        },
    }
}

/// Builds a machine with all effects that are present and with the effect at index `stays`, even if that one
/// is absent. Returns `None` if the machine is invalid.
fn build_perturbed(
    origin: &ColumnOrigin<'_>,
    machine: &Machine,
    effects: &[ResolvedEffect],
    stays: usize,
) -> Option<Machine> {
    let present = effects.iter().enumerate();
    let present = present.filter(|(at, one)| *at == stays || !one.is_absent());
    let built: Vec<_> = present.map(|(_, one)| one.build()).collect();
    let beside = Machine::with_effects(origin.description.clone(), origin.modes, &built).ok()?;
    let space = machine.layout.motion == Motion::Space && beside.layout.motion == Motion::Plane;
    Some(if space { beside.in_space() } else { beside })
}
