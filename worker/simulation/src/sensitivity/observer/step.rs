//! Propagation of the columns (derivatives of the state) through a step that the run has completed.
use super::super::active::Active;
use super::super::between::add_column;
use super::super::block::{Block, StagePredictor};
use super::super::column::Unavailable;
use super::super::differences::Difference;
use super::super::linearized::Linearized;
use super::super::memory::MemoryColumns;
use super::super::source::Source;
use super::{SensitivityObserver, Workspace};
use crate::integrator::dense::Weights;
use crate::integrator::stepper::Stages;
use crate::linear::{LANES, Lanes};
use crate::model::layout::Motion;
use crate::model::{ForceBuffers, RopeMachine};
use crate::observe::{Gradient, TorqueBy};
use crate::system::{State, System};

/// Largest number of blocks of columns that fit into the processor's cache together with a stage. Up to this
/// number, each stage is applied to all blocks in turn; above it, each block is taken through a whole step.
const CACHED_BLOCKS: usize = 6;

#[expect(
    clippy::multiple_inherent_impl,
    reason = "steps and samples are files of their own"
)]
impl SensitivityObserver<'_, '_> {
    /// Computes the right-hand side `dR/dp` for one block of derivative columns at a stage into `room.right`.
    fn right_hand_side(
        &mut self,
        (block, stage): (usize, usize),
        individual: &mut RopeMachine<'_>,
    ) {
        let Some(Workspace {
            stages,
            right,
            force: [one, sum],
            ..
        }) = &mut self.room
        else {
            return;
        };
        let at = &mut stages[stage];
        std::mem::swap(&mut individual.scratch, &mut at.scratch);
        right.fill(Lanes::default());
        let columns = self.active.chunks_mut(LANES).nth(block);
        for (lane, active) in columns.into_iter().flatten().enumerate() {
            let Active {
                source,
                perturbed: sides,
                difference,
                ..
            } = active;
            let between = (&mut self.own, &mut sides[..], &*difference);
            let place = (&at.state, &at.units[..]);
            let added = match source {
                Source::Joints(joints) => {
                    joints.add_unit_forces(individual, place, (&mut *right, lane))
                }
                Source::Contact { .. }
                | Source::Pieces(_)
                | Source::Difference(..)
                | Source::Nothing => false,
            };
            if !added {
                source.right_hand_side(individual, place, between, [one, sum]);
                for (right, sum) in right.iter_mut().zip(&*sum) {
                    right.0[lane] = *sum;
                }
            }
        }
        std::mem::swap(&mut individual.scratch, &mut at.scratch);
        self.memories[block].add_forces(at, &self.own.machine.chains, right);
    }

    /// Updates the memory of axial laws after a step, whose end is stage `end` of those that are stored, for the
    /// simulated machine and for the machines with perturbed parameters, and its derivatives.
    fn remember(&mut self, state: &State, end: usize) {
        let Some(Workspace {
            stages,
            scratch,
            state: beside,
            ..
        }) = &mut self.room
        else {
            return;
        };
        let chains = &self.own.machine.chains;
        self.own.remember(scratch, state);
        for (memory, block) in self.memories.iter_mut().zip(&self.blocks) {
            memory.advance(&stages[end], chains, &block.ends[0].q);
        }
        for (at, active) in self.active.iter_mut().enumerate() {
            let Some(block) = self.blocks.get(at / LANES) else {
                break;
            };
            let (memory, lane) = (&mut self.memories[at / LANES], at % LANES);
            if active.memory_by_state {
                if active.changes_laws() {
                    let Difference { weights, own, .. } = active.difference;
                    memory.add(lane, own, self.own.memory(), chains);
                    for (side, weight) in active.perturbed.iter_mut().zip(weights) {
                        side.remember(scratch, state);
                        memory.add(lane, weight, side.memory(), chains);
                    }
                }
                for side in &mut active.perturbed {
                    side.remember_as(&self.own);
                }
                continue;
            }
            memory.clear(lane);
            let now = &block.ends[0];
            let weights = Weights::at([0.0, 1.0], 0.0);
            for (side, step) in active.perturbed.iter_mut().zip(active.difference.steps) {
                if side.machine.extensions.has_axial() {
                    beside.clone_from(state);
                    add_column([now, now], at % LANES, &weights, step, beside);
                    side.remember(scratch, beside);
                }
            }
        }
    }

