//! Conversion of effects between protocol and simulation: descriptions to the protocol, settings to the
//! simulation.
use super::genes::individual;
use protocol::announce::{self, EffectDescriptor, ParameterDescriptor};
use protocol::case::{Case, EffectSetting};
use protocol::job::Failure;
use simulation::effect::{self, EffectRequest, Selection, SelectionError, catalogue};

/// Returns descriptions of all effects of the catalogue, as announced by a worker.
pub(super) fn descriptors() -> Vec<EffectDescriptor> {
    let described = catalogue().iter().map(|d| EffectDescriptor {
        id: d.id.to_string(),
        title: d.title.to_string(),
        joint: d.joint.to_owned(),
        place: match d.place {
            effect::Place::Dynamics => announce::Place::Dynamics,
            effect::Place::Drive => announce::Place::Drive,
            effect::Place::Load => announce::Place::Load,
            effect::Place::Gauge => announce::Place::Sensor,
        },
        generic: d.generic,
        parameters: d.parameters.iter().map(parameter).collect(),
    });
    described.collect()
}

fn parameter(p: &effect::Parameter) -> ParameterDescriptor {
    ParameterDescriptor {
        name: p.name.to_owned(),
        unit: p.unit.symbol().to_owned(),
        role: match p.role {
            effect::Role::Size => announce::Role::Size,
            effect::Role::Shape => announce::Role::Shape,
        },
        sign: if p.is_one_sided() {
            announce::Sign::Positive
        } else {
            announce::Sign::Either
        },
        lower: p.lower,
        upper: p.upper,
        absent: p.absent,
        typical: p.typical,
        scale: p.scale,
    }
}

/// Converts an effect setting of the protocol to that of the simulation.
pub(super) fn to_simulation(setting: &EffectSetting) -> EffectRequest<'_> {
    let parameters = setting.parameters.iter();
    EffectRequest {
        id: &setting.id,
        parameters: parameters.map(|(name, x)| (&**name, *x)).collect(),
    }
}

/// Checks settings against the catalogue and returns them as a selection.
///
/// # Errors
/// [`Failure::Misconfigured`] naming the effect or its parameter by its place in the list, and the nearest
/// known name.
pub(super) fn selection(settings: &[EffectSetting]) -> Result<Selection, Failure> {
    let asked: Vec<EffectRequest<'_>> = settings.iter().map(to_simulation).collect();
    Selection::new(&asked).map_err(|refused| {
        let place = format!("effects[{}]", refused.effect());
        let field = match refused.parameter() {
            Some(name) => format!("{place}.parameters.{name}"),
            None => format!("{place}.id"),
        };
        Failure::misconfigured(&field, problem(&refused))
    })
}

/// Checks that the units stated by a case are those of the catalogue. Effects and parameters unknown to the
/// catalogue are left to [`selection`].
///
/// # Errors
/// [`Failure::Misconfigured`] naming the first unit that differs.
pub(super) fn check_units(
    settings: &[EffectSetting],
    units: &[Vec<String>],
) -> Result<(), Failure> {
    for (k, (setting, units)) in settings.iter().zip(units).enumerate() {
        let Some(descriptor) = catalogue().iter().find(|d| d.id == setting.id) else {
            continue;
        };
        for ((name, _), unit) in setting.parameters.iter().zip(units) {
            let parameter = descriptor.parameters.iter().find(|p| p.name == name);
            if let Some(own) = parameter.map(|p| p.unit.symbol()).filter(|own| own != unit) {
                return Err(Failure::misconfigured(
                    format!("effects[{k}].parameters.{name}.unit"),
                    format!("is \"{unit}\"; `{}` takes it in {own}", setting.id),
                ));
            }
        }
    }
    Ok(())
}

/// Returns the case's effects with the parameter values that an individual's searched values give them.
///
/// # Errors
/// [`Failure::Misconfigured`] when the number of values differs from the number of genes, or a gene is a
/// parameter of an effect that the case does not have.
pub(super) fn of_individual(case: &Case, genes: &[f64]) -> Result<Vec<EffectSetting>, Failure> {
    let mut effects = case.effects.clone();
    for (unknown, value) in individual(case, genes)? {
        let Some((id, parameter)) = unknown.of_effect() else {
            continue;
        };
        let Some(effect) = effects.iter_mut().find(|effect| effect.id == id) else {
            return Err(Failure::misconfigured(
                format!("genes.{}", unknown.name),
                format!("the case has no effect `{id}`"),
            ));
        };
        match effect
            .parameters
            .iter_mut()
            .find(|(name, _)| name == parameter)
        {
            Some((_, own)) => *own = value,
            None => effect.parameters.push((parameter.to_owned(), value)),
        }
    }
    Ok(effects)
}

/// Checks the genes that are parameters of effects: the model must have the parameter, in the stated unit,
/// and accept every value of the search interval.
///
/// # Errors
/// [`Failure::Misconfigured`] naming the first gene that does not fit.
pub(super) fn check_genes(case: &Case) -> Result<(), Failure> {
    for (at, unknown) in case.unknowns.iter().enumerate() {
        let Some((id, parameter)) = unknown.of_effect() else {
            continue;
        };
        for end in [unknown.lower, unknown.upper] {
            let mut genes = case.start();
            genes[at] = end;
            selection(&of_individual(case, &genes)?)
                .map_err(|failure| of_search(failure, &unknown.name))?;
        }
        let known = catalogue().iter().find(|d| d.id == id);
        let mut known = known.into_iter().flat_map(|d| d.parameters.iter());
        let own = known.find(|p| p.name == parameter);
        let unit = &unknown.unit;
        if let Some(own) = own.map(|p| p.unit.symbol()).filter(|own| own != unit) {
            return Err(Failure::misconfigured(
                format!("genes.{}.unit", unknown.name),
                format!("is \"{unit}\"; `{id}` takes it in {own}"),
            ));
        }
    }
    Ok(())
}

