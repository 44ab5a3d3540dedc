//! The machines of a case, built once for all jobs on it.
use crate::convert;
use protocol::{
    case::Case,
    job::{Failure, Individual},
    pumping_unit::Discretisation,
};
use simulation::model::Machine;
use std::borrow::Cow;

/// A case with one machine per condition.
#[derive(Debug)]
pub(super) struct Machines {
    pub(super) case: Case,
    /// With the case's effects as they are stated, discretised as the case says.
    plain: Vec<Machine>,
}

impl Machines {
    /// Builds them.
    ///
    /// # Errors
    /// [`Failure::Misconfigured`] if the case cannot be built.
    pub(super) fn new(case: &Case) -> Result<Self, Failure> {
        let plain = (0..case.conditions.len())
            .map(|condition| convert::machine(case, condition))
            .collect::<Result<_, _>>()?;
        convert::effect::check_genes(case)?;
        Ok(Self {
            case: case.clone(),
            plain,
        })
    }

    /// The case, discretised as a job says.
    ///
    /// # Errors
    /// [`Failure::Misconfigured`] if it cannot be divided so.
    pub(super) fn discretised(
        &self,
        discretisation: &Discretisation,
    ) -> Result<Cow<'_, Case>, Failure> {
        if *discretisation == Discretisation::OF_THE_CASE {
            return Ok(Cow::Borrowed(&self.case));
        }
        let refined = convert::refined(&self.case, discretisation)?;
        Ok(if refined == self.case {
            Cow::Borrowed(&self.case)
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
        case: &Case,
        individual: &Individual,
    ) -> Result<Cow<'_, Machine>, Failure> {
        let stated = std::ptr::eq(case, &raw const self.case)
            && individual.effects.is_empty()
            && !case.has_effect_genes();
        if !stated {
            return convert::machine_with(case, individual).map(Cow::Owned);
        }
        let machine = self.plain.get(individual.condition).map(Cow::Borrowed);
        machine.ok_or_else(|| convert::no_condition(individual.condition))
    }
}
