//! Analytic iteration matrix `S = mass M - damping D - K` with `K = dQ/dq`, `D = dQ/dv`.
//!
//! The integrator chooses the factors `mass` and `damping` ([`StateShift`]); the tangents of the joints and
//! contacts do not depend on them. The derivatives of the cylinders' velocity terms and of their inertia with
//! respect to the angles are omitted: a cylinder's moment of inertia is 1e-6 kg m2, so the omission has no
//! measurable effect on the convergence of Newton's method and none on its solution.
use crate::element::bushing::LinkTangent;
use crate::linear::Bordered;
use crate::math::elementary::sin_cos;
use crate::model::anchor::Anchor;
use crate::model::chain::tangent::{Column, EndTangent};
use crate::model::force_buffers::ForceBuffers;
use crate::model::machine::Machine;
use crate::model::machine_state::MachineState;
use crate::model::parallel_ropes::BACK;
use crate::model::pose::Pose;
use crate::state::StateShift;

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Machine {
    /// Computes `mass M - damping D - K` into `matrix` at a state whose loads and poses are in `scratch` and, if
    /// a second matrix is given, `-K` into that.
    pub(super) fn tangent(
        &self,
        at: &MachineState<'_>,
        shift: StateShift,
        scratch: &ForceBuffers,
        (mut stiffness, matrix): (Option<&mut Bordered>, &mut Bordered),
    ) {
        let gamma = shift.damping;
        matrix.clear();
        if let Some(stiffness) = &mut stiffness {
            stiffness.clear();
        }
        for (k, chain) in self.chains.iter().enumerate() {
            let state = &scratch.chains[k];
            let joints = self.joints(k, at);
            let both = (stiffness.as_deref_mut(), &mut *matrix);
            chain.add_joint_tangent(&joints, state, gamma, both);
            let surface = self.surface(k, at.q, at.v, &scratch.deflection);
            let both = (stiffness.as_deref_mut(), &mut *matrix);
            chain.add_contact_tangent((&surface, &at.ropes.contact), state, gamma, both);
            if let Some(stiffness) = stiffness.as_deref_mut() {
                let both = &mut [(0.0, stiffness), (gamma, &mut *matrix)];
                self.end_tangents(k, at, scratch, both);
            } else {
                self.end_tangents(k, at, scratch, &mut [(gamma, &mut *matrix)]);
            }
        }
        for (StateShift { mass, damping }, matrix) in stiffness
            .map(|stiffness| (StateShift::NONE, stiffness))
            .into_iter()
            .chain([(shift, matrix)])
        {
            self.inertia_blocks(at.q, mass, matrix);
            self.rigid_tangent(at, damping, matrix);
            self.extensions.add_tangent(at, damping, matrix);
        }
    }

    /// Adds the tangent of a chain's end joints to each of the given matrices. The number paired with a
    /// matrix is the factor of the damping tangent in that matrix.
    fn end_tangents(
        &self,
        chain: usize,
        at: &MachineState<'_>,
        scratch: &ForceBuffers,
        matrices: &mut [(f64, &mut Bordered)],
    ) {
        let (own, state) = (&self.chains[chain], &scratch.chains[chain]);
        let joints = self.joints(chain, at);
        let ends = own.ends(&joints, state);
        for (damping, matrix) in matrices {
            let [base, head] = own.add_end_tangent(&ends, *damping, matrix);
            if let Some(base) = base {
                self.base_tangent(chain, &base, &state.pose(0), *damping, matrix);
            }
            if let (Some(end), Some(load)) = (head, state.joints.last()) {
                let anchor = Anchor {
                    chain,
                    block: own.first + own.count - 1,
                    end: &end,
                    load,
                    pose: &state.pose(own.count - 1),
                };
                self.anchor_tangent(&anchor, at, *damping, matrix);
            }
        }
    }

    fn inertia_blocks(&self, q: &[f64], mass: f64, matrix: &mut Bordered) {
        let d = &self.description;
        for (at, inertia) in [
            (self.layout.rod(), self.rod_inertia()),
            (self.layout.suspension(), d.suspension_mass),
        ] {
            matrix.add(at, at, mass * inertia);
        }
        for block in self.layout.base_blocks().into_iter().flatten() {
            matrix.lock_rest(block);
        }
        for chain in &self.chains {
            chain.add_inertia_blocks(q, mass, matrix);
        }
        matrix.add_corner(0, 0, mass * d.beam_inertia);
        for k in 0..self.layout.modes {
            let coupling = mass * d.head.participation[k][2];
            matrix.add_corner(1 + k, 1 + k, mass);
            matrix.add_corner(0, 1 + k, coupling);
            matrix.add_corner(1 + k, 0, coupling);
        }
    }

    /// Adds the tangent of weights and of the head's modal stiffness and damping to `matrix`.
    fn rigid_tangent(&self, at: &MachineState<'_>, damping: f64, matrix: &mut Bordered) {
        let &MachineState { q, drive, .. } = at;
        let d = &self.description;
        let g = d.gravity;
        let rod = self.layout.rod();
        let (s, c) = sin_cos(q[rod]);
        let pin = drive.pin[2];
        let hanging = d.rod.mass * d.rod.center_of_mass * ((pin.y + g) * s + pin.x * c);
        matrix.add(rod, rod, -hanging);
        let (s, c) = sin_cos(q[self.layout.beam()]);
        matrix.add_corner(0, 0, -d.beam_potential((s, c)));
        for k in 0..self.layout.modes {
            let [px, py, _] = d.head.participation[k];
            let w = d.head.frequencies[k];
            let x = q[self.layout.mode(k)];
            matrix.add_corner(
                1 + k,
                1 + k,
                w * w + damping * 2.0 * d.head.damping_ratio * w,
            );
            let turning = g * (px * c - py * s);
            matrix.add_corner(1 + k, 0, turning);
            matrix.add_corner(0, 1 + k, turning);
            matrix.add_corner(0, 0, -x * g * (py * c + px * s));
        }
    }

    /// Adds the tangent of the joint between rod or suspension and the first cylinder to `matrix`.
    fn base_tangent(
        &self,
        chain: usize,
        end: &EndTangent,
        pose: &Pose,
        damping: f64,
        matrix: &mut Bordered,
    ) {
        let back = self.strands[chain].rope == BACK;
        let base = if back {
            self.layout.rod()
        } else {
            self.layout.suspension()
        };
        let first = self.chains[chain].range().start;
        let column = base_column(back, &end.by_body, damping);
        let row_j = |c: &Column| if back { c[2].z } else { -c[0].y };
        matrix.add(base, base, -row_j(&column));
        let torque = pose.angular().tr_mul(&column[1]);
        for (k, &full) in self.layout.motion.kept().iter().enumerate() {
            matrix.add(base, first + k, -row_j(&end.by_cylinder.column(full)));
            let pull = if full < 3 {
                column[0][full]
            } else {
                torque[full - 3]
            };
            matrix.add(first + k, base, -pull);
        }
    }
}

/// Returns the derivatives of a base joint's load with respect to the rod's angle or the suspension's height.
fn base_column(rod: bool, by: &LinkTangent, damping: f64) -> Column {
    std::array::from_fn(|r| {
        if rod {
            (by.a[r] + by.w[r] * damping).column(2).into_owned()
        } else {
            (by.p[r] + by.v[r] * damping).column(1).into_owned()
        }
    })
}
