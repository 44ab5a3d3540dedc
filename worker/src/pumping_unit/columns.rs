//! Derivatives of a condition's channels with respect to the columns (unknowns) that a job requests.
use super::{
    effect,
    machine::{description, no_condition},
    reply::megapascals,
};
use protocol::{
    case::{Case, Channel, merged},
    job::{self, Derivative, Failure, MAX_COLUMNS, Per, SimulateSpec, to_single_precision},
    pumping_unit::{self, PumpingUnit, Sensor},
};
use simulation::{
    effect::{EffectRequest, catalogue},
    model::Machine,
    sensitivity::{self, Coefficient, Column, ColumnOrigin, DerivativePlan, PlanError},
};

/// Returns the derivatives that every worker computes for the reference individual of a case, one of each
/// kind: by a coefficient, by a size and a shape parameter of an effect, and by a generic force. Effects of
/// the case keep their values.
pub(super) fn reference(case: &Case) -> Vec<job::Column> {
    let present = |effect: &str| case.effects.iter().any(|own| own.id == effect);
    let mut shape = job::Column::new("pivot_friction.creep");
    if !present("pivot_friction") {
        // the shape of an absent size does nothing
        shape.values = vec![("moment".to_owned(), 1500.0)];
    }
    let generic = catalogue()
        .iter()
        .find(|one| one.generic && !present(&one.id));
    let generic = generic.and_then(|one| {
        let parameter = one.parameters.first()?;
        Some(job::Column::new(format!("{}.{}", one.id, parameter.name)))
    });
    [
        "kb1",
        "kc",
        "stuffing_box_friction.force",
        "head_profile_wear.depth",
    ]
    .map(job::Column::new)
    .into_iter()
    .chain([shape])
    .chain(generic)
    .collect()
}

/// Derivatives that a job requests, planned on the machine that it simulates.
pub(super) struct Columns {
    pub(super) plan: DerivativePlan,
    per: Vec<Per>,
}

impl Columns {
    /// Plans the derivatives that a job requests; `None` for a job without derivatives.
    ///
    /// # Errors
    /// [`Failure::Misconfigured`] naming the first column that cannot be requested.
    pub(super) fn new(
        unit: &PumpingUnit,
        machine: &Machine,
        spec: &SimulateSpec,
    ) -> Result<Option<Self>, Failure> {
        let count = spec.columns.len();
        if count == 0 {
            return Ok(None);
        }
        if count > MAX_COLUMNS {
            let problem = format!(
                "{count} columns were requested; at most {MAX_COLUMNS} are allowed per job"
            );
            return Err(Failure::misconfigured("columns", problem));
        }
        let individual = &spec.individual;
        let working = unit.machine.conditions.get(individual.condition);
        let working = working.ok_or_else(|| no_condition(individual.condition))?;
        let description = description(&unit.machine, working)?;
        let own = effect::of_individual(&unit.case, &individual.genes)?;
        let effects = merged(&own, &individual.effects);
        let effects: Vec<EffectRequest<'_>> = effects.iter().map(effect::to_simulation).collect();
        let columns = spec.columns.iter().enumerate().map(named);
        let columns: Vec<(Column, Per)> = columns.collect::<Result<_, _>>()?;
        let (columns, per): (Vec<_>, Vec<_>) = columns.into_iter().unzip();
        let origin = ColumnOrigin {
            description: &description,
            modes: unit.machine.run.modes,
            effects: &effects,
        };
        let plan = DerivativePlan::new(&origin, machine, &columns).map_err(|it| refused(&it))?;
        Ok(Some(Self { plan, per }))
    }

    /// Converts the computed derivatives to those of the protocol, with a curve for each channel of a
    /// condition.
    pub(super) fn into_derivatives(
        self,
        case: &Case,
        condition: usize,
        found: sensitivity::Columns,
    ) -> Vec<Derivative> {
        let channels = case.channels_of(condition).map(|(_, channel)| channel);
        let channels: Vec<&Channel> = channels.collect();
        let each = found.columns.into_iter().zip(self.per);
        each.map(|(column, per)| derivative(&channels, column, per))
            .collect()
    }
}

