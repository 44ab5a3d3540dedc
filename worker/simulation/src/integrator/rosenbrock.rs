//! RODAS: a Rosenbrock method of order 4 (3) with six stages, stiffly accurate and L-stable. Hairer and
//! Wanner (1996), section VI.4.
//!
//! The equations are taken as `q' = v`, `v' = a`, `0 = Q(q, v, t) - M(q) a`, a differential-algebraic system
//! of the kind the method was designed for; accelerations are unknowns like the others. Eliminating rates and
//! accelerations of a stage leaves one solution with `S = g^2 M - g D - K`, `g = 1 / (gamma h)`, the
//! iteration matrix of all other methods, and one product with `K`. The order needs the exact tangent: this
//! is the only method that adds the terms that Newton's method can omit ([`Equations::add_velocity_inertia_tangent`]).
use super::dense::interpolate;
use super::newton::NotConverged;
use super::stepper::{StepResult, Stepper, TimeStep};
use crate::linear::Bordered;
use crate::math::vector::add_scaled;
use crate::system::{Equations, Powers, State, StateRef, StateShift, System};

const STAGES: usize = 6;
const GAMMA: f64 = 0.25;
/// Times of the stages within the step, as shares of the step.
const NODES: [f64; STAGES] = [0.0, 0.386, 0.21, 0.63, 1.0, 1.0];
/// Coefficients with which the forces' time derivative enters the stages.
const BY_TIME: [f64; STAGES] = [0.25, -0.1043, 0.1035, -0.036_200_000_000_000_23, 0.0, 0.0];
/// Weights of earlier stages' increments in the argument of each stage (the state at which it is evaluated).
/// The sixth argument is the fifth plus the fifth increment; the result is the sixth argument plus the sixth
/// increment.
const ARGUMENT: [&[f64]; STAGES] = [
    &[],
    &[1.544],
    &[0.946_678_528_081_582_6, 0.255_701_169_898_328_4],
    &[
        3.314_825_187_068_521,
        2.896_124_015_972_201,
        0.998_641_913_997_781_7,
    ],
    &[
        1.221_224_509_226_641,
        6.019_134_481_288_629,
        12.537_083_329_320_87,
        -0.687_886_036_105_895,
    ],
    &[
        1.221_224_509_226_641,
        6.019_134_481_288_629,
        12.537_083_329_320_87,
        -0.687_886_036_105_895,
        1.0,
    ],
];
/// Weights of earlier stages' increments in the right-hand side of each stage; still to be divided by the
/// step `h`.
const RIGHT: [&[f64]; STAGES] = [
    &[],
    &[-5.6688],
    &[-2.430_093_356_833_875, -0.206_359_915_709_191_5],
    &[
        -0.107_352_905_815_137_5,
        -9.594_562_251_023_355,
        -20.470_286_148_096_16,
    ],
    &[
        7.496_443_313_967_647,
        -10.246_804_314_643_52,
        -33.999_903_528_199_05,
        11.708_908_932_061_6,
    ],
    &[
        8.083_246_795_921_522,
        -7.981_132_988_064_893,
        -31.521_594_328_743_71,
        16.319_305_431_231_36,
        -6.058_818_238_834_054,
    ],
];

/// Time increment, as a share of the step `h`, of the forward difference that gives the forces' time
/// derivative; its error is this share of a term of order `h`.
const TIME_SHARE: f64 = 1e-5;

/// Increments of coordinates, rates and accelerations of one stage.
#[derive(Clone, Debug)]
struct Increment {
    q: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
}

/// RODAS method with its buffers.
#[derive(Clone, Debug)]
pub struct Rosenbrock {
    /// Negative stiffness matrix `-K`.
    stiffness: Bordered,
    increments: Vec<Increment>,
    powers: [Powers; 2],
    /// Time derivative of the forces.
    by_time: Vec<f64>,
    /// Velocity part of a stage's right-hand side: rates of the stage's argument plus the coordinate
    /// increments of earlier stages, weighted by [`RIGHT`] and divided by the step.
    rates: Vec<f64>,
    /// Acceleration part of a stage's right-hand side: accelerations of the stage's argument plus the rate
    /// increments of earlier stages, weighted by [`RIGHT`] and divided by the step.
    inertial: Vec<f64>,
    right: Vec<f64>,
    product: Vec<f64>,
    middle: State,
}

impl Rosenbrock {
    /// Creates the method; `matrix` is an empty matrix with the structure of the system's iteration matrix.
    pub fn new(matrix: Bordered) -> Self {
        let n = matrix.len();
        let zeros = || vec![0.0; n];
        let increment = || Increment {
            q: zeros(),
            v: zeros(),
            a: zeros(),
        };
        Self {
            stiffness: matrix,
            increments: (0..STAGES).map(|_| increment()).collect(),
            powers: [Powers::default(); 2],
            by_time: zeros(),
            rates: zeros(),
            inertial: zeros(),
            right: zeros(),
            product: zeros(),
            middle: State::at_rest(0.0, zeros()),
        }
    }

