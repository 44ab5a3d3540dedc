//! The machines of a case, built once for all jobs on it.
use super::{
    effect,
    machine::{machine, machine_with, no_condition},
    refinement::refined,
};
use protocol::{
    case::Case,
    job::{Failure, Individual},
    pumping_unit::{Discretisation, PumpingUnit},
};
use simulation::model::Machine;
use std::borrow::Cow;

/// A case with one machine per condition.
#[derive(Debug)]
pub(super) struct Machines {
    pub(super) unit: PumpingUnit,
    /// With the case's effects as they are stated, discretised as the case says.
    plain: Vec<Machine>,
}

impl Machines {
    /// Builds them.
    ///
    /// # Errors
    /// [`Failure::Misconfigured`] if the case cannot be built.
    pub(super) fn new(case: &Case) -> Result<Self, Failure> {
        let unit = PumpingUnit::of(case.clone())
            .map_err(|error| Failure::misconfigured("model.settings", error.to_string()))?;
        let plain = (0..case.conditions.len())
            .map(|condition| machine(&unit, condition))
            .collect::<Result<_, _>>()?;
        effect::check_genes(case)?;
        Ok(Self { unit, plain })
    }

    /// The case, discretised as a job says.
    ///
    /// # Errors
    /// [`Failure::Misconfigured`] if it cannot be divided so.
    pub(super) fn discretised(
        &self,
        discretisation: &Discretisation,
    ) -> Result<Cow<'_, PumpingUnit>, Failure> {
        if *discretisation == Discretisation::OF_THE_CASE {
            return Ok(Cow::Borrowed(&self.unit));
        }
        let refined = refined(&self.unit, discretisation)?;
        Ok(if refined == self.unit {
            Cow::Borrowed(&self.unit)
        } else {
            Cow::Owned(refined)
        })
    }

    /// The machine of an individual. Where genes are parameters of effects, every individual is a
    /// machine of its own; so is one that a job's own effects ask for, and any of another case than
    /// this one, as another discretisation makes it.
    ///
    /// # Errors
    /// [`Failure::Misconfigured`] if it cannot be built.
    pub(super) fn machine(
        &self,
        unit: &PumpingUnit,
        individual: &Individual,
    ) -> Result<Cow<'_, Machine>, Failure> {
        let stated = std::ptr::eq(unit, &raw const self.unit)
            && individual.effects.is_empty()
            && !unit.case.has_unknown_effects();
        if !stated {
            return machine_with(unit, individual).map(Cow::Owned);
        }
        let machine = self.plain.get(individual.condition).map(Cow::Borrowed);
        machine.ok_or_else(|| no_condition(individual.condition))
    }
}