/// Converts a requested derivative from the protocol's type to the simulation's, and returns the unit per
/// which it is taken.
fn named((at, column): (usize, &job::Column)) -> Result<(Column, Per), Failure> {
    let job::Column { name, values } = column;
    if let Some(own) = pumping_unit::Coefficient::named(name) {
        return Ok((Column::Coefficient(coefficient(own)), Per::Decade));
    }
    // a generic force has points in its own name, a parameter has none
    let parts = name.rsplit_once('.');
    let known = parts.and_then(|(effect, parameter)| {
        let mut all = catalogue().iter();
        let descriptor = all.find(|one| one.id == effect)?;
        let mut all = descriptor.parameters.iter();
        let found = all.find(|one| one.name == parameter)?;
        Some((effect, found))
    });
    let Some((effect, parameter)) = known else {
        let of_effects = catalogue().iter().flat_map(|one| {
            let each = one.parameters.iter();
            each.map(|parameter| format!("{}.{}", one.id, parameter.name))
        });
        let of_effects: Vec<String> = of_effects.collect();
        let coefficients = pumping_unit::Coefficient::ALL.map(pumping_unit::Coefficient::as_str);
        let known = coefficients.into_iter();
        let known = known.chain(of_effects.iter().map(String::as_str));
        let mut problem = format!("there is no `{name}`; {}", effect::suggestion(name, known));
        let own = parts.and_then(|(effect, _)| catalogue().iter().find(|one| one.id == effect));
        if let Some(own) = own {
            let all: Vec<&str> = own.parameters.iter().map(|p| p.name).collect();
            problem = format!("{problem} `{}` has {}", own.id, all.join(", "));
        }
        return Err(Failure::misconfigured(format!("columns[{at}]"), problem));
    };
    let column = Column::Parameter {
        effect: effect.to_owned(),
        parameter: parameter.name.to_owned(),
        values: values.clone(),
    };
    Ok((column, Per::Unit(parameter.unit.symbol().to_owned())))
}

/// Converts the name of a rope or contact coefficient from the protocol's type to the simulation's.
const fn coefficient(named: pumping_unit::Coefficient) -> Coefficient {
    use pumping_unit::Coefficient as Named;
    match named {
        Named::Kb1 => Coefficient::Kb1,
        Named::Kb23 => Coefficient::Kb23,
        Named::Kb4 => Coefficient::Kb4,
        Named::Kb56 => Coefficient::Kb56,
        Named::Cb1 => Coefficient::Cb1,
        Named::Cb23 => Coefficient::Cb23,
        Named::Cb4 => Coefficient::Cb4,
        Named::Cb56 => Coefficient::Cb56,
        Named::Kc => Coefficient::Kc,
        Named::Cc => Coefficient::Cc,
    }
}

fn refused(refused: &PlanError) -> Failure {
    let at = match refused {
        PlanError::Effect { column, .. } | PlanError::Present { column, .. } => Some(*column),
        PlanError::Machine(_) => None,
    };
    let field = at.map_or_else(|| "effects".to_owned(), |at| format!("columns[{at}]"));
    Failure::misconfigured(field, refused.to_string())
}

/// Converts a computed derivative to that of the protocol, with a curve for each channel.
fn derivative(channels: &[&Channel], column: sensitivity::Derivative, per: Per) -> Derivative {
    match column {
        sensitivity::Derivative::Curves(changes) => {
            let curve = |channel: &&Channel| match Sensor::named(&channel.name) {
                Some(Sensor::Gauge(number)) => {
                    to_single_precision(megapascals(&changes.gauge[usize::from(number) - 1]))
                }
                Some(Sensor::Position) => to_single_precision(changes.suspension.iter().copied()),
                Some(Sensor::Torque) => to_single_precision(changes.torque.iter().copied()),
                None => Vec::new(),
            };
            Derivative::Curves {
                per,
                curves: channels.iter().map(curve).collect(),
            }
        }
        sensitivity::Derivative::Zero => Derivative::Nothing { per },
        sensitivity::Derivative::Missing(missing) => Derivative::Missing {
            reason: missing.to_string(),
        },
    }
}
