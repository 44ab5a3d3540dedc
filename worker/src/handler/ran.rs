//! A simulation that was run, before anything is said of it.
use super::machines::Machines;
use crate::convert;
use protocol::job::{Counters, Failure, SimulateSpec, Verdict};
use simulation::observe::{Curves, Recorder};
use simulation::run::{RunResult, simulate};
use std::time::Instant;

/// What a run left behind.
pub(super) struct Ran {
    pub(super) verdict: Verdict,
    pub(super) counters: Counters,
    pub(super) curves: Curves,
    pub(super) result: RunResult,
    /// Lowest design position of the suspension \[m\].
    pub(super) lowest_suspension_m: f64,
    pub(super) wall_s: f64,
}

impl Ran {
    /// Simulates and records what the recorder takes.
    ///
    /// # Errors
    /// [`Failure::Misconfigured`] when condition, genes, effects or discretisation do not fit the
    /// case.
    pub(super) fn new(
        machines: &Machines,
        spec: &SimulateSpec,
        mut recorder: Recorder,
    ) -> Result<Self, Failure> {
        let unit = machines.discretised(&spec.discretisation)?;
        let law = convert::rope_law(&unit, &spec.individual.genes)?;
        let settings = convert::discretised_settings(&unit.machine, &spec.discretisation);
        let machine = machines.machine(&unit, &spec.individual)?;
        let started = Instant::now();
        let result = simulate(&machine, &law, &settings, &mut recorder);
        Ok(Self {
            verdict: convert::verdict(&result.verdict),
            counters: convert::counters(&result.statistics),
            curves: recorder.curves,
            result,
            lowest_suspension_m: machine.lowest_suspension,
            wall_s: started.elapsed().as_secs_f64(),
        })
    }

    /// Stress at gauges 1 to 4 \[MPa\].
    pub(super) fn gauge_mpa(&self) -> [Vec<f64>; 4] {
        let megapascals = |curve: &Vec<f64>| curve.iter().map(|s| s * 1e-6).collect();
        self.curves.gauge.each_ref().map(megapascals)
    }

    /// Suspension height above its lowest design position \[m\].
    pub(super) fn suspension_m(&self) -> Vec<f64> {
        let [position, ..] = &self.curves.suspension;
        let above = |y: &f64| y - self.lowest_suspension_m;
        position.iter().map(above).collect()
    }
}