    /// Computes the time derivative of the forces and the matrix `-K` at the start of a step, and factorises
    /// the iteration matrix `S`.
    fn linearize<E: Equations>(
        &mut self,
        system: &mut System<E>,
        from: &State,
        h: f64,
    ) -> Result<(), NotConverged> {
        let StateRef { t, q, v } = from.motion();
        let later = TIME_SHARE * h;
        system.forces(StateRef { t: t + later, q, v }, &mut self.by_time);
        let mut loads = system.forces(from.motion(), &mut self.right);
        for (by_time, now) in self.by_time.iter_mut().zip(&self.right) {
            *by_time = (*by_time - now) / later;
        }
        let g = 1.0 / (GAMMA * h);
        loads.exact_tangent(&from.a, StateShift::NONE, &mut self.stiffness);
        let shift = StateShift {
            mass: g * g,
            damping: g,
        };
        loads
            .factorize_exact(&from.a, shift)
            .map_err(|_| NotConverged)
    }

    /// Computes the state at which stage `i` is evaluated (its argument) into `to`.
    fn argument(&self, i: usize, from: &State, to: &mut State) {
        to.q.copy_from_slice(&from.q);
        to.v.copy_from_slice(&from.v);
        to.a.copy_from_slice(&from.a);
        for (&weight, increment) in ARGUMENT[i].iter().zip(&self.increments) {
            add_scaled(&mut to.q, weight, &increment.q);
            add_scaled(&mut to.v, weight, &increment.v);
            add_scaled(&mut to.a, weight, &increment.a);
        }
    }

    /// Solves for the increments of stage `i`, whose argument is the state `to`.
    fn solve<E: Equations>(
        &mut self,
        i: usize,
        system: &mut System<E>,
        (from, to): (&State, &State),
        h: f64,
    ) {
        let g = 1.0 / (GAMMA * h);
        self.rates.copy_from_slice(&to.v);
        self.inertial.copy_from_slice(&to.a);
        for (&weight, increment) in RIGHT[i].iter().zip(&self.increments) {
            add_scaled(&mut self.rates, weight / h, &increment.q);
            add_scaled(&mut self.inertial, weight / h, &increment.v);
        }
        // S w = g (R + h_i R_t + M z) + K p with p, z the sums above; the unknowns are q and v
        let t = from.t + NODES[i] * h;
        let at = StateRef { t, ..to.motion() };
        system.residual(at, &to.a, &mut self.right);
        add_scaled(&mut self.right, BY_TIME[i] * h, &self.by_time);
        for inertial in &mut self.inertial {
            *inertial = -*inertial;
        }
        system
            .equations
            .subtract_inertia(&from.q, &self.inertial, &mut self.right);
        self.stiffness.multiply(&self.rates, &mut self.product);
        for (right, product) in self.right.iter_mut().zip(&self.product) {
            *right = g * *right - product;
        }
        system.solve(&mut self.right);
        system.statistics.newton_iterations += 1;
        let increment = &mut self.increments[i];
        for k in 0..self.right.len() {
            let v = self.right[k];
            increment.q[k] = (v + self.rates[k]) / g;
            increment.v[k] = v;
            increment.a[k] = g * v + self.inertial[k];
        }
    }
}

impl<E: Equations> Stepper<E> for Rosenbrock {
    fn step(&mut self, system: &mut System<E>, from: &State, h: f64, to: &mut State) -> StepResult {
        self.linearize(system, from, h)?;
        for i in 0..STAGES {
            self.argument(i, from, to);
            self.solve(i, system, (from, to), h);
        }
        let last = &self.increments[STAGES - 1];
        add_scaled(&mut to.q, 1.0, &last.q);
        add_scaled(&mut to.v, 1.0, &last.v);
        add_scaled(&mut to.a, 1.0, &last.a);
        to.t = from.t + h;
        // work by Simpson's rule on the dense output
        interpolate(from, to, from.t + 0.5 * h, &mut self.middle);
        let loads = system.forces(self.middle.motion(), &mut self.right);
        let middle = loads.powers(&self.middle.a);
        let loads = system.forces(to.motion(), &mut self.right);
        self.powers[1] = loads.powers(&to.a);
        let mut work = Powers::default();
        work.add(h / 6.0, &self.powers[0]);
        work.add(4.0 * h / 6.0, &middle);
        work.add(h / 6.0, &self.powers[1]);
        Ok(TimeStep {
            error: system.equations.error_norm(&self.increments[STAGES - 1].q),
            work,
        })
    }

    fn accept(&mut self, _: &E, _: &State) {
        self.powers[0] = self.powers[1];
    }

    fn error_order(&self) -> f64 {
        4.0
    }
}