/// Rewords a failure caused by an effect's setting so that it names the search interval of the unknown
/// instead.
fn of_search(failure: Failure, label: &str) -> Failure {
    if let Failure::Misconfigured { field, problem } = failure {
        return Failure::misconfigured(
            format!("{field}.search"),
            format!("of gene {label}: {problem}"),
        );
    }
    failure
}

/// Describes why a setting was refused, with the name that was probably meant.
fn problem(refused: &SelectionError) -> String {
    match refused {
        SelectionError::UnknownEffect { id, .. } => {
            let known = catalogue().iter().map(|d| &*d.id);
            format!("{refused}; {}", suggestion(id, known))
        }
        SelectionError::UnknownParameter { id, name, .. } => {
            let of = catalogue().iter().find(|d| d.id == *id);
            let known = of.into_iter().flat_map(|d| d.parameters.iter());
            format!("{refused}; {}", suggestion(name, known.map(|p| p.name)))
        }
        SelectionError::Duplicate { .. } | SelectionError::OutOfBounds { .. } => {
            refused.to_string()
        }
    }
}

/// Suggests the known name most similar to `name` if one is similar enough; otherwise lists all known names
/// without a `.`.
pub(super) fn suggestion<'a, I: Iterator<Item = &'a str> + Clone>(name: &str, known: I) -> String {
    let alike = known
        .clone()
        .map(|other| (strsim::normalized_damerau_levenshtein(name, other), other))
        .filter(|(alike, _)| *alike >= 0.5)
        .max_by(|a, b| a.0.total_cmp(&b.0));
    if let Some((_, near)) = alike {
        return format!("did you mean `{near}`?");
    }
    let plain: Vec<&str> = known.filter(|name| !name.contains('.')).collect();
    format!("known are {}", plain.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(id: &str, name: &str, value: f64) -> (String, String) {
        let good = EffectSetting::new("load_offset", &[("force", 500.0)]);
        let settings = [good, EffectSetting::new(id, &[(name, value)])];
        let failure = selection(&settings).unwrap_err();
        let Failure::Misconfigured { field, problem } = failure else {
            unreachable!("{failure:?}");
        };
        (field, problem)
    }

    #[test]
    fn what_is_refused_names_field_and_remedy() {
        let (field, problem) = refused("pivot_frction", "moment", 1.0);
        assert_eq!(field, "effects[1].id");
        assert!(
            problem.ends_with("did you mean `pivot_friction`?"),
            "{problem}"
        );
        let (field, problem) = refused("pivot_friction", "momment", 1.0);
        assert_eq!(field, "effects[1].parameters.momment");
        assert!(problem.ends_with("did you mean `moment`?"), "{problem}");
        let (field, problem) = refused("pivot_friction", "zzz", 1.0);
        assert_eq!(field, "effects[1].parameters.zzz");
        assert!(problem.contains("known are moment, viscous"), "{problem}");
        let (field, problem) = refused("head_profile_wear", "centre", 20.0);
        assert_eq!(field, "effects[1].parameters.centre");
        assert_eq!(problem, "is 20; it must lie between 130 and 215 deg");
        let (_, problem) = refused("load_offset", "force", 1.0);
        assert_eq!(problem, "`load_offset` is given twice");
    }

    #[test]
    fn a_unit_of_another_quantity_is_refused() {
        let settings = [EffectSetting::new("pivot_friction", &[("moment", 1.0)])];
        let units = |unit: &str| [vec![unit.to_owned()]];
        assert_eq!(check_units(&settings, &units("N.m")), Ok(()));
        let Err(Failure::Misconfigured { field, problem }) = check_units(&settings, &units("N"))
        else {
            unreachable!("accepted")
        };
        assert_eq!(field, "effects[0].parameters.moment.unit");
        assert_eq!(problem, "is \"N\"; `pivot_friction` takes it in N.m");
        for p in catalogue().iter().flat_map(|d| d.parameters.iter()) {
            assert!(protocol::pumping_unit::EFFECT_UNITS.contains(&p.unit.symbol()));
        }
    }

    #[test]
    fn every_effect_is_announced_as_it_is() {
        let announced = descriptors();
        assert_eq!(announced.len(), catalogue().len());
        let one = announced.iter().find(|d| d.id == "gauge_drift").unwrap();
        assert_eq!(one.place, announce::Place::Sensor);
        assert_eq!(one.parameters[2].unit, "MPa/rev");
        assert_eq!(one.parameters[2].sign, announce::Sign::Either);
        let friction = announced.iter().find(|d| d.id == "pivot_friction").unwrap();
        assert_eq!(friction.parameters[0].sign, announce::Sign::Positive);
        assert_eq!(friction.parameters[2].role, announce::Role::Shape);
    }
}
