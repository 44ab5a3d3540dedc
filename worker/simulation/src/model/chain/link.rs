//! Markers (frames on the connected bodies) of a chain's joints.
use super::parts::{Chain, EndJoint, Joints};
use super::state::ChainState;
use crate::element::bushing::{Bushing, LinkLoad, Marker};
use crate::math::elementary::sin_cos;
use crate::model::layout::Motion;
use crate::model::pose::{PlanePose, Pose};
use nalgebra::{Matrix3, Vector2};

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Chain {
    /// Returns whether a joint lies between two cylinders that move in the plane.
    pub(super) const fn in_plane(&self, joint: usize) -> bool {
        matches!(self.motion, Motion::Plane) && joint > 0 && joint < self.count
    }

    /// Computes the load of the joint at the chain's head end for the given coordinates and rates,
    /// independent of the poses stored in a `ChainState`; `None` if that end is free.
    pub(crate) fn head_load(&self, joints: &Joints<'_>, q: &[f64], v: &[f64]) -> Option<LinkLoad> {
        let held = joints.head?;
        let pose = self.pose_at(self.count - 1, q, v);
        let [i, j] = held.with_law_axes(&[held.marker, on_cylinder(&pose, 0.5 * self.pitch)]);
        Some(held.law.load(&i, &j))
    }

    /// Computes the load of the joint at the chain's base end for the given coordinates and rates; `None` if
    /// that end is free.
    pub(crate) fn base_load(&self, joints: &Joints<'_>, q: &[f64], v: &[f64]) -> Option<LinkLoad> {
        let held = joints.base?;
        let pose = self.pose_at(0, q, v);
        let [i, j] = held.with_law_axes(&[on_cylinder(&pose, -0.5 * self.pitch), held.marker]);
        Some(held.law.load(&i, &j))
    }

    /// Returns the index range of a cylinder's coordinates in a vector of unknowns.
    pub(crate) fn cylinder(&self, at: usize) -> std::ops::Range<usize> {
        let (first, width) = (self.range().start, self.motion.width());
        first + at * width..first + (at + 1) * width
    }

    fn pose_at(&self, cylinder: usize, q: &[f64], v: &[f64]) -> Pose {
        let range = self.cylinder(cylinder);
        let (q, v) = (&q[range.clone()], &v[range]);
        match self.motion {
            Motion::Plane => {
                let (s, c) = sin_cos(q[2]);
                PlanePose::new(q, v, Vector2::new(c, s)).in_space()
            }
            Motion::Space => Pose::new(q, v),
        }
    }

    /// Returns the markers I and J of a joint and its force law; `None` for a free end. Joints between
    /// cylinders in the plane have the geometry of `plane_joint` instead.
    pub(super) fn link<'a>(
        &self,
        joint: usize,
        joints: &Joints<'a>,
        state: &ChainState,
    ) -> Option<([Marker; 2], &'a Bushing)> {
        let half = 0.5 * self.pitch;
        if joint == 0 {
            let held = joints.base?;
            let markers = [on_cylinder(&state.pose(0), -half), held.marker];
            return Some((held.with_law_axes(&markers), held.law));
        }
        if joint == self.count {
            let held = joints.head?;
            let j = on_cylinder(&state.pose(joint - 1), half);
            return Some((held.with_law_axes(&[held.marker, j]), held.law));
        }
        let j = on_cylinder(&state.poses[joint - 1], half);
        Some(([on_cylinder(&state.poses[joint], -half), j], joints.inner))
    }
}

impl EndJoint<'_> {
    /// Returns the markers of an end joint; for a pinned joint their axes are permuted such that the law's
    /// axis is the z axis of the body that holds the end.
    fn with_law_axes(&self, markers: &[Marker; 2]) -> [Marker; 2] {
        if !self.pinned {
            return *markers;
        }
        markers.map(|marker| {
            let [x, y, z] = [0, 1, 2].map(|k| marker.R.column(k).into_owned());
            Marker {
                R: Matrix3::from_columns(&[z, x, y]),
                ..marker
            }
        })
    }
}

fn on_cylinder(pose: &Pose, along: f64) -> Marker {
    Marker {
        p: pose.p,
        rho: pose.axis() * along,
        v: pose.v,
        w: pose.w,
        R: pose.R,
    }
}
