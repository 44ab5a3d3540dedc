//! Completed simulation of a pumping unit, before its conversion to a reply.
use super::{columns::Columns, machines::Machines};
use super::{
    genes::rope_law,
    reply::{self, megapascals},
    run::discretised_settings,
};
use protocol::case::{Case, Channel};
use protocol::job::{Counters, Derivative, Failure, SimulateSpec, Verdict};
use protocol::pumping_unit::{Discretisation, Sensor};
use simulation::observe::{Curves, Recorder};
use simulation::{
    run::{RunResult, simulate},
    sensitivity,
};
use std::time::Instant;

/// Results of a completed simulation of a pumping unit.
pub(super) struct CompletedRun {
    pub(super) verdict: Verdict,
    pub(super) counters: Counters,
    pub(super) curves: Curves,
    pub(super) result: RunResult,
    /// Height of the suspension point at its lowest design position \[m\].
    pub(super) lowest_suspension_m: f64,
    pub(super) wall_s: f64,
    /// Derivatives that the job requests; empty if the run failed.
    pub(super) columns: Vec<Derivative>,
}

impl CompletedRun {
    /// Simulates an individual with the derivatives that the job requests, recording the curves that
    /// `recorder` selects.
    ///
    /// # Errors
    /// [`Failure::Misconfigured`] when condition, genes, effects or discretisation do not fit the case.
    pub(super) fn new(
        machines: &Machines,
        spec: &SimulateSpec,
        mut recorder: Recorder,
    ) -> Result<Self, Failure> {
        let numerics = numerics(spec)?;
        let unit = machines.discretised(&numerics)?;
        let law = rope_law(&unit, &spec.individual.genes)?;
        let settings = discretised_settings(&unit.machine, &numerics);
        let machine = machines.machine(&unit, &spec.individual)?;
        let columns = Columns::new(&unit, &machine, spec)?;
        let started = Instant::now();
        let (result, columns) = match columns {
            None => (
                simulate(&machine, &law, &settings, &mut recorder),
                Vec::new(),
            ),
            Some(columns) => {
                let (result, found) =
                    sensitivity::simulate(&machine, &law, &settings, &columns.plan, &mut recorder);
                let condition = spec.individual.condition;
                let said =
                    found.map(|found| columns.into_derivatives(&unit.case, condition, found));
                (result, said.unwrap_or_default())
            }
        };
        Ok(Self {
            verdict: reply::verdict(&result.verdict),
            counters: reply::counters(&result.statistics),
            curves: recorder.curves,
            result,
            lowest_suspension_m: machine.lowest_suspension,
            wall_s: started.elapsed().as_secs_f64(),
            columns,
        })
    }

    /// Returns the curves of a condition's channels, each in its channel's unit, in the case's order.
    ///
    /// # Errors
    /// [`Failure::Misconfigured`] for a channel that a pumping unit does not have.
    pub(super) fn channels(&self, case: &Case, condition: usize) -> Result<Vec<Vec<f64>>, Failure> {
        let curve = |(_, channel): (usize, &Channel)| {
            let sensor = Sensor::named(&channel.name).ok_or_else(|| {
                let problem = format!("the pumping unit model has no channel `{}`", channel.name);
                Failure::misconfigured("channels", problem)
            })?;
            Ok(match sensor {
                Sensor::Gauge(number) => megapascals(&self.curves.gauge[usize::from(number) - 1]),
                Sensor::Position => self.suspension_m(),
                Sensor::Torque => self.curves.torque.clone(),
            })
        };
        case.channels_of(condition).map(curve).collect()
    }

    /// Returns the stress at gauges 1 to 4 \[MPa\].
    pub(super) fn gauges_mpa(&self) -> [Vec<f64>; 4] {
        self.curves.gauge.each_ref().map(|gauge| megapascals(gauge))
    }

    /// Returns the height of the suspension above its lowest design position \[m\].
    pub(super) fn suspension_m(&self) -> Vec<f64> {
        let [position, ..] = &self.curves.suspension;
        let above = |y: &f64| y - self.lowest_suspension_m;
        position.iter().map(above).collect()
    }
}

/// Decodes the discretisation that a job requests.
///
/// # Errors
/// [`Failure::Misconfigured`] for bytes that do not encode a discretisation of a pumping unit.
pub(super) fn numerics(spec: &SimulateSpec) -> Result<Discretisation, Failure> {
    Discretisation::of(&spec.numerics)
        .map_err(|error| Failure::misconfigured("numerics", error.to_string()))
}
