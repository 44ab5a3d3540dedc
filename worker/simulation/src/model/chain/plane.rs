//! Joints between the cylinders of a chain in the plane: forces, and stiffness and damping by the coordinates.
//!
//! The law is that of the bushing, to which the axial laws of effects add a tension. Without such laws the
//! joints are evaluated side by side in SIMD lanes, otherwise one after the other; both have the same bits.
//! The two end joints use the bushing in space.
use super::axial::pull_at;
use super::parts::{Chain, Joints};
use super::state::{ChainState, PlaneLoads};
use crate::element::bushing::{Bushing, PLANE_COEFFICIENTS};
use crate::element::law::{ForceLaw, LawResponse};
use crate::element::plane::{INDEPENDENT, PlaneJoint, PlaneTangent, Side};
use crate::linear::{Blocks, MatrixBlock};
use crate::math::real::{Vector, WIDEST};
use crate::model::pose::PlanePoses;
use pulp::{Arch, Simd, WithSimd};
use std::ops::Range;

/// Evaluation of all joints between the cylinders of a chain, compiled for each set of instructions.
struct Evaluate<'a> {
    law: &'a Bushing,
    half: f64,
    poses: &'a PlanePoses,
    loads: &'a mut PlaneLoads,
}

impl WithSimd for Evaluate<'_> {
    type Output = ();

    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self {
            law,
            half,
            poses,
            loads,
        } = self;
        let vectors = loads.count.div_ceil(S::F64_LANES);
        let [before, behind] = [0, 1].map(|first| poses.rods(simd, first, vectors));
        let [x, y] = &mut loads.force;
        let [torque_i, torque_j] = &mut loads.torque;
        let out = [
            x,
            y,
            torque_i,
            torque_j,
            &mut loads.tension,
            &mut loads.dissipated,
        ];
        let [x, y, torque_i, torque_j, tension, dissipated] =
            out.map(|array| &mut S::as_mut_simd_f64s(array).0[..vectors]);
        for k in 0..vectors {
            let joint = PlaneJoint::new(half, &behind.get(k), &before.get(k));
            let answer: LawResponse<Vector<S>, 3> = law.response(joint.deformation, joint.rate);
            let load = joint.load(answer.force);
            x[k] = load.force[0].lanes();
            y[k] = load.force[1].lanes();
            torque_i[k] = load.torque[0].lanes();
            torque_j[k] = load.torque[1].lanes();
            tension[k] = answer.force[0].lanes();
            dissipated[k] = answer.dissipated.lanes();
        }
    }
}

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Chain {
    /// Returns the joint between two cylinders in the plane, and the answer of its law together with the axial
    /// laws of effects.
    #[inline]
    pub(super) fn plane_joint(
        &self,
        joint: usize,
        joints: &Joints<'_>,
        state: &ChainState,
    ) -> (PlaneJoint<f64>, LawResponse<f64, 3>) {
        let at = self.plane_geometry(joint, state);
        let mut answer = joints.inner.response(at.deformation, at.rate);
        let stretched = [at.deformation[0], at.rate[0]];
        if let Some(further) = pull_at(joint, joints, state, stretched) {
            answer.force[0] += further.force;
            answer.stiffness[0][0] += further.by_extension;
            answer.damping[0][0] += further.by_rate;
            answer.dissipated += further.dissipated;
        }
        (at, answer)
    }

    /// Returns the joint between two cylinders in the plane.
    #[inline]
    pub(super) fn plane_geometry(&self, joint: usize, state: &ChainState) -> PlaneJoint<f64> {
        let [i, j] = [state.plane.rod(joint), state.plane.rod(joint - 1)];
        PlaneJoint::new(0.5 * self.pitch, &i, &j)
    }

    /// Adds the forces of all joints on cylinders in the plane to the generalised forces; stores the joints'
    /// loads in `state`.
    pub(super) fn add_plane_joints(
        &self,
        joints: &Joints<'_>,
        state: &mut ChainState,
        force: &mut [f64],
    ) {
        self.add_plane_ends(joints, state, force);
        if joints.axial.is_some() {
            for joint in 1..self.count {
                let (at, answer) = self.plane_joint(joint, joints, state);
                let load = at.load(answer.force);
                let loads = &mut state.plane_joints;
                for k in 0..2 {
                    loads.force[k][joint - 1] = load.force[k];
                    loads.torque[k][joint - 1] = load.torque[k];
                }
                loads.tension[joint - 1] = answer.force[0];
                loads.dissipated[joint - 1] = answer.dissipated;
            }
        } else {
            Arch::new().dispatch(Evaluate {
                law: joints.inner,
                half: 0.5 * self.pitch,
                poses: &state.plane,
                loads: &mut state.plane_joints,
            });
        }
        let loads = &state.plane_joints;
        let n = loads.count;
        let [x, y] = loads.force.each_ref().map(|array| &array[..n]);
        let [torque_i, torque_j] = loads.torque.each_ref().map(|array| &array[..n]);
        let (cylinders, _) = force[self.range()].as_chunks_mut::<3>();
        let cylinders = &mut cylinders[..=n];
        // of the cylinder between two joints, in registers: what was stored a moment ago is slow to read
        let mut carried = cylinders[0];
        for k in 0..n {
            let next = cylinders[k + 1];
            cylinders[k] = [
                carried[0] - x[k],
                carried[1] - y[k],
                carried[2] + torque_j[k],
            ];
            carried = [next[0] + x[k], next[1] + y[k], next[2] + torque_i[k]];
        }
        cylinders[n] = carried;
    }

    /// Adds, per coordinate, the forces of the joints between cylinders per unit of each joint coefficient, in
    /// the order of the law; does nothing for a chain in space.
    pub(crate) fn add_plane_units(
        &self,
        law: &Bushing,
        state: &ChainState,
        units: &mut [[f64; PLANE_COEFFICIENTS]],
    ) {
        let Some(units) = units.get_mut(self.range()) else {
            return;
        };
        for joint in 1..self.count.min(state.plane.len()) {
            let at = self.plane_geometry(joint, state);
            let forces = law.by_coefficients(at.deformation, at.rate);
            for (k, force) in forces.into_iter().enumerate() {
                let own = at.load(force).on_coordinates();
                for (sum, own) in units[(joint - 1) * 3..].iter_mut().zip(own) {
                    sum[k] += own;
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

    /// Adds `K + gamma D` of the joints between cylinders to the last matrix and, if there are two, `K` alone
    /// to the first.
    pub(super) fn add_plane_tangent(
        &self,
        joints: &Joints<'_>,
        state: &ChainState,
        gamma: f64,
        (mut alone, matrix): (Option<&mut Blocks<3>>, &mut Blocks<3>),
    ) {
        if joints.axial.is_none() {
            Arch::new().dispatch(AddTangent {
                law: joints.inner,
                half: 0.5 * self.pitch,
                poses: &state.plane,
                joints: self.first + 1..self.first + self.count,
                gamma,
                matrices: (alone, matrix),
            });
            return;
        }
        for joint in 1..self.count {
            let (at, answer) = self.plane_joint(joint, joints, state);
            let [stiffness, damping] = at.tangents(&answer);
            if let Some(alone) = &mut alone {
                add_joint(alone, self.first + joint, &stiffness);
            }
            add_joint(matrix, self.first + joint, &stiffness.plus(gamma, &damping));
        }
    }
}

/// Assembly of the tangent of all joints between the cylinders of a chain, compiled for each set of
/// instructions.
struct AddTangent<'a, 'm> {
    law: &'a Bushing,
    half: f64,
    poses: &'a PlanePoses,
    /// Matrix blocks of the cylinders behind the joints.
    joints: Range<usize>,
    gamma: f64,
    matrices: (Option<&'m mut Blocks<3>>, &'m mut Blocks<3>),
}

impl WithSimd for AddTangent<'_, '_> {
    type Output = ();

    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let (mut alone, matrix) = self.matrices;
        let vectors = self.joints.len().div_ceil(S::F64_LANES);
        let [before, behind] = [0, 1].map(|first| self.poses.rods(simd, first, vectors));
        for k in 0..vectors {
            let joint = PlaneJoint::new(self.half, &behind.get(k), &before.get(k));
            let answer: LawResponse<Vector<S>, 3> =
                self.law.response(joint.deformation, joint.rate);
            let [stiffness, damping] = joint.tangents(&answer);
            let blocks = self
                .joints
                .clone()
                .skip(k * S::F64_LANES)
                .take(S::F64_LANES);
            if let Some(alone) = &mut alone {
                add_joints(alone, blocks.clone(), &stiffness);
            }
            add_joints(matrix, blocks, &stiffness.plus(self.gamma, &damping));
        }
    }
}

/// Adds the tangents of joints in SIMD lanes to the matrix, each as [`add_joint`] does.
#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
#[inline(always)]
fn add_joints<S: Simd>(
    matrix: &mut Blocks<3>,
    blocks: impl Iterator<Item = usize>,
    tangent: &PlaneTangent<Vector<S>>,
) {
    let mut entries = [[[0.0; WIDEST]; INDEPENDENT]; INDEPENDENT];
    for (to, from) in entries
        .as_flattened_mut()
        .iter_mut()
        .zip(tangent.0.as_flattened())
    {
        S::as_mut_simd_f64s(to).0[0] = from.lanes();
    }
    for (lane, block) in blocks.enumerate() {
        let one = entries.map(|row| row.map(|entry| entry[lane]));
        add_joint(matrix, block, &PlaneTangent(one));
    }
}

/// Adds the tangent of the joint between `block` (I) and the block before it (J) to the matrix.
#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
#[inline(always)]
fn add_joint(matrix: &mut Blocks<3>, block: usize, tangent: &PlaneTangent<f64>) {
    add(matrix.diagonal_mut(block - 1), tangent, [Side::J, Side::J]);
    let (upper, lower) = matrix.coupling_mut(block - 1);
    add(upper, tangent, [Side::J, Side::I]);
    add(lower, tangent, [Side::I, Side::J]);
    add(matrix.diagonal_mut(block), tangent, [Side::I, Side::I]);
}

/// Adds the part of a joint's tangent in the rows and the columns of two cylinders to a block.
#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
#[inline(always)]
fn add(block: &mut MatrixBlock<3>, tangent: &PlaneTangent<f64>, [of, by]: [Side; 2]) {
    for column in 0..3 {
        for row in 0..3 {
            block[(row, column)] += tangent.entry((of, row), (by, column));
        }
    }
}
