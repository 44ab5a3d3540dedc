//! The equations of motion of one individual as an integrator sees them.
use crate::drive::{Drive, DriveState};
use crate::integrator::State;
use crate::linear::{BLOCK, Bordered, SingularPivot};
use crate::model::{Instant, Machine, Powers, Ropes, Scratch};
use crate::statistics::Statistics;

/// Machine, ropes, drive and every buffer: `M(q) a = Q(q, v, t)`.
#[derive(Debug)]
pub struct System<'a> {
    /// The machine.
    pub machine: &'a Machine,
    /// One individual's ropes.
    pub ropes: Ropes,
    /// Crank and load over time.
    pub drive: Drive,
    /// Loads and poses of the last evaluation.
    pub scratch: Scratch,
    /// Work done so far.
    pub statistics: Statistics,
    matrix: Bordered,
    at: (f64, DriveState),
}

impl<'a> System<'a> {
    /// Joins machine, ropes and drive; allocates every buffer.
    pub fn new(machine: &'a Machine, ropes: Ropes, drive: Drive) -> Self {
        let layout = machine.layout;
        Self {
            machine,
            ropes,
            drive,
            scratch: Scratch::new(&layout),
            statistics: Statistics::default(),
            matrix: Bordered::new(&layout.chains(), 1 + layout.modes),
            at: (0.0, drive.state(machine, 0.0)),
        }
    }

