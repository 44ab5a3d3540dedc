//! Assignment of an individual's values to the unknowns of the case.
use protocol::{
    case::{Case, Unknown},
    job::Failure,
    pumping_unit::{Coefficient, PumpingUnit},
    unit::Unit,
};
use simulation::element::{bushing::Bushing, impact::Impact};
use simulation::model::description::RopeLaw;

/// Pairs the unknowns of a case with the values of an individual.
///
/// # Errors
/// [`Failure::Misconfigured`] when there are fewer or more values than unknowns.
pub(super) fn individual<'a>(
    case: &'a Case,
    genes: &'a [f64],
) -> Result<impl Iterator<Item = (&'a Unknown, f64)> + Clone, Failure> {
    let (given, wanted) = (genes.len(), case.unknowns.len());
    if given != wanted {
        return Err(Failure::misconfigured(
            "genes",
            format!("{given} values for {wanted} unknowns"),
        ));
    }
    Ok(case.unknowns.iter().zip(genes.iter().copied()))
}

/// Builds the rope law from an individual's values in their declared units.
///
/// # Errors
/// [`Failure::Misconfigured`] when a coefficient is missing, surplus, not a positive number, or not in one of
/// its units.
pub fn rope_law(unit: &PumpingUnit, genes: &[f64]) -> Result<RopeLaw, Failure> {
    let genes = individual(&unit.case, genes)?;
    let value = |name: Coefficient| -> Result<f64, Failure> {
        let misconfigured = |problem: String| Failure::misconfigured(name.as_str(), problem);
        let mut unknowns = genes.clone();
        let found = unknowns.find(|(unknown, _)| unknown.name == name.as_str());
        let (unknown, value) = found.ok_or_else(|| misconfigured("is missing".to_owned()))?;
        let unit = Unit::named(&unknown.unit).filter(|unit| unit.si() == name.si_unit());
        let unit = unit.ok_or_else(|| {
            let fitting = name.si_unit().symbol();
            misconfigured(format!(
                "is in {}; it is measured in {fitting}",
                unknown.unit
            ))
        })?;
        if value > 0.0 && value.is_finite() {
            return Ok(unit.to_si(value));
        }
        Err(misconfigured(format!(
            "is {value}; it must be a positive number"
        )))
    };
    Ok(RopeLaw {
        bushing: Bushing {
            stiffness: [value(Coefficient::Kb1)?, value(Coefficient::Kb23)?],
            damping: [value(Coefficient::Cb1)?, value(Coefficient::Cb23)?],
            rotational_stiffness: [value(Coefficient::Kb4)?, value(Coefficient::Kb56)?],
            rotational_damping: [value(Coefficient::Cb4)?, value(Coefficient::Cb56)?],
            preload: unit.machine.ropes.preload_n,
        },
        contact: Impact {
            stiffness: value(Coefficient::Kc)?,
            exponent: unit.machine.contact.exponent,
            damping: value(Coefficient::Cc)?,
            full_damping_penetration: unit.machine.contact.full_damping_penetration_m,
        },
    })
}
