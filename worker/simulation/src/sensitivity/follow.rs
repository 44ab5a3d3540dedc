//! A run with its columns: what a run reports of its steps and samples, differentiated behind it.
use super::active::{Active, Sample};
use super::block::{Bases, Block, add_column, shaft, stress};
use super::column::{Changes, Columns, Derivative, Missing};
use super::differences::Difference;
use super::plan::{Plan, Way};
use super::side::Side;
use super::source::{Source, add};
use super::tangents::Tangents;
use crate::element::plane::PLANE_UNITS;
use crate::integrator::dense::Weights;
use crate::integrator::method::Method;
use crate::integrator::stepper::Stages;
use crate::linear::{LANES, Lanes};
use crate::model::description::RopeLaw;
use crate::model::layout::Motion;
use crate::model::{Individual, Machine, Scratch};
use crate::observe::{Gradient, TorqueBy};
use crate::run::{Observe, RunResult, RunSettings};
use crate::system::{State, System};
use crate::verdict::Verdict;

/// Simulates one individual and differentiates the run; verdict, samples and counters are those of
/// [`run::simulate`](crate::run::simulate), bit for bit. A run that fails has no columns.
pub fn simulate(
    machine: &Machine,
    law: &RopeLaw,
    settings: &RunSettings,
    plan: &Plan,
    observer: &mut dyn Observe,
) -> (RunResult, Option<Columns>) {
    follow((machine, law), settings, plan, observer, |follower| {
        crate::run::simulate(machine, law, settings, follower)
    })
}

/// The same on the steps of another run, with stages that are solved to rounding; see
/// [`run::simulate_on`](crate::run::simulate_on).
pub fn simulate_on(
    (machine, law): (&Machine, &RopeLaw),
    settings: &RunSettings,
    steps: &[f64],
    plan: &Plan,
    observer: &mut dyn Observe,
) -> (RunResult, Option<Columns>) {
    follow((machine, law), settings, plan, observer, |follower| {
        crate::run::simulate_on(machine, law, settings, steps, follower)
    })
}

fn follow<'a>(
    subject: (&'a Machine, &'a RopeLaw),
    settings: &RunSettings,
    plan: &'a Plan,
    observer: &mut dyn Observe,
    run: impl FnOnce(&mut Follower<'a, '_>) -> RunResult,
) -> (RunResult, Option<Columns>) {
    let mut follower = Follower::new(subject, settings, plan, observer);
    let result = run(&mut follower);
    let columns = (result.verdict == Verdict::Complete).then(|| follower.columns(plan));
    (result, columns)
}

/// By how much the farthest coordinate is moved where readings are differenced along a column \[m\],
/// \[rad\].
const MOVED: f64 = 1e-8;

/// Follows a run.
struct Follower<'a, 'o> {
    observer: &'o mut dyn Observe,
    settings: RunSettings,
    /// The machine that runs.
    own: Side<'a>,
    active: Vec<Active<'a>>,
    blocks: Vec<Block>,
    /// Begins with the run.
    room: Option<Room>,
    /// Why nothing is followed any more.
    missing: Option<Missing>,
    /// The last step.
    ends: [State; 2],
    /// What the gauges read at each sample, before what filters whole curves.
    read: [Vec<f64>; 4],
}

/// Buffers.
struct Room {
    tangents: Tangents,
    bases: Bases,
    scratch: Scratch,
    right: Vec<Lanes>,
    force: [Vec<f64>; 2],
    /// What joints do per unit of their coefficients, in the plane and where a column asks.
    units: Vec<[f64; PLANE_UNITS]>,
    state: State,
    /// Derivatives of the stress, where there is such a thing.
    gradient: Option<Gradient>,
    torque: TorqueBy,
}

impl<'a, 'o> Follower<'a, 'o> {
    fn new(
        (machine, law): (&'a Machine, &'a RopeLaw),
        settings: &RunSettings,
        plan: &'a Plan,
        observer: &'o mut dyn Observe,
    ) -> Self {
        let subject = (machine, law);
        let ways = plan.ways.iter().enumerate();
        let mut active: Vec<_> = ways
            .filter_map(|way| Active::new(subject, settings, way))
            .collect();
        active.sort_by_key(Active::order);
        let missing = match settings.method {
            Method::RungeKutta(_) => None,
            Method::Rosenbrock | Method::GeneralizedAlpha { .. } | Method::Bdf { .. } => {
                Some(Missing::Method)
            }
        };
        Self {
            own: Side::new(machine, machine.ropes(law), settings.drive(machine)),
            active,
            settings: *settings,
            observer,
            blocks: Vec::new(),
            room: None,
            missing,
            ends: std::array::from_fn(|_| State::at_rest(0.0, Vec::new())),
            read: [const { Vec::new() }; 4],
        }
    }