    /// Propagates the columns through a step. Each block is taken through all stages that are stored at a
    /// time, so that it stays in cache.
    pub(super) fn propagate(
        &mut self,
        system: &mut System<RopeMachine<'_>>,
        ends: [&State; 2],
        stages: Stages<'_>,
    ) -> Result<(), Unavailable> {
        let h = ends[1].t - ends[0].t;
        let kept = self.room.as_ref().map_or(1, |room| room.stages.len());
        if self.memory_behind {
            self.remember(ends[0], kept - 1);
        }
        let mut after = 1..stages.tableau.stages();
        while !after.is_empty() && !self.blocks.is_empty() {
            let first = after.start;
            let several = first..after.end.min(first + kept);
            after.start = several.end;
            if let Some(room) = &mut self.room {
                for (i, at) in several.clone().zip(&mut room.stages) {
                    let made = at.stage(system, (i, stages), ends, &mut room.force[0]);
                    made.map_err(|_| Unavailable::Singular)?;
                    room.factorizations += 1;
                }
            }
            for block in 0..self.blocks.len() {
                for i in several.clone() {
                    self.right_hand_side((block, i - first), &mut system.equations);
                    if let Some(room) = &mut self.room {
                        self.blocks[block].stage(
                            &system.equations,
                            &room.stages[i - first],
                            (stages.tableau, i, h),
                            &mut room.right,
                            &mut room.bases,
                        );
                    }
                }
            }
        }
        for block in &mut self.blocks {
            block.accept();
        }
        for (end, now) in self.ends.iter_mut().zip(ends) {
            end.clone_from(now);
        }
        self.memory_behind = true;
        Ok(())
    }

    /// Allocates the buffers and computes the derivatives of the static equilibrium; `stages` is the number
    /// of stages of the integration method.
    pub(super) fn start(
        &mut self,
        system: &mut System<RopeMachine<'_>>,
        state: &State,
        stages: usize,
    ) -> Result<(), Unavailable> {
        let n = state.q.len();
        let moving = self.active.iter().filter(|active| active.moves());
        let blocks = moving.count().div_ceil(LANES);
        // the explicit first stage is where the step begins, the last one where it ends
        self.blocks = vec![Block::new(n, stages - 2); blocks];
        self.memories = vec![MemoryColumns::new(self.own.machine.chains.len()); blocks];
        let asked = |active: &Active<'_>| match active.source {
            Source::Joints(_) => true,
            Source::Pieces(extensions) => extensions.has_axial(),
            Source::Contact { .. } | Source::Difference(..) | Source::Nothing => false,
        };
        let asked = self.own.machine.extensions.has_axial() || self.active.iter().any(asked);
        let units = asked && self.own.machine.layout.motion == Motion::Plane;
        let kept = if blocks > CACHED_BLOCKS {
            stages - 1
        } else {
            1
        };
        let own = &system.equations;
        let zeros = || vec![0.0; n];
        let mut room = Workspace {
            stages: (0..kept)
                .map(|_| Linearized::new(own, state, units))
                .collect(),
            bases: StagePredictor::new(n),
            scratch: ForceBuffers::new(own.machine),
            right: vec![Lanes::default(); n],
            force: [zeros(), zeros()],
            state: state.clone(),
            gradient: Gradient::available_for(self.own.machine).then(|| Gradient::new(n)),
            torque: TorqueBy(Vec::with_capacity(n)),
            factorizations: 1,
        };
        let made = room.stages[0].rest(system, state, &mut room.force[0]);
        made.map_err(|_| Unavailable::Singular)?;
        self.room = Some(room);
        let curves = self.active.iter_mut();
        let curves = curves.flat_map(|active| active.curves.each_mut());
        for curve in curves.chain(&mut self.readings) {
            curve.reserve_exact(self.settings.samples);
        }
        for block in 0..blocks {
            self.right_hand_side((block, 0), &mut system.equations);
            if let Some(room) = &mut self.room {
                self.blocks[block].rest(&room.stages[0], &mut room.right);
            }
        }
        self.remember(state, 0);
        Ok(())
    }
}
