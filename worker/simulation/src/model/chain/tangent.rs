//! Tangent of a chain's joints.
//!
//! A joint between two cylinders couples their two matrix blocks. An end joint couples a cylinder with the
//! body that holds the end: the derivatives within the cylinder's own block are added here, the remaining
//! ones are returned for the holding body.
use super::parts::{Chain, Joints};
use super::state::ChainState;
use crate::element::bushing::LinkTangent;
use crate::element::plane::Side;
use crate::linear::{BLOCK, Blocks, Bordered, MatrixBlock};
use crate::model::pose::Pose;
use nalgebra::{Matrix3, Vector3};

type V3 = Vector3<f64>;
type M3 = Matrix3<f64>;

/// Derivatives of a joint's force, torque on body I and torque on body J with respect to one generalised
/// coordinate.
pub(crate) type Column = [V3; 3];

/// Derivatives of a joint's force and torques with respect to the position and the angles of a cylinder.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CylinderColumns {
    position: [M3; 3],
    angles: [M3; 3],
}

/// Derivatives of an end joint's load with respect to displacement, velocity, rotation and angular velocity
/// of its cylinder and of the body that holds the end, each taken as independent.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EndJointTangent {
    side: Side,
    /// Index of the matrix block of the cylinder; the field `pose` holds the cylinder's pose.
    block: usize,
    pose: Pose,
    by_own: LinkTangent,
    by_body: LinkTangent,
}

/// Derivatives of an end joint's load that enter the equations of the body that holds the end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EndTangent {
    /// Derivatives of the load with respect to the motion of the holding body.
    pub(crate) by_body: LinkTangent,
    /// Derivatives with respect to the coordinates of the cylinder.
    pub(crate) by_cylinder: CylinderColumns,
}

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Chain {
    /// Adds `K + gamma D` of the joints between two cylinders to the second matrix and, if there is one, `K`
    /// alone to the first.
    pub(crate) fn add_joint_tangent(
        &self,
        joints: &Joints<'_>,
        state: &ChainState,
        gamma: f64,
        (stiffness, matrix): (Option<&mut Bordered>, &mut Bordered),
    ) {
        match (stiffness, matrix) {
            (Some(Bordered::Plane(stiffness)), Bordered::Plane(matrix)) => {
                self.add_plane_tangent(joints, state, gamma, (Some(stiffness), matrix));
            }
            (_, Bordered::Plane(matrix)) => {
                self.add_plane_tangent(joints, state, gamma, (None, matrix));
            }
            (stiffness, Bordered::Space(matrix)) => {
                if let Some(Bordered::Space(stiffness)) = stiffness {
                    self.add_space_tangent(joints, state, 0.0, stiffness);
                }
                self.add_space_tangent(joints, state, gamma, matrix);
            }
        }
    }

    /// Adds the tangent of the joints between two cylinders in space to the matrix.
    fn add_space_tangent(
        &self,
        joints: &Joints<'_>,
        state: &ChainState,
        gamma: f64,
        matrix: &mut Blocks<BLOCK>,
    ) {
        self.add_torque_geometric_stiffness(state, matrix);
        for joint in 1..self.count {
            self.add_inner_tangent(joint, joints, state, gamma, matrix);
        }
    }

    /// Returns the derivatives of the loads of the two end joints, at base and head; `None` for a free end.
    pub(crate) fn ends(
        &self,
        joints: &Joints<'_>,
        state: &ChainState,
    ) -> [Option<EndJointTangent>; 2] {
        [(0, 0, Side::I), (self.count, self.count - 1, Side::J)].map(|(joint, cylinder, side)| {
            let ([i, j], law) = self.link(joint, joints, state)?;
            let [by_i, by_j] = law.tangent(&i, &j, &state.joints[joint]);
            let (by_own, by_body) = match side {
                Side::I => (by_i, by_j),
                Side::J => (by_j, by_i),
            };
            Some(EndJointTangent {
                side,
                block: self.first + cylinder,
                pose: state.pose(cylinder),
                by_own,
                by_body,
            })
        })
    }

    /// Adds the tangent of the end joints to the matrix blocks of the cylinders there; returns the
    /// derivatives that the holding bodies need.
    pub(crate) fn add_end_tangent(
        &self,
        ends: &[Option<EndJointTangent>; 2],
        gamma: f64,
        matrix: &mut Bordered,
    ) -> [Option<EndTangent>; 2] {
        ends.each_ref().map(|end| {
            let end = end.as_ref()?;
            let by_cylinder = CylinderColumns::new(&end.by_own, &end.pose, gamma);
            let mut own = MatrixBlock::zeros();
            subtract_own(&mut own, &by_cylinder, &end.pose.angular(), end.side);
            let kept = self.motion.kept();
            for (c, &column) in kept.iter().enumerate() {
                for (r, &row) in kept.iter().enumerate() {
                    matrix.add_diagonal(end.block, r, c, own[(row, column)]);
                }
            }
            Some(EndTangent {
                by_body: end.by_body,
                by_cylinder,
            })
        })
    }

    /// Adds the tangent that arises because a joint torque's components along a cylinder's angle coordinates
    /// change with the angles.
    fn add_torque_geometric_stiffness(&self, state: &ChainState, matrix: &mut Blocks<BLOCK>) {
        for (j, pose) in state.poses.iter().enumerate() {
            let torque = state.joints[j].torque_i + state.joints[j + 1].torque_j;
            let turning = pose.torque_by_angles(&torque);
            let mut view = matrix
                .diagonal_mut(self.first + j)
                .fixed_view_mut::<3, 3>(3, 3);
            view -= turning;
        }
    }

    /// Adds the tangent of a joint between two cylinders in space.
    fn add_inner_tangent(
        &self,
        joint: usize,
        joints: &Joints<'_>,
        state: &ChainState,
        gamma: f64,
        matrix: &mut Blocks<BLOCK>,
    ) {
        let Some(([i, j], law)) = self.link(joint, joints, state) else {
            return;
        };
        let further = self.pull(joint, joints, state);
        let [by_i, by_j] = law.tangent_with(&i, &j, &state.joints[joint], further.as_ref());
        let (pose_i, pose_j) = (&state.poses[joint], &state.poses[joint - 1]);
        let columns_i = CylinderColumns::new(&by_i, pose_i, gamma);
        let columns_j = CylinderColumns::new(&by_j, pose_j, gamma);
        let (angular_i, angular_j) = (pose_i.angular(), pose_j.angular());
        let block = self.first + joint;
        let own = matrix.diagonal_mut(block - 1);
        subtract_own(own, &columns_j, &angular_j, Side::J);
        let (upper, lower) = matrix.coupling_mut(block - 1);
        subtract_own(upper, &columns_i, &angular_j, Side::J);
        subtract_own(lower, &columns_j, &angular_i, Side::I);
        let own = matrix.diagonal_mut(block);
        subtract_own(own, &columns_i, &angular_i, Side::I);
    }
}

