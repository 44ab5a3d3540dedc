//! Inertia of the cylinders of a chain.
use super::parts::Chain;
use crate::linear::{BLOCK, Bordered, MatrixEntry};
use crate::math::elementary::sin_cos;
use crate::model::layout::Motion;
use crate::state::StateRef;

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Chain {
    /// Subtracts the product of the cylinders' mass matrix `M(q)` and the accelerations `a` from `out`.
    pub(crate) fn subtract_inertia<T: MatrixEntry>(&self, q: &[f64], a: &[T], out: &mut [T]) {
        let [along, across] = self.inertia;
        let of = self.range();
        let (q, a, out) = (&q[of.clone()], &a[of.clone()], &mut out[of]);
        if self.motion == Motion::Plane {
            let inertia = [self.mass, self.mass, across];
            let (a, _) = a.as_chunks::<3>();
            let (out, _) = out.as_chunks_mut::<3>();
            for (a, out) in a.iter().zip(out) {
                for k in 0..3 {
                    out[k] -= a[k] * inertia[k];
                }
            }
            return;
        }
        let cylinders = q.chunks_exact(6).zip(a.chunks_exact(6));
        for ((q, a), out) in cylinders.zip(out.chunks_exact_mut(6)) {
            let (s, _) = sin_cos(q[4]);
            for k in 0..3 {
                out[k] -= a[k] * self.mass;
            }
            let (a1, a2, a3) = (a[3], a[4], a[5]);
            out[3] -= (a1 - a3 * s) * along;
            out[4] -= a2 * across;
            out[5] -= a3 * (across + (along - across) * s * s) - a1 * (along * s);
        }
    }

    /// Adds the cylinders' mass matrix `M(q)`, multiplied by the factor `mass`, to the system matrix.
    pub(crate) fn add_inertia_blocks(&self, q: &[f64], mass: f64, matrix: &mut Bordered) {
        let [along, across] = self.inertia;
        match matrix {
            Bordered::Plane(matrix) => {
                for j in 0..self.count {
                    let block = matrix.diagonal_mut(self.first + j);
                    block[(0, 0)] += mass * self.mass;
                    block[(1, 1)] += mass * self.mass;
                    block[(2, 2)] += mass * across;
                }
            }
            Bordered::Space(matrix) => {
                for (j, q) in q[self.range()].chunks_exact(6).enumerate() {
                    let (s, _) = sin_cos(q[4]);
                    let block = matrix.diagonal_mut(self.first + j);
                    for k in 0..3 {
                        block[(k, k)] += mass * self.mass;
                    }
                    block[(3, 3)] += mass * along;
                    block[(3, 5)] -= mass * along * s;
                    block[(5, 3)] -= mass * along * s;
                    block[(4, 4)] += mass * across;
                    block[(5, 5)] += mass * (across + (along - across) * s * s);
                }
            }
        }
    }

    /// Adds the contribution of the velocity-dependent inertia terms and of `M(q) a` to the matrix `-damping
    /// D - K`.
    pub(crate) fn add_spin_tangent(
        &self,
        StateRef { q, v, .. }: StateRef<'_>,
        a: &[f64],
        damping: f64,
        matrix: &mut Bordered,
    ) {
        // in the plane nothing tilts, and a cylinder's inertia is a constant
        let Bordered::Space(matrix) = matrix else {
            return;
        };
        for j in 0..self.count {
            let at = (self.first + j) * BLOCK + 3;
            let turns = at..at + 3;
            let by = self.spin_derivatives(q[at + 1], &v[turns.clone()], &a[turns]);
            let block = matrix.diagonal_mut(self.first + j);
            for (row, (by_tilt, by_rate)) in by.iter().enumerate() {
                block[(3 + row, 4)] -= by_tilt;
                for (column, by_rate) in by_rate.iter().enumerate() {
                    block[(3 + row, 3 + column)] -= damping * by_rate;
                }
            }
        }
    }

    /// Returns the derivatives of the three generalised inertial torques of a cylinder with respect to its
    /// tilt and to the rates of its angles.
    fn spin_derivatives(&self, tilt: f64, v: &[f64], a: &[f64]) -> [(f64, [f64; 3]); 3] {
        let [along, across] = self.inertia;
        let (s, c) = sin_cos(tilt);
        let [r1, r2, r3] = [v[0], v[1], v[2]];
        let spin = along * (r1 - s * r3);
        let double = c * c - s * s;
        [
            (
                along * (c * a[2] - s * r2 * r3),
                [0.0, along * c * r3, along * c * r2],
            ),
            (
                s * r3 * spin + along * c * c * r3 * r3 - across * double * r3 * r3,
                [
                    -along * c * r3,
                    0.0,
                    -c * spin + along * c * s * r3 - 2.0 * across * c * s * r3,
                ],
            ),
            (
                -s * r2 * spin - along * c * c * r2 * r3
                    + (2.0 * across - along) * double * r2 * r3
                    - 2.0 * (along - across) * s * c * a[2]
                    + along * c * a[0],
                [
                    along * c * r2,
                    c * spin + (2.0 * across - along) * s * c * r3,
                    2.0 * (across - along) * s * c * r2,
                ],
            ),
        ]
    }

    /// Adds `lambda W` to the matrix for the equilibrium search; the diagonal `W` weights a cylinder's
    /// displacement by 1 and its rotations by the squared length, so that both measure displacement of its
    /// ends.
    pub(crate) fn add_static_weight(&self, lambda: f64, matrix: &mut Bordered) {
        let turning = lambda * self.pitch * self.pitch;
        for j in self.first..self.first + self.count {
            for (k, &full) in self.motion.kept().iter().enumerate() {
                matrix.add_diagonal(j, k, k, if full < 3 { lambda } else { turning });
            }
        }
    }
}
