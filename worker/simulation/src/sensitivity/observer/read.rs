//! Derivatives of the recorded quantities at a sample.
use super::super::active::{Active, Sample};
use super::super::between::{add_column, shaft, stress};
use super::super::block::Motion;
use super::super::perturbed::PerturbedModel;
use super::{SensitivityObserver, Workspace};
use crate::integrator::dense::Weights;
use crate::linear::{LANES, Lanes};
use crate::model::Scratch;
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
        let asked =
            !self.own.machine.extensions.has_readings() && !self.active.iter().all(Active::moves);
        let by_state = gradient.as_mut().filter(|_| !self.blocks.is_empty());
        let asked = (asked, by_state);
        let (own, known) = self.own.gradient(scratch, state, room, asked);
        for (curve, reading) in self.readings.iter_mut().zip(own) {
            curve.push(reading);
        }
        let [from, to] = &self.ends;
        let sample = Sample {
            state,
            ends: [from, to],
            own,
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
            let mut sum = [0.0; 4];
            let mut add = |share: f64, readings: &[f64; 4]| {
                for (sum, reading) in sum.iter_mut().zip(readings) {
                    *sum += share * reading;
                }
            };
            match (&gradient, ends) {
                (Some(gradient), Some(ends)) => {
                    if lane == 0 {
                        along = stress(ends, &weights, gradient, layout.beam());
                    }
                    add(1.0, &along.map(|along| along.0[lane]));
                }
                (None, Some(ends)) => {
                    let room = (&mut *scratch, &mut force[..], &mut *beside);
                    let column = (ends, lane, &weights);
                    add(1.0, &differenced(&mut self.own, column, state, room));
                }
                (_, None) => {}
            }
            let room = (&mut *scratch, &mut force[..], &mut *beside);
            let explicit = active.explicit(&sample, gradient.as_ref(), room);
            add(1.0, &explicit);
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

/// Returns the derivatives of the gauge readings along a derivative column, by central differences of the
/// state.
fn differenced(
    own: &mut PerturbedModel<'_>,
    (ends, lane, weights): ([&Motion; 2], usize, &Weights),
    state: &State,
    (scratch, force, beside): (&mut Scratch, &mut [f64], &mut State),
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