    /// Each column in the order of the plan.
    fn columns(self, plan: &Plan) -> Columns {
        let missing = self.missing;
        let mut columns: Vec<_> = plan
            .ways
            .iter()
            .map(|way| match way {
                Way::Missing(missing) => Derivative::Missing(*missing),
                Way::Coefficient(_) | Way::Beside { .. } | Way::Pieces(_) | Way::Nothing => {
                    Derivative::Nothing
                }
            })
            .collect();
        for active in self.active {
            columns[active.column] =
                missing.map_or_else(|| judged(active.curves), Derivative::Missing);
        }
        Columns {
            columns,
            factorizations: self.room.map_or(0, |room| room.tangents.factorizations),
        }
    }

    /// `dR/dp` of the columns of one block at a stage into `room.right`.
    fn right(&mut self, block: usize, individual: &mut Individual<'_>) {
        let Some(Room {
            tangents,
            right,
            force: [one, sum],
            units,
            ..
        }) = &mut self.room
        else {
            return;
        };
        right.fill(Lanes::default());
        let columns = self.active.chunks_mut(LANES).nth(block);
        for (lane, active) in columns.into_iter().flatten().enumerate() {
            let Active {
                source,
                sides,
                difference,
                ..
            } = active;
            let between = (&mut self.own, &mut sides[..], &*difference);
            source.right(individual, &tangents.state, between, units, [one, sum]);
            for (right, sum) in right.iter_mut().zip(&*sum) {
                right.0[lane] = *sum;
            }
        }
    }

    /// Lets laws with a past remember where the columns stand now.
    fn remember(&mut self, state: &State) {
        let Some(Room {
            scratch,
            state: beside,
            ..
        }) = &mut self.room
        else {
            return;
        };
        self.own.remember(scratch, state);
        for (at, active) in self.active.iter_mut().enumerate() {
            let Some(block) = self.blocks.get(at / LANES) else {
                break;
            };
            let now = &block.ends[0];
            let weights = Weights::at([0.0, 1.0], 0.0);
            for (side, step) in active.sides.iter_mut().zip(active.difference.steps) {
                if side.machine.hooks.has_axial() {
                    beside.clone_from(state);
                    add_column([now, now], at % LANES, &weights, step, beside);
                    side.remember(scratch, beside);
                }
            }
        }
    }

    fn follow(
        &mut self,
        system: &mut System<Individual<'_>>,
        ends: [&State; 2],
        stages: Stages<'_>,
    ) -> Result<(), Missing> {
        let h = ends[1].t - ends[0].t;
        let moving = !self.blocks.is_empty();
        for i in (1..stages.tableau.stages()).filter(|_| moving) {
            if let Some(room) = &mut self.room {
                let [own, ..] = &mut room.force;
                let made = room.tangents.stage(system, (i, stages), ends, own);
                made.map_err(|_| Missing::Singular)?;
                system.equations.joint_units(&mut room.units);
            }
            for block in 0..self.blocks.len() {
                self.right(block, &mut system.equations);
                if let Some(room) = &mut self.room {
                    self.blocks[block].stage(
                        &system.equations,
                        &room.tangents,
                        (stages.tableau, i, h),
                        &mut room.right,
                        &mut room.bases,
                    );
                }
            }
        }
        for (end, now) in self.ends.iter_mut().zip(ends) {
            end.clone_from(now);
        }
        for block in &mut self.blocks {
            block.accept();
        }
        self.remember(ends[1]);
        Ok(())
    }

