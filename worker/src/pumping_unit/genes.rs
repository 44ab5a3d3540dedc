//! What the values of an individual's genes are values of.
use protocol::{
    case::{Case, Coefficient, Quantity},
    job::Failure,
    pumping_unit::PumpingUnit,
};
use simulation::element::{bushing::Bushing, impact::Impact};
use simulation::model::description::RopeLaw;

/// The genes of a case with the values of an individual.
///
/// # Errors
/// [`Failure::Misconfigured`] when there are fewer or more values than genes.
pub(super) fn individual<'a>(
    case: &'a Case,
    genes: &'a [f64],
) -> Result<impl Iterator<Item = (&'a Quantity, f64)> + Clone, Failure> {
    if genes.len() != case.genes.len() {
        return Err(Failure::misconfigured(
            "genes",
            format!("{} values for {} genes", genes.len(), case.genes.len()),
        ));
    }
    let quantities = case.genes.iter().map(|gene| &gene.quantity);
    Ok(quantities.zip(genes.iter().copied()))
}

/// The rope law of a gene vector in declared units.
///
/// # Errors
/// [`Failure::Misconfigured`] when a gene is missing, surplus or not a positive number.
pub fn rope_law(unit: &PumpingUnit, genes: &[f64]) -> Result<RopeLaw, Failure> {
    let genes = individual(&unit.case, genes)?;
    let value = |name: Coefficient| -> Result<f64, Failure> {
        let found = genes.clone().find_map(|(quantity, value)| match quantity {
            Quantity::Coefficient { name: own, unit } if *own == name => Some((*unit, value)),
            Quantity::Coefficient { .. } | Quantity::Effect { .. } => None,
        });
        match found {
            Some((unit, value)) if value > 0.0 && value.is_finite() => Ok(unit.to_si(value)),
            Some((_, value)) => Err(Failure::misconfigured(
                name.as_str(),
                format!("is {value}; it must be a positive number"),
            )),
            None => Err(Failure::misconfigured(name.as_str(), "is missing")),
        }
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
