//! Propagation of several columns of the state, side by side in SIMD lanes, through the stages of a step.
use super::linearized::Linearized;
use crate::integrator::tableau::Tableau;
use crate::linear::Lanes;
use crate::system::Equations;
use pulp::{Arch, Scalar, Simd, WithSimd};

/// Derivatives of coordinates, rates and accelerations of a state with respect to the unknowns, one lane per
/// unknown.
#[derive(Clone, Debug)]
pub(super) struct Motion {
    pub(super) q: Vec<Lanes>,
    pub(super) v: Vec<Lanes>,
    pub(super) a: Vec<Lanes>,
}

/// Block of columns, one per SIMD lane, for a state and for the stages of the step that begins there.
#[derive(Clone, Debug)]
pub(super) struct Block {
    /// Derivatives of the states at the start and at the end of the step.
    pub(super) ends: [Motion; 2],
    /// Derivatives of the rates at the intermediate stages of the step.
    rates: Vec<Vec<Lanes>>,
    /// Whether all derivatives of the block are still zero.
    zero: bool,
}

/// Workspace for the part of a stage's derivatives that does not depend on the rate at the same stage:
/// derivatives of the coordinates, and `-v / c` of the rates.
#[derive(Clone, Debug)]
pub(super) struct StagePredictor {
    q: Vec<Lanes>,
    scaled: Vec<Lanes>,
}

impl Motion {
    fn new(n: usize) -> Self {
        let zeros = || vec![Lanes::default(); n];
        Self {
            q: zeros(),
            v: zeros(),
            a: zeros(),
        }
    }

    /// Returns the largest absolute derivative of any coordinate in one lane.
    pub(super) fn size(&self, lane: usize) -> f64 {
        self.q.iter().fold(0.0, |size, q| q.0[lane].abs().max(size))
    }
}

impl StagePredictor {
    pub(super) fn new(n: usize) -> Self {
        let Motion { q, v, .. } = Motion::new(n);
        Self { q, scaled: v }
    }

    /// Computes the part of a stage's derivatives that does not depend on the rate at the same stage.
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    fn fill<S: Simd>(
        &mut self,
        simd: S,
        parts: &StageWeights,
        from: &Motion,
        rates: &[Vec<Lanes>],
    ) {
        let StageWeights {
            first: [to_q, to_s],
            acceleration,
            rates: weights,
        } = *parts;
        let starts = from.q.iter().zip(from.v.iter().zip(&from.a));
        for ((q, s), (from_q, (v, a))) in self.q.iter_mut().zip(&mut self.scaled).zip(starts) {
            *q = *from_q;
            q.add_scaled(simd, v, to_q);
            *s = v.scaled(simd, to_s);
            s.add_scaled(simd, a, acceleration);
        }
        for (rate, [to_q, to_s]) in rates.iter().zip(weights) {
            for ((q, s), v) in self.q.iter_mut().zip(&mut self.scaled).zip(rate) {
                q.add_scaled(simd, v, to_q);
                s.add_scaled(simd, v, to_s);
            }
        }
    }
}

/// Maximum number of stages of an integration method.
const STAGES: usize = 8;

/// Weights with which the start of a step and the rates of earlier stages enter the derivatives of a stage:
/// of its coordinates and of `-v / c` of its rates. Accelerations of stages are differences of rates and are
/// not stored.
struct StageWeights {
    first: [f64; 2],
    acceleration: f64,
    rates: [[f64; 2]; STAGES],
}

impl StageWeights {
    /// Computes the weights of stage `i` of a step of size `h`.
    fn new(tableau: &Tableau, i: usize, h: f64) -> Self {
        // base_j = x_j v_0 + y_j a_0 + sum z_jk v_k, and a_j = (v_j - base_j) / c
        let (mut x, mut y) = ([1.0; STAGES], [0.0; STAGES]);
        let mut z = [[0.0; STAGES]; STAGES];
        for j in 1..=i {
            let row = tableau.rows[j];
            y[j] = h * row[0];
            for (k, weight) in row.iter().enumerate().skip(1) {
                let share = weight / tableau.diagonal;
                x[j] -= share * x[k];
                y[j] -= share * y[k];
                z[j][k] += share;
                for l in 1..k {
                    z[j][l] -= share * z[k][l];
                }
            }
        }
        let shift = 1.0 / (tableau.diagonal * h);
        let row = tableau.rows[i];
        let mut rates = [[0.0; 2]; STAGES];
        for (k, weight) in row.iter().enumerate().skip(1) {
            rates[k - 1] = [h * weight, -z[i][k] * shift];
        }
        Self {
            first: [h * row[0], -x[i] * shift],
            acceleration: -y[i] * shift,
            rates,
        }
    }
}

