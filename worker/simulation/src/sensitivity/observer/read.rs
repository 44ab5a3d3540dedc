//! Derivatives of the recorded quantities at a sample.
use super::super::active::{Active, Sample};
use super::super::between::{add_column, shaft, stress};
use super::super::block::Motion;
use super::super::differences::Difference;
use super::super::perturbed::PerturbedModel;
use super::{SensitivityObserver, Workspace};
use crate::integrator::dense::Weights;
use crate::linear::{LANES, Lanes};
use crate::math::vector::add_scaled;
use crate::model::extension::{Extensions, SampleState};
use crate::model::{ForceBuffers, Machine};
use crate::system::State;

/// Difference step for gauge readings along a column, stated as the displacement \[m\] or rotation \[rad\] of
/// the coordinate with the largest derivative.
const PERTURBATION: f64 = 1e-8;

impl SensitivityObserver<'_, '_> {
    /// Stores the gauge readings at a sample, and computes the derivatives of readings, suspension height and
    /// torque.
    pub(super) fn record(&mut self, index: usize, state: &State) {
        let Some(Workspace {
            scratch,
            state: beside,
            force: [force, ..],
            gradient,
            torque,
            ..
        }) = &mut self.room
        else {
            return;
        };
        if !self.blocks.is_empty() {
            let torque = (&mut *torque, &mut *beside);
            self.own.torque_by(scratch, state, torque);
        }
        let read = self.own.shaft(scratch, state);
        let room = (&mut force[..], &mut *beside);
        let asked = !self.active.iter().all(Active::moves);
        let by_state = gradient.as_mut().filter(|_| !self.blocks.is_empty());
        let asked = (asked, by_state);
        let (at_gauges, known) = self.own.gradient(scratch, state, room, asked);
        let chain = MeasuringChain::new(self.own.machine, known);
        let own = chain.read(at_gauges);
        for (curve, reading) in self.readings.iter_mut().zip(own) {
            curve.push(reading);
        }
        let [from, to] = &self.ends;
        let sample = Sample {
            state,
            ends: [from, to],
            own,
            stress: at_gauges,
            shaft: read,
            known,
            turned: (&self.settings, index),
        };
        let weights = Weights::at([from.t, to.t], state.t);
        let layout = self.own.machine.layout;
        let mut along = [Lanes::default(); 4];
        let mut along_shaft = [Lanes::default(); 2];
        for (at, active) in self.active.iter_mut().enumerate() {
            let lane = at % LANES;
            // the ends have changed places when the step was accepted
            let ends = self.blocks.get(at / LANES).map(|block| &block.ends);
            let ends = ends.filter(|_| active.moves()).map(|[to, from]| [from, to]);
            if let Some(ends) = ends.filter(|_| lane == 0) {
                along_shaft = shaft(ends, &weights, layout.suspension(), torque);
            }
            let [mut by_stress, mut sum] = [[0.0; 4]; 2];
            match (&gradient, ends) {
                (Some(gradient), Some(ends)) => {
                    if lane == 0 {
                        along = stress(ends, &weights, gradient, layout.beam());
                    }
                    by_stress = along.map(|along| along.0[lane]);
                }
                (None, Some(ends)) => {
                    let room = (&mut *scratch, &mut force[..], &mut *beside);
                    let column = (ends, lane, &weights);
                    sum = differenced(&mut self.own, column, state, room);
                }
                (_, None) => {}
            }
            let room = (&mut *scratch, &mut force[..], &mut *beside);
            let explicit = active.explicit(&sample, gradient.as_ref(), room);
            add_scaled(&mut by_stress, 1.0, &explicit[0]);
            add_scaled(&mut sum, 1.0, &explicit[1]);
            add_scaled(&mut sum, 1.0, &chain.derivative(at_gauges, by_stress));
            let mut moved = active.explicit_shaft(&sample, (&mut *scratch, &mut *beside));
            if ends.is_some() {
                for (moved, along) in moved.iter_mut().zip(along_shaft) {
                    *moved += along.0[lane];
                }
            }
            let each = active.curves.each_mut();
            for (curve, x) in each.zip(sum.into_iter().chain(moved)) {
                curve.push(x);
            }
        }
    }
}

/// Measuring chain of a machine at one sample, from stress at the gauges to readings.
struct MeasuringChain<'a> {
    extensions: &'a Extensions,
    /// Sample that the stages may use; `None` without stages.
    at: Option<SampleState>,
}

impl<'a> MeasuringChain<'a> {
    fn new(machine: &'a Machine, at: Option<SampleState>) -> Self {
        let extensions = &machine.extensions;
        Self {
            extensions,
            at: at.filter(|_| extensions.has_readings()),
        }
    }

    /// Returns the readings at a stress.
    fn read(&self, mut stress: [f64; 4]) -> [f64; 4] {
        if let Some(at) = &self.at {
            self.extensions.read(at, &mut stress);
        }
        stress
    }

    /// Returns the derivatives of the readings from those of the stress, by central differences.
    fn derivative(&self, stress: [f64; 4], by: [f64; 4]) -> [f64; 4] {
        let difference = Difference::displacing(stress.iter(), by.iter());
        let Some(difference) = difference.filter(|_| self.at.is_some()) else {
            return by;
        };
        let [more, less] = difference.steps.map(|step| {
            let mut moved = stress;
            add_scaled(&mut moved, step, &by);
            self.read(moved)
        });
        std::array::from_fn(|k| (more[k] - less[k]) * difference.weights[0])
    }
}

/// Returns the derivatives of the gauge readings along a derivative column, by central differences of the
/// state.
fn differenced(
    own: &mut PerturbedModel<'_>,
    (ends, lane, weights): ([&Motion; 2], usize, &Weights),
    state: &State,
    (scratch, force, beside): (&mut ForceBuffers, &mut [f64], &mut State),
) -> [f64; 4] {
    let size = ends[0].size(lane).max(ends[1].size(lane));
    if size == 0.0 {
        return [0.0; 4];
    }
    let [more, less] = [PERTURBATION / size, -PERTURBATION / size].map(|step| {
        beside.clone_from(state);
        add_column(ends, lane, weights, step, beside);
        own.readings(scratch, beside, force)
    });
    std::array::from_fn(|k| (more[k] - less[k]) * (0.5 * size / PERTURBATION))
}
