//! Pumping unit as a [`Simulator`], one of the kinds of model that a worker can simulate.
use super::{
    columns, completed_run::CompletedRun, curves, digest, effect, machines::Machines, reduce_head,
};
use crate::simulator::{Model, Simulator};
use protocol::{
    announce::EffectDescriptor,
    case::Case,
    job::{Column, Curves, Failure, Observation, SimulateSpec},
    pumping_unit::{Machine, REDUCE_HEAD, Sensor},
    wire,
};
use simulation::observe::Recorder;

/// Simulator of pumping units with double horse heads.
#[derive(Clone, Copy, Debug)]
pub struct PumpingUnits;

impl Simulator for PumpingUnits {
    fn kind(&self) -> &'static str {
        Machine::KIND
    }

    fn digest(&self) -> String {
        digest::of_numerics().to_owned()
    }

    fn effects(&self) -> Vec<EffectDescriptor> {
        effect::descriptors()
    }

    fn reference_columns(&self, case: &Case) -> Vec<Column> {
        columns::reference(case)
    }

    fn prepare(&self, case: &Case) -> Result<Box<dyn Model>, Failure> {
        Ok(Box::new(Machines::new(case)?))
    }

    fn run_custom(&self, name: &str, body: &[u8]) -> Result<Vec<u8>, Failure> {
        if name != REDUCE_HEAD {
            return Err(Failure::Refused {
                reason: format!(
                    "the pumping unit model does not support the job `{name}`, only `{REDUCE_HEAD}`"
                ),
            });
        }
        let unreadable =
            |error: wire::WireError| Failure::misconfigured(REDUCE_HEAD, error.to_string());
        let head = reduce_head::run(&wire::decode(body).map_err(unreadable)?)?;
        wire::encode(&head).map_err(unreadable)
    }
}

impl Model for Machines {
    fn observe(&self, spec: &SimulateSpec, scored_only: bool) -> Result<Observation, Failure> {
        // recording the gauges alone costs less, where they alone are scored
        let terms = &self.unit.case.objective.terms;
        let gauges_only = terms
            .iter()
            .all(|term| Sensor::gauge(&term.channel).is_some());
        let recorder = if scored_only && gauges_only {
            Recorder::gauges_only()
        } else {
            Recorder::everything(0)
        };
        let ran = CompletedRun::new(self, spec, recorder)?;
        Ok(Observation {
            verdict: ran.verdict,
            counters: ran.counters,
            curves: ran.channels(&self.unit.case, spec.individual.condition)?,
            columns: ran.columns,
        })
    }

    fn all_curves(&self, spec: &SimulateSpec, pictures: u32) -> Result<Curves, Failure> {
        curves::run(self, spec, pictures)
    }
}
