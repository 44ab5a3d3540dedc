//! Machine of a case under one condition, simulated in this process.
use anyhow::{Context as _, anyhow, bail};
use case::{Overrides, load};
use clap::Args;
use protocol::case::Case;
use protocol::{
    job::{Individual, Job, Reply, SimulateSpec},
    pumping_unit::{Discretisation, PumpingUnit, Simulation},
};
use simulation::{
    observe::Recorder,
    run::{RunResult, RunSettings},
};
use std::{path::PathBuf, time::Instant};
use worker::{handler::Prepared, pumping_unit};

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

/// Run of one individual, with its gauge stress.
pub(crate) struct GaugeRun {
    pub(crate) result: RunResult,
    /// Gauge stress over the revolution \[Pa\].
    pub(crate) gauges: [Vec<f64>; 4],
    pub(crate) wall_s: f64,
}

impl Machine {
    /// Simulates the machine with the parameter values of one individual and settings of the run that `change` makes of
    /// those of the case.
    pub(crate) fn run(
        &self,
        genes: &[f64],
        change: impl FnOnce(RunSettings) -> RunSettings,
    ) -> anyhow::Result<GaugeRun> {
        let failed = |failure| anyhow!("the machine cannot be built: {failure:?}");
        let unit = PumpingUnit::of(self.case.clone())?;
        let machine = pumping_unit::machine(&unit, self.condition).map_err(failed)?;
        let law = pumping_unit::rope_law(&unit, genes).map_err(failed)?;
        let settings = change(pumping_unit::run_settings(&unit.machine));
        let mut recorder = Recorder::gauges_only();
        let begun = Instant::now();
        let result = simulation::run::simulate(&machine, &law, &settings, &mut recorder);
        Ok(GaugeRun {
            result,
            gauges: recorder.curves.gauge,
            wall_s: begun.elapsed().as_secs_f64(),
        })
    }

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