    /// Notes what the gauges read at a sample, and the derivatives.
    fn read(&mut self, index: usize, state: &State) {
        let Some(Room {
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
        self.own
            .torque_by(scratch, state, (&mut *torque, &mut *beside));
        let read = self.own.shaft(scratch, state);
        let room = (&mut force[..], &mut *beside);
        let (own, known) = self.own.gradient(scratch, state, room, gradient.as_mut());
        for (curve, reading) in self.read.iter_mut().zip(own) {
            curve.push(reading);
        }
        let [from, to] = &self.ends;
        let sample = Sample {
            state,
            ends: [from, to],
            own,
            shaft: read,
            known: (!self.own.machine.hooks.has_readings()).then_some(known),
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
                    let size = ends[0].size(lane).max(ends[1].size(lane));
                    let step = MOVED / size;
                    for step in [step, -step].into_iter().filter(|_| size > 0.0) {
                        beside.clone_from(state);
                        add_column(ends, lane, &weights, step, beside);
                        add(0.5 / step, &self.own.readings(scratch, beside, force));
                    }
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

    fn start(
        &mut self,
        system: &mut System<Individual<'_>>,
        state: &State,
        stages: usize,
    ) -> Result<(), Missing> {
        let n = state.q.len();
        let moving = self.active.iter().filter(|active| active.moves());
        let blocks = moving.count().div_ceil(LANES);
        // the explicit first stage is where the step begins, the last one where it ends
        self.blocks = vec![Block::new(n, stages - 2); blocks];
        let asked = |active: &Active<'_>| match active.source {
            Source::Joints(_) => true,
            Source::Pieces(hooks) => hooks.has_axial(),
            Source::Contact { .. } | Source::Difference(..) | Source::Nothing => false,
        };
        let asked = self.active.iter().any(asked);
        let units = match self.own.machine.layout.motion {
            Motion::Plane if asked => n,
            Motion::Plane | Motion::Space => 0,
        };
        let mut room = Room {
            tangents: Tangents::new(&system.equations, state),
            bases: Bases::new(n),
            scratch: Scratch::new(system.equations.machine),
            right: vec![Lanes::default(); n],
            force: [const { Vec::new() }; 2].map(|_: Vec<f64>| vec![0.0; n]),
            units: vec![[0.0; PLANE_UNITS]; units],
            state: state.clone(),
            gradient: Gradient::serves(self.own.machine).then(Gradient::default),
            torque: TorqueBy::default(),
        };
        let made = room.tangents.rest(system, state, &mut room.force[0]);
        made.map_err(|_| Missing::Singular)?;
        system.equations.joint_units(&mut room.units);
        self.room = Some(room);
        let curves = self.active.iter_mut();
        let curves = curves.flat_map(|active| active.curves.each_mut());
        for curve in curves.chain(&mut self.read) {
            curve.reserve_exact(self.settings.samples);
        }
        for block in 0..blocks {
            self.right(block, &mut system.equations);
            if let Some(room) = &mut self.room {
                self.blocks[block].rest(&room.tangents, &mut room.right);
            }
        }
        self.remember(state);
        Ok(())
    }
}

impl Observe for Follower<'_, '_> {
    fn begin(&mut self, system: &mut System<Individual<'_>>, state: &State) {
        self.observer.begin(system, state);
        if let Method::RungeKutta(tableau) = self.settings.method {
            self.missing = self.start(system, state, tableau.stages()).err();
        }
    }

    fn step(
        &mut self,
        system: &mut System<Individual<'_>>,
        ends: [&State; 2],
        stages: Option<Stages<'_>>,
    ) {
        self.observer.step(system, ends, stages);
        if let (None, Some(stages)) = (self.missing, stages) {
            self.missing = self.follow(system, ends, stages).err();
        }
    }

    fn sample(&mut self, index: usize, system: &mut System<Individual<'_>>, state: &State) {
        self.observer.sample(index, system, state);
        if self.missing.is_none() {
            self.read(index, state);
        }
    }

    fn complete(&mut self, machine: &Machine, spacing: f64) {
        self.observer.complete(machine, spacing);
        let filters = |side: &Side<'_>| side.machine.hooks.has_readings();
        let own = filters(&self.own);
        let active = self.active.iter_mut();
        for active in active.filter(|active| own || active.sides.iter().any(filters)) {
            let mut sum =
                [const { Vec::new() }; 4].map(|_: Vec<f64>| vec![0.0; self.read[0].len()]);
            let mut add_series = |side: &Side<'_>, step: f64, share: f64| {
                let mut curves = self.read.clone();
                for (curve, column) in curves.iter_mut().zip(&active.curves.gauge) {
                    add(curve, step, column);
                }
                side.machine.hooks.read_series(spacing, &mut curves);
                for (sum, curve) in sum.iter_mut().zip(&curves) {
                    add(sum, share, curve);
                }
            };
            let Difference {
                steps,
                weights,
                own,
            } = active.difference;
            if own != 0.0 {
                add_series(&self.own, 0.0, own);
            }
            for (k, (step, weight)) in steps.into_iter().zip(weights).enumerate() {
                add_series(active.sides.get(k).unwrap_or(&self.own), step, weight);
            }
            active.curves.gauge = sum;
        }
    }
}

/// A column that was worked out.
fn judged(changes: Changes) -> Derivative {
    let all = |is: fn(&f64) -> bool| changes.each().flatten().all(is);
    if all(|x| *x == 0.0) {
        Derivative::Nothing
    } else if all(|x| x.is_finite()) {
        Derivative::Curves(Box::new(changes))
    } else {
        Derivative::Missing(Missing::NotFinite)
    }
}
