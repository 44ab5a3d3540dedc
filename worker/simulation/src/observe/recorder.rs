//! Recorder of a run: gauge stress alone for scoring, or all curves.
use super::curves::Curves;
use super::readings::readings;
use super::shaft::crank_torque;
use super::shape::shape;
use super::stress::record_head_loads;
use crate::model::parallel_ropes::{BACK, FRONT};
use crate::model::{Machine, MachineState, RopeMachine};
use crate::run::Observe;
use crate::system::{State, System};

/// Recorder of gauge stress alone (for scoring), or of all curves.
#[derive(Clone, Debug, Default)]
pub struct Recorder {
    /// Curves recorded so far.
    pub curves: Curves,
    gauges_only: bool,
    shape_every: usize,
    with_head_loads: bool,
    force: Vec<f64>,
}

impl Recorder {
    /// Creates a recorder of gauge stress alone, which is sufficient for scoring.
    pub fn gauges_only() -> Self {
        Self {
            gauges_only: true,
            ..Self::default()
        }
    }

    /// Creates a recorder of all curves but the loads of the back head, and of the machine's shape at every `shape_every`-th sample.
    pub fn everything(shape_every: usize) -> Self {
        Self {
            shape_every,
            ..Self::default()
        }
    }

    /// Returns the recorder with the loads of the back head recorded too.
    #[must_use]
    pub const fn with_head_loads(mut self) -> Self {
        self.with_head_loads = true;
        self
    }
}

impl Observe for Recorder {
    fn sample(&mut self, index: usize, system: &mut System<RopeMachine<'_>>, state: &State) {
        self.force.resize(state.q.len(), 0.0);
        let part = self.gauges_only && !system.equations.machine.extensions.has_readings();
        if !part {
            system.statistics.force_evaluations += 1;
        }
        let stress = readings(&mut system.equations, state, &mut self.force, part);
        for (curve, stress) in self.curves.gauge.iter_mut().zip(stress) {
            curve.push(stress);
        }
        if self.gauges_only {
            return;
        }
        let system = &mut system.equations;
        if self.with_head_loads {
            let loads = system.held_loads(state.motion());
            record_head_loads(&mut self.curves.head_loads, &loads, &state.a);
        }
        let drive = system.drive_state(state.t);
        let at = MachineState {
            ropes: &system.ropes,
            drive: &drive,
            q: &state.q,
            v: &state.v,
        };
        let machine = system.machine;
        let layout = machine.layout;
        let c = &mut self.curves;
        c.back_tension.push(system.base_tensions(BACK).sum());
        c.front_tension.push(system.base_tensions(FRONT).sum());
        if layout.twins() {
            for (rope, curve) in c.tension_difference.iter_mut().enumerate() {
                let signed = [1.0, -1.0].into_iter().zip(system.base_tensions(rope));
                curve.push(signed.map(|(side, tension)| side * tension).sum());
            }
        }
        c.beam.push(state.q[layout.beam()]);
        let height = layout.suspension();
        for (curve, value) in
            c.suspension
                .iter_mut()
                .zip([state.q[height], state.v[height], state.a[height]])
        {
            curve.push(value);
        }
        let pin = machine.pin_force(&at, &state.a, &system.scratch);
        c.torque.push(crank_torque(machine, &drive, &pin));
        c.modal.resize(layout.modes, Vec::new());
        for (k, curve) in c.modal.iter_mut().enumerate() {
            curve.push(state.q[layout.mode(k)]);
        }
        if self.shape_every > 0 && index.is_multiple_of(self.shape_every) {
            c.shapes.push(shape(index, system, &drive, state));
        }
    }

    fn complete(&mut self, machine: &Machine, spacing: f64) {
        machine
            .extensions
            .read_series(spacing, &mut self.curves.gauge);
    }
}
