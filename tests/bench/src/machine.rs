//! Machine of a case under one condition, simulated in this process.
use anyhow::{Context as _, anyhow, bail};
use case::{Overrides, load};
use clap::Args;
use protocol::case::Case;
use protocol::{
    job::{Individual, Job, Reply, SimulateSpec},
    pumping_unit::{Discretisation, Simulation},
};
use std::path::PathBuf;
use worker::handler::Prepared;

/// Machine to simulate.
#[derive(Clone, Debug, Args)]
pub(crate) struct MachineChoice {
    /// Case folder, with `case.toml` in it.
    #[arg(value_name = "CASE")]
    case: PathBuf,
    /// Name of the condition; by default that of the case's objective.
    #[arg(long, value_name = "NAME")]
    condition: Option<String>,
}

/// Machine of a case under one condition, ready for simulation, also from several threads at once.
pub(crate) struct Machine {
    pub(crate) case: Case,
    prepared: Prepared,
    condition: usize,
}

impl MachineChoice {
    /// Reads the case and builds the machine's models for simulation.
    pub(crate) fn load(&self) -> anyhow::Result<Machine> {
        let case = load(&self.case, &Overrides::default())?;
        let condition = match &self.condition {
            None => case.objective.condition,
            Some(name) => case.condition(name).with_context(|| {
                let known: Vec<&str> = case.conditions.iter().map(|c| c.name.as_str()).collect();
                format!(
                    "the case has no condition `{name}`; its conditions are: {}",
                    known.join(", ")
                )
            })?,
        };
        let prepared = match Prepared::new(worker::SIMULATORS, &case) {
            Ok(prepared) => prepared,
            Err(failure) => bail!("the case cannot be built: {failure:?}"),
        };
        Ok(Machine {
            case,
            prepared,
            condition,
        })
    }
}

impl Machine {
    /// Simulates the machine with the parameter values of one individual.
    pub(crate) fn simulate(
        &self,
        genes: &[f64],
        discretisation: Discretisation,
    ) -> anyhow::Result<Simulation> {
        let job = Job::Simulate(SimulateSpec {
            individual: Individual {
                condition: self.condition,
                genes: genes.to_vec(),
                effects: Vec::new(),
            },
            numerics: discretisation.numerics()?,
            reply: Reply::Curves { pictures: 0 },
            columns: Vec::new(),
        });
        let done = self.prepared.evaluate(&job).done();
        let answer = done.map_err(|failure| anyhow!("the simulation failed: {failure}"))?;
        let curves = answer.into_curves()?;
        Ok(Simulation::of(&curves)?)
    }
}
