//! Forces and tangent of the joints between cylinders that move in the plane.
//!
//! The two end joints use their spatial form in the plane too.
use super::link::Side;
use super::parts::{Chain, Joints};
use super::state::ChainState;
use crate::element::bushing::Bushing;
use crate::element::plane::{PLANE_COEFFICIENTS, PlaneColumn};
use crate::linear::{Blocks, MatrixBlock};

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Chain {
    /// Adds the forces of all joints on cylinders in the plane to the generalised forces; stores the joints'
    /// loads in `state`.
    pub(super) fn add_plane_joints(
        &self,
        joints: &Joints<'_>,
        state: &mut ChainState,
        force: &mut [f64],
    ) {
        self.add_plane_ends(joints, state, force);
        let force = &mut force[self.range()];
        // on the cylinder between two joints, in registers: what was stored a moment ago is slow to read
        let mut carried = [force[0], force[1], force[2]];
        for joint in 1..self.count {
            let [i, j] = self.plane_markers(joint, &state.plane);
            let mut load = joints.inner.plane_load(&i, &j);
            if let Some(pull) = self.pull(joint, joints, state) {
                load.add_pull((&i, &j), &pull);
            }
            let at = &mut force[(joint - 1) * 3..][..6];
            at[0] = carried[0] - load.force.x;
            at[1] = carried[1] - load.force.y;
            at[2] = carried[2] + load.torque_j;
            carried[0] = at[3] + load.force.x;
            carried[1] = at[4] + load.force.y;
            carried[2] = at[5] + load.torque_i;
            let kept = &mut state.joints[joint];
            kept.force.x = load.force.x;
            kept.force.y = load.force.y;
            kept.torque_i.z = load.torque_i;
            kept.torque_j.z = load.torque_j;
            kept.axial = load.axial;
            kept.dissipated = load.dissipated;
        }
        force[(self.count - 1) * 3..].copy_from_slice(&carried);
    }

    /// Adds, per coordinate, the forces of the joints between cylinders per unit of each joint coefficient,
    /// as defined by [`Bushing::plane_units`]; does nothing for a chain in space.
    pub(crate) fn add_plane_units(
        &self,
        state: &ChainState,
        units: &mut [[f64; PLANE_COEFFICIENTS]],
    ) {
        let Some(units) = units.get_mut(self.range()) else {
            return;
        };
        for joint in 1..self.count.min(state.plane.len()) {
            let [i, j] = self.plane_markers(joint, &state.plane);
            let own = Bushing::plane_units((&i, &j));
            for (sum, own) in units[(joint - 1) * 3..].iter_mut().zip(own) {
                for (sum, x) in sum.iter_mut().zip(own) {
                    *sum += x;
                }
            }
        }
    }

    /// Adds the forces of the two end joints on cylinders in the plane; stores the joints' loads in `state`.
    pub(super) fn add_plane_ends(
        &self,
        joints: &Joints<'_>,
        state: &mut ChainState,
        force: &mut [f64],
    ) {
        let force = &mut force[self.range()];
        for joint in [0, self.count] {
            let Some(([i, j], law)) = self.link(joint, joints, state) else {
                continue;
            };
            let load = law.load(&i, &j);
            let (at, sign, torque) = if joint == 0 {
                (0, 1.0, load.torque_i.z)
            } else {
                ((joint - 1) * 3, -1.0, load.torque_j.z)
            };
            force[at] += sign * load.force.x;
            force[at + 1] += sign * load.force.y;
            force[at + 2] += torque;
            state.joints[joint] = load;
        }
    }

    /// Subtracts the tangent of the joints between cylinders from the matrix.
    pub(super) fn add_plane_tangent(
        &self,
        joints: &Joints<'_>,
        state: &ChainState,
        gamma: f64,
        matrix: &mut Blocks<3>,
    ) {
        for joint in 1..self.count {
            let [i, j] = self.plane_markers(joint, &state.plane);
            let force = state.joints[joint].force.xy();
            let further = self.pull(joint, joints, state);
            let tangent = joints
                .inner
                .plane_tangent((&i, &j), &force, gamma, further.as_ref());
            subtract_joint(matrix, self.first + joint, &tangent);
        }
    }

    /// Subtracts the tangent of the joints between cylinders: without its rate-dependent part from the first
    /// matrix, complete from the second.
    pub(super) fn add_plane_stiffness_and_tangent(
        &self,
        joints: &Joints<'_>,
        state: &ChainState,
        gamma: f64,
        [stiffness, matrix]: [&mut Blocks<3>; 2],
    ) {
        for joint in 1..self.count {
            let [i, j] = self.plane_markers(joint, &state.plane);
            let force = state.joints[joint].force.xy();
            let further = self.pull(joint, joints, state);
            let (between, law) = ((&i, &j), joints.inner);
            let [alone, whole] = law.plane_tangents(between, &force, gamma, further.as_ref());
            subtract_joint(stiffness, self.first + joint, &alone);
            subtract_joint(matrix, self.first + joint, &whole);
        }
    }
}

/// Subtracts the tangent of the joint between `block` (I) and the block before it (J) from the matrix.
#[inline]
fn subtract_joint(matrix: &mut Blocks<3>, block: usize, [by_i, by_j]: &[[PlaneColumn; 3]; 2]) {
    subtract(matrix.diagonal_mut(block - 1), by_j, Side::J);
    let (upper, lower) = matrix.coupling_mut(block - 1);
    subtract(upper, by_i, Side::J);
    subtract(lower, by_j, Side::I);
    subtract(matrix.diagonal_mut(block), by_i, Side::I);
}

/// Subtracts a joint's derivatives from a block, in the rows of the cylinder on one side of the joint.
#[inline]
fn subtract(block: &mut MatrixBlock<3>, columns: &[PlaneColumn; 3], side: Side) {
    for (k, column) in columns.iter().enumerate() {
        let (sign, torque) = match side {
            Side::I => (1.0, column.torque_i),
            Side::J => (-1.0, column.torque_j),
        };
        block[(0, k)] -= sign * column.force.x;
        block[(1, k)] -= sign * column.force.y;
        block[(2, k)] -= torque;
    }
}