    /// Number of coordinates.
    pub fn len(&self) -> usize {
        self.machine.layout.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Crank and load at time `t`.
    pub fn drive_state(&mut self, t: f64) -> DriveState {
        if t.to_bits() != self.at.0.to_bits() {
            self.at = (t, self.drive.state(self.machine, t));
        }
        self.at.1
    }

    /// `Q(q, v, t)`.
    pub fn forces(&mut self, t: f64, q: &[f64], v: &[f64], force: &mut [f64]) {
        let drive = self.drive_state(t);
        self.forces_under(&drive, q, v, force);
    }

    /// `Q` under a given crank and load.
    pub fn forces_under(&mut self, drive: &DriveState, q: &[f64], v: &[f64], force: &mut [f64]) {
        self.statistics.force_evaluations += 1;
        let ropes = &self.ropes;
        let at = Instant { ropes, drive, q, v };
        self.machine.forces(&at, &mut self.scratch, force);
    }

    /// Residual `Q - M a`.
    pub fn residual(&mut self, t: f64, q: &[f64], v: &[f64], a: &[f64], out: &mut [f64]) {
        self.forces(t, q, v, out);
        self.machine.subtract_inertia(q, a, out);
    }

    /// Factorises `mu M - gamma D - K` at the state of the last force evaluation.
    ///
    /// # Errors
    /// The unknown whose pivot vanished.
    pub fn factorize(
        &mut self,
        drive: &DriveState,
        (q, v): (&[f64], &[f64]),
        (mu, gamma): (f64, f64),
    ) -> Result<(), SingularPivot> {
        self.assemble(drive, (q, v), (mu, gamma));
        self.statistics.factorizations += 1;
        self.matrix.factorize()
    }

    /// Factorises `-K + lambda W`: `W` measures a metre of a cylinder or 3.6 m of the beam's tip
    /// alike.
    ///
    /// # Errors
    /// The unknown whose pivot vanished.
    pub fn factorize_static(
        &mut self,
        drive: &DriveState,
        (q, v): (&[f64], &[f64]),
        lambda: f64,
    ) -> Result<(), SingularPivot> {
        self.assemble(drive, (q, v), (0.0, 0.0));
        if lambda > 0.0 {
            let layout = self.machine.layout;
            let length = self.machine.description.rope.pitch;
            for chain in 0..2 {
                let base = layout.base_block(chain);
                self.matrix.diagonal_mut(base)[(0, 0)] += lambda;
                for j in 1..=self.machine.cylinders(chain) {
                    let block = self.matrix.diagonal_mut(base + j);
                    for k in 0..BLOCK {
                        block[(k, k)] += if k < 3 {
                            lambda
                        } else {
                            lambda * length * length
                        };
                    }
                }
            }
            let arm = self.machine.description.front_arc.radius;
            self.matrix.add_corner(0, 0, lambda * arm * arm);
        }
        self.statistics.factorizations += 1;
        self.matrix.factorize()
    }

    fn assemble(&mut self, drive: &DriveState, (q, v): (&[f64], &[f64]), (mu, gamma): (f64, f64)) {
        self.statistics.jacobians += 1;
        let ropes = &self.ropes;
        let at = Instant { ropes, drive, q, v };
        self.machine
            .tangent(&at, (mu, gamma), &self.scratch, &mut self.matrix);
    }

    /// Solves with the last factorisation, in place.
    pub fn solve(&self, x: &mut [f64]) {
        self.matrix.solve(x);
    }

    /// Powers at the state of the last force evaluation.
    pub fn powers(&mut self, t: f64, q: &[f64], v: &[f64], a: &[f64]) -> Powers {
        let drive = &self.drive_state(t);
        let ropes = &self.ropes;
        let at = Instant { ropes, drive, q, v };
        self.machine.powers(&at, a, &self.scratch)
    }

    /// Kinetic and potential energy at a state, without the load's \[J\].
    pub fn energy(&mut self, state: &State) -> f64 {
        let State { t, q, v, .. } = state;
        let drive = &self.drive_state(*t);
        self.machine.pose(q, v, &mut self.scratch.poses);
        let ropes = &self.ropes;
        self.machine
            .energy(&Instant { ropes, drive, q, v }, &self.scratch)
    }

    /// Largest change over all coordinates, in units of Newton's accuracy.
    pub fn newton_norm(&self, change: &[f64]) -> f64 {
        let layout = self.machine.layout;
        let mut norm: f64 = 0.0;
        for chain in 0..2 {
            let base = layout.base_block(chain);
            let unit = if chain == 0 { ANGLE } else { LENGTH };
            norm = worst(norm, change[base * BLOCK] / unit);
            for x in change[(base + 1) * BLOCK..(base + 1 + self.machine.cylinders(chain)) * BLOCK]
                .chunks_exact(BLOCK)
            {
                for k in 0..3 {
                    norm = worst(norm, x[k] / LENGTH);
                    norm = worst(norm, x[3 + k] / TURN);
                }
            }
        }
        norm = worst(norm, change[layout.beam()] / ANGLE);
        for k in 0..layout.modes {
            norm = worst(norm, change[layout.mode(k)] / MODAL);
        }
        norm
    }

    /// Local error: root mean square over what is measured, largest over the cylinders (loosely).
    pub fn error_norm(&self, error: &[f64]) -> f64 {
        let layout = self.machine.layout;
        let mut sum = square(error[layout.rod()] / 5e-5)
            + square(error[layout.suspension()] / 5e-5)
            + square(error[layout.beam()] / 1e-5);
        for k in 0..layout.modes {
            sum += square(error[layout.mode(k)] / 2e-5);
        }
        let mut norm = (sum / (3 + layout.modes) as f64).sqrt();
        for chain in 0..2 {
            let first = (layout.base_block(chain) + 1) * BLOCK;
            for x in error[first..first + self.machine.cylinders(chain) * BLOCK].chunks_exact(BLOCK)
            {
                for k in 0..3 {
                    norm = worst(norm, x[k] / 2e-4);
                    norm = worst(norm, x[3 + k] / 5e-3);
                }
            }
        }
        norm
    }
}

/// Newton's accuracy: cylinder place \[m\], cylinder angle \[rad\], beam and rod angle \[rad\], modal
/// coordinate [kg^1/2 m].
const LENGTH: f64 = 2e-6;
const TURN: f64 = 2e-5;
const ANGLE: f64 = 1e-6;
const MODAL: f64 = 2e-6;

fn square(x: f64) -> f64 {
    x * x
}

/// The larger absolute value; not a number wins, so that it cannot hide.
fn worst(norm: f64, x: f64) -> f64 {
    let x = x.abs();
    if x <= norm { norm } else { x }
}