impl CylinderColumns {
    fn new(by: &LinkTangent, pose: &Pose, gamma: f64) -> Self {
        let angular = pose.angular();
        let spin = angular * gamma + pose.angular_rate();
        Self {
            position: std::array::from_fn(|r| by.p[r] + by.v[r] * gamma),
            angles: std::array::from_fn(|r| by.a[r] * angular + by.w[r] * spin),
        }
    }

    /// Returns the derivatives of the joint's load with respect to coordinate `k` of the cylinder.
    pub(crate) fn column(&self, k: usize) -> Column {
        let of = if k < 3 { &self.position } else { &self.angles };
        std::array::from_fn(|row| of[row].column(k % 3).into_owned())
    }
}

/// Subtracts the derivatives of a joint's load from a matrix block, in the rows (force, generalised torque)
/// of the cylinder on one side of the joint.
fn subtract_own(block: &mut MatrixBlock, columns: &CylinderColumns, angular: &M3, side: Side) {
    let (sign, torque) = match side {
        Side::I => (1.0, 1),
        Side::J => (-1.0, 2),
    };
    for (first, part) in [(0, &columns.position), (3, &columns.angles)] {
        let turned = angular.tr_mul(&part[torque]);
        for c in 0..3 {
            for r in 0..3 {
                block[(r, first + c)] -= sign * part[0][(r, c)];
                block[(3 + r, first + c)] -= turned[(r, c)];
            }
        }
    }
}
