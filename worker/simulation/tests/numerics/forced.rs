//! Forced nonlinear equations of motion with a known solution, for orders of convergence.
use simulation::linear::{BLOCK, Bordered, MatrixEntry};
use simulation::system::{Equations, LoadedState, Powers, State, StateRef, StateShift};

/// Test equations `m(q) a = m(x) x'' + k (x - q) + l (x^3 - q^3) + c (x' - v)` in six coordinates, with `m(q)
/// = 1 + cos(q_0) / 8` and the exact solution `q = x(t)`, `x_i = sin(w_i t + i)`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Forced;

const STIFFNESS: f64 = 40.0;
const CUBIC: f64 = 15.0;
const DAMPING: f64 = 3.0;

fn inertia(q: &[f64]) -> f64 {
    1.0 + 0.125 * q[0].cos()
}

impl Forced {
    /// Returns the exact solution at a time.
    pub(crate) fn exact(t: f64) -> State {
        let mut state = State::at_rest(t, vec![0.0; BLOCK]);
        for i in 0..BLOCK {
            let w = 1.0 + 0.7 * i as f64;
            let (s, c) = (w * t + i as f64).sin_cos();
            (state.q[i], state.v[i], state.a[i]) = (s, w * c, -w * w * s);
        }
        state
    }
}

impl Equations for Forced {
    fn matrix(&self) -> Bordered {
        Bordered::space(&[1], [0; 2])
    }

    fn forces(&mut self, StateRef { t, q, v }: StateRef<'_>, force: &mut [f64]) {
        let x = Self::exact(t);
        let m = inertia(&x.q);
        for i in 0..BLOCK {
            force[i] = m * x.a[i]
                + STIFFNESS * (x.q[i] - q[i])
                + CUBIC * (x.q[i].powi(3) - q[i].powi(3))
                + DAMPING * (x.v[i] - v[i]);
        }
    }

    fn subtract_inertia<T: MatrixEntry>(&self, q: &[f64], a: &[T], out: &mut [T]) {
        let m = inertia(q);
        for (out, a) in out.iter_mut().zip(a) {
            *out -= *a * m;
        }
    }

    fn tangent(&self, at: LoadedState<'_>, shift: StateShift, matrix: &mut Bordered) {
        let q = at.state().q;
        matrix.clear();
        let m = inertia(q);
        for i in 0..BLOCK {
            let stiffness = STIFFNESS + 3.0 * CUBIC * q[i] * q[i];
            matrix.add(i, i, shift.mass * m + shift.damping * DAMPING + stiffness);
        }
    }

    fn add_velocity_inertia_tangent(
        &self,
        at: StateRef<'_>,
        a: &[f64],
        _: f64,
        matrix: &mut Bordered,
    ) {
        for i in 0..BLOCK {
            matrix.add(i, 0, -0.125 * at.q[0].sin() * a[i]);
        }
    }

    fn newton_norm(&self, change: &[f64]) -> f64 {
        change.iter().map(|x| x.abs() / 1e-5).fold(0.0, f64::max)
    }

    fn error_norm(&self, error: &[f64]) -> f64 {
        error.iter().map(|x| x.abs()).fold(0.0, f64::max)
    }

    fn powers(&self, _: LoadedState<'_>, _: &[f64]) -> Powers {
        Powers::default()
    }
}
