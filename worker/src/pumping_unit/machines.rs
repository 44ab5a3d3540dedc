//! Machines of a case, built once for all its jobs.
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

/// Case with one prebuilt machine per condition.
#[derive(Debug)]
pub(super) struct Machines {
    pub(super) unit: PumpingUnit,
    /// Prebuilt machines, one per condition: effects at the values that the case states, discretisation of
    /// the case.
    plain: Vec<Machine>,
}

impl Machines {
    /// Builds the machines of all conditions.
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

    /// Returns the case with the discretisation of a job.
    ///
    /// # Errors
    /// [`Failure::Misconfigured`] if the ropes cannot be divided that way.
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

    /// Returns the machine of an individual. It is built anew if genes are parameters of effects, if the job
    /// has effects of its own, or if `unit` is not the stored case (for example with another discretisation);
    /// otherwise the prebuilt machine is borrowed.
    ///
    /// # Errors
    /// [`Failure::Misconfigured`] if the machine cannot be built.
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