/// Arguments for computing one stage of a block of derivative columns.
struct Advance<'a, E> {
    block: &'a mut Block,
    equations: &'a E,
    tangents: &'a Linearized,
    /// Coefficients of the integration method, index of the stage, size of the step.
    at: (&'a Tableau, usize, f64),
    /// Right-hand side `dR/dp` of the linear system for the derivatives, overwritten by its solution.
    right: &'a mut [Lanes],
    bases: &'a mut StagePredictor,
}

impl<E: Equations> WithSimd for Advance<'_, E> {
    type Output = ();

    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self {
            block,
            tangents,
            at: (tableau, i, h),
            right,
            bases,
            ..
        } = self;
        let Block {
            ends: [from, to],
            rates,
            ..
        } = block;
        let shift = 1.0 / (tableau.diagonal * h);
        bases.fill(
            simd,
            &StageWeights::new(tableau, i, h),
            from,
            &rates[..i - 1],
        );
        tangents
            .stiffness
            .subtract_product_lanes(simd, &bases.q, right);
        let q = &tangents.state.q;
        self.equations.subtract_inertia(q, &bases.scaled, right);
        tangents.factor.solve_lanes(simd, right);
        if let Some(v) = rates.get_mut(i - 1) {
            for (v, w) in v.iter_mut().zip(right) {
                *v = w.scaled(simd, shift);
            }
            return;
        }
        for (k, w) in right.iter().enumerate() {
            to.q[k] = bases.q[k] + *w;
            to.v[k] = w.scaled(simd, shift);
            to.a[k] = bases.scaled[k];
            to.a[k].add_scaled(simd, &to.v[k], shift);
        }
    }
}

impl Block {
    /// Creates zero derivatives for `n` coordinates and an integration method with `stages` intermediate
    /// stages.
    pub(super) fn new(n: usize, stages: usize) -> Self {
        Self {
            ends: [Motion::new(n), Motion::new(n)],
            rates: vec![vec![Lanes::default(); n]; stages],
            zero: true,
        }
    }

    /// Returns whether the block's derivatives remain zero: they are zero, and so is `dR/dp`.
    fn remains_zero(&mut self, right: &[Lanes]) -> bool {
        self.zero = self.zero && right.iter().all(|x| *x == Lanes::default());
        self.zero
    }

    /// Computes the block's derivatives at the static equilibrium from the right-hand side `dR/dp` in
    /// `right`.
    pub(super) fn rest(&mut self, tangents: &Linearized, right: &mut [Lanes]) {
        if self.remains_zero(right) {
            return;
        }
        tangents.factor.solve_lanes(Scalar, right);
        self.ends[0].q.copy_from_slice(right);
    }

    /// Computes the block's derivatives at stage `i` of a step of size `h` from the right-hand side `dR/dp`
    /// in `right`.
    pub(super) fn stage<E: Equations>(
        &mut self,
        equations: &E,
        tangents: &Linearized,
        at: (&Tableau, usize, f64),
        right: &mut [Lanes],
        bases: &mut StagePredictor,
    ) {
        if self.remains_zero(right) {
            return;
        }
        let stage = Advance {
            block: self,
            equations,
            tangents,
            at,
            right,
            bases,
        };
        Arch::new().dispatch(stage);
    }

    /// Accepts the step: the derivatives at its end become those at the start of the next step.
    pub(super) const fn accept(&mut self) {
        let [from, to] = &mut self.ends;
        std::mem::swap(from, to);
    }
}
