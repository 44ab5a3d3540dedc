//! Joints between the cylinders of a chain in the plane: forces, and stiffness and damping by the coordinates.
//!
//! The joints are evaluated side by side in SIMD lanes. Their law is that of the bushing, to which the axial laws of
//! effects, evaluated lane by lane, add a tension. The two end joints use the bushing in space.
use super::axial::AxialEffects;
use super::parts::{Chain, Joints};
use super::state::{ChainState, PlaneLoads};
use crate::element::bushing::{Bushing, LinkLoad};
use crate::element::law::{ForceLaw, LawResponse};
use crate::element::plane::{INDEPENDENT, PlaneJoint, PlaneTangent, Side};
use crate::linear::{Blocks, MatrixBlock};
use crate::math::real::Vector;
use crate::model::pose::PlanePoses;
use pulp::{Arch, Simd, WithSimd};
use std::ops::Range;

/// Evaluation of all joints between the cylinders of a chain, compiled for each set of instructions.
struct Evaluate<'a> {
    law: &'a Bushing,
    axial: Option<AxialEffects<'a>>,
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
            axial,
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
            let mut answer: LawResponse<Vector<S>, 3> = law.response(joint.deformation, joint.rate);
            if let Some(axial) = &axial {
                // joint 0 holds the chain's base
                let among = [1 + k * S::F64_LANES, loads.count];
                axial.add_to(simd, among, &joint, &mut answer);
            }
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
    /// Returns the joint between two cylinders in the plane.
    #[inline]
    pub(super) fn plane_joint(&self, joint: usize, state: &ChainState) -> PlaneJoint<f64> {
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
        Arch::new().dispatch(Evaluate {
            law: joints.inner,
            axial: AxialEffects::new(joints, &state.memory),
            half: 0.5 * self.pitch,
            poses: &state.plane,
            loads: &mut state.plane_joints,
        });
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

    /// Adds the forces of the two end joints on cylinders in the plane; stores the joints' loads in `state`.
    pub(super) fn add_plane_ends(
        &self,
        joints: &Joints<'_>,
        state: &mut ChainState,
        force: &mut [f64],
    ) {
        for (end, joint) in [0, self.count].into_iter().enumerate() {
            let Some(([i, j], law)) = self.link(joint, joints, state) else {
                continue;
            };
            let load = law.load(&i, &j);
            self.add_plane_end(end, &load, |at, value| force[at] += value);
            state.joints[joint] = load;
        }
    }

    /// Adds the generalised forces of the joint at the base (0) or at the head (1) on its cylinder, in the
    /// plane.
    pub(crate) fn add_plane_end(
        &self,
        end: usize,
        load: &LinkLoad,
        mut add: impl FnMut(usize, f64),
    ) {
        let (cylinder, sign, torque) = if end == 0 {
            (0, 1.0, load.torque_i.z)
        } else {
            (self.count - 1, -1.0, load.torque_j.z)
        };
        let at = self.cylinder(cylinder).start;
        add(at, sign * load.force.x);
        add(at + 1, sign * load.force.y);
        add(at + 2, torque);
    }

    /// Adds `K + gamma D` of the joints between cylinders to the last matrix and, if there are two, `K` alone
    /// to the first.
    pub(super) fn add_plane_tangent(
        &self,
        joints: &Joints<'_>,
        state: &ChainState,
        gamma: f64,
        (alone, matrix): (Option<&mut Blocks<3>>, &mut Blocks<3>),
    ) {
        Arch::new().dispatch(AddTangent {
            law: joints.inner,
            axial: AxialEffects::new(joints, &state.memory),
            half: 0.5 * self.pitch,
            poses: &state.plane,
            joints: self.first + 1..self.first + self.count,
            gamma,
            matrices: (alone, matrix),
        });
    }
}

/// Assembly of the tangent of all joints between the cylinders of a chain, compiled for each set of
/// instructions.
struct AddTangent<'a, 'm> {
    law: &'a Bushing,
    axial: Option<AxialEffects<'a>>,
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
        let joints = self.joints;
        let vectors = joints.len().div_ceil(S::F64_LANES);
        let [before, behind] = [0, 1].map(|first| self.poses.rods(simd, first, vectors));
        let mut carried = [Carried::default(); 2];
        for k in 0..vectors {
            let joint = PlaneJoint::new(self.half, &behind.get(k), &before.get(k));
            let mut answer: LawResponse<Vector<S>, 3> =
                self.law.response(joint.deformation, joint.rate);
            if let Some(axial) = &self.axial {
                let among = [1 + k * S::F64_LANES, joints.len()];
                axial.add_to(simd, among, &joint, &mut answer);
            }
            let [stiffness, damping] = joint.tangents(&answer);
            let first = joints.start + k * S::F64_LANES;
            let blocks = first..joints.end.min(first + S::F64_LANES);
            if let Some(alone) = &mut alone {
                carried[0].set_joints(alone, blocks.clone(), &stiffness);
            }
            carried[1].set_joints(matrix, blocks, &stiffness.plus(self.gamma, &damping));
        }
        for (carried, matrix) in carried.iter().zip([alone, Some(matrix)]) {
            if let Some(matrix) = matrix {
                *matrix.diagonal_mut(joints.end - 1) += carried.0;
            }
        }
    }
}

/// Tangent of the last joint in the rows and columns of the cylinder behind it, whose diagonal block the next
/// joint completes: kept in registers.
#[derive(Clone, Copy, Default)]
struct Carried(MatrixBlock<3>);

#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
impl Carried {
    /// Sets the couplings of joints in SIMD lanes, and adds to the diagonal blocks, each as
    /// [`Self::set_joint`] does.
    #[inline(always)]
    fn set_joints<S: Simd>(
        &mut self,
        matrix: &mut Blocks<3>,
        blocks: Range<usize>,
        tangent: &PlaneTangent<Vector<S>>,
    ) {
        let entries = tangent.0.map(|row| row.map(Vector::to_array));
        for (lane, block) in blocks.enumerate() {
            let mut one = [[0.0; INDEPENDENT]; INDEPENDENT];
            for (to, from) in one
                .as_flattened_mut()
                .iter_mut()
                .zip(entries.as_flattened())
            {
                *to = from[lane];
            }
            self.set_joint(matrix, block, &PlaneTangent(one));
        }
    }

    /// Sets the couplings of the joint between `block` (I) and the block before it (J), and completes the
    /// diagonal block of J.
    #[inline(always)]
    fn set_joint(&mut self, matrix: &mut Blocks<3>, block: usize, tangent: &PlaneTangent<f64>) {
        *matrix.diagonal_mut(block - 1) += self.0 + part(tangent, [Side::J, Side::J]);
        let (upper, lower) = matrix.coupling_mut(block - 1);
        *upper = part(tangent, [Side::J, Side::I]);
        *lower = part(tangent, [Side::I, Side::J]);
        self.0 = part(tangent, [Side::I, Side::I]);
    }
}

/// Returns the part of a joint's tangent in the rows and the columns of two cylinders.
#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
#[inline(always)]
fn part(tangent: &PlaneTangent<f64>, [of, by]: [Side; 2]) -> MatrixBlock<3> {
    let mut block = MatrixBlock::zeros();
    for column in 0..3 {
        for row in 0..3 {
            block[(row, column)] = tangent.entry((of, row), (by, column));
        }
    }
    block
}
