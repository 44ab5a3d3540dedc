//! Tangent of a chain's joints.
//!
//! Interior joints couple two neighbouring blocks. An end joint couples the cylinder with whatever
//! holds it: the cylinder's own block is filled here, the rest is handed to the holder.
use super::{Chain, ChainState, Joints};
use crate::element::bushing::LinkTangent;
use crate::linear::{Block, Bordered};
use crate::model::pose::Pose;
use nalgebra::{Matrix3, Vector3};

type V3 = Vector3<f64>;
type M3 = Matrix3<f64>;

/// Derivatives of force, torque on I and torque on J by one generalised coordinate.
pub(crate) type Column = [V3; 3];

/// The same by the position and the angles of a cylinder.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CylinderColumns {
    position: [M3; 3],
    angles: [M3; 3],
}

/// Tangent of an end joint, for the body that holds the chain there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EndTangent {
    /// By the motion of the holding body.
    pub(crate) by_body: LinkTangent,
    /// By the coordinates of the cylinder.
    pub(crate) by_cylinder: CylinderColumns,
}

/// Which body of a joint a block's rows belong to.
#[derive(Clone, Copy)]
enum Side {
    I,
    J,
}

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Chain {
    /// Adds the joints' tangent of the cylinders' own blocks and couplings; returns those of the
    /// end joints at base and head for their holders.
    pub(crate) fn add_joint_tangent(
        &self,
        joints: &Joints<'_>,
        state: &ChainState,
        gamma: f64,
        matrix: &mut Bordered,
    ) -> [Option<EndTangent>; 2] {
        let poses = &state.poses;
        let mut ends = [None; 2];
        for (j, pose) in poses.iter().enumerate() {
            // the torques of both joints of this cylinder turn with its angles
            let torque = state.joints[j].torque_i + state.joints[j + 1].torque_j;
            let turning = pose.torque_by_angles(&torque);
            let mut view = matrix
                .diagonal_mut(self.first + j)
                .fixed_view_mut::<3, 3>(3, 3);
            view -= turning;
        }
        for joint in 0..=self.count {
            let Some(([i, j], law)) = self.link(joint, joints, poses) else {
                continue;
            };
            let further = self
                .along(joint, joints, state, (&i, &j))
                .map(|along| [along.spring + along.other, along.by_place, along.by_rate]);
            let [by_i, by_j] = law.tangent_with(&i, &j, &state.joints[joint], further);
            let before = (joint > 0).then(|| &poses[joint - 1]);
            let behind = poses.get(joint);
            let columns_j = before.map(|pose| CylinderColumns::new(&by_j, pose, gamma));
            let columns_i = behind.map(|pose| CylinderColumns::new(&by_i, pose, gamma));
            let block = self.first + joint;
            if let (Some(columns), Some(pose)) = (&columns_j, before) {
                let own = matrix.diagonal_mut(block - 1);
                subtract_own(own, columns, &pose.angular(), Side::J);
            }
            if let (Some(columns_i), Some(i), Some(columns_j), Some(j)) =
                (&columns_i, behind, &columns_j, before)
            {
                let (upper, lower) = matrix.coupling_mut(block - 1);
                subtract_own(upper, columns_i, &j.angular(), Side::J);
                subtract_own(lower, columns_j, &i.angular(), Side::I);
            }
            if let (Some(columns), Some(pose)) = (&columns_i, behind) {
                subtract_own(
                    matrix.diagonal_mut(block),
                    columns,
                    &pose.angular(),
                    Side::I,
                );
            }
            match (columns_i, columns_j) {
                (Some(by_cylinder), None) => {
                    ends[0] = Some(EndTangent {
                        by_body: by_j,
                        by_cylinder,
                    });
                }
                (None, Some(by_cylinder)) => {
                    ends[1] = Some(EndTangent {
                        by_body: by_i,
                        by_cylinder,
                    });
                }
                (Some(_), Some(_)) | (None, None) => {}
            }
        }
        ends
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

    /// Derivatives by coordinate `k` of the cylinder.
    pub(crate) fn column(&self, k: usize) -> Column {
        let of = if k < 3 { &self.position } else { &self.angles };
        std::array::from_fn(|row| of[row].column(k % 3).into_owned())
    }
}

/// Subtracts the rows of one side's cylinder: force and generalised torque.
fn subtract_own(block: &mut Block, columns: &CylinderColumns, angular: &M3, side: Side) {
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
