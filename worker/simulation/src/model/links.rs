//! The joints of both rope chains: which markers they join.
//!
//! Joint 0 holds the first cylinder to the rod or the suspension point (revolute), joints 1..n-1
//! join cylinders, joint n holds the last cylinder to the head. J is the marker nearer to the free
//! end, I the one nearer to the head.
use crate::drive::DriveState;
use crate::element::bushing::{Bushing, LinkLoad, Marker};
use crate::math::elementary::sin_cos;
use crate::model::description::Arc;
use crate::model::{Machine, Ropes, layout::Layout, pose::Pose};
use nalgebra::{Matrix3, Vector3};

type V3 = Vector3<f64>;
type M3 = Matrix3<f64>;

/// Loads of every joint of both chains and contact forces of every cylinder.
#[derive(Clone, Debug)]
pub struct ChainLoads {
    /// Joint loads, chain by chain, from the free end on.
    pub joints: [Vec<LinkLoad>; 2],
    /// Contact force of each cylinder, chain by chain \[N\].
    pub contact: [Vec<f64>; 2],
    /// Deepest penetration \[m\].
    pub deepest: f64,
}

impl ChainLoads {
    pub(crate) fn new(layout: &Layout) -> Self {
        let none = LinkLoad {
            force: V3::zeros(),
            torque_i: V3::zeros(),
            torque_j: V3::zeros(),
            axial: 0.0,
            dissipated: 0.0,
        };
        Self {
            joints: [vec![none; layout.back + 1], vec![none; layout.front + 1]],
            contact: [vec![0.0; layout.back], vec![0.0; layout.front]],
            deepest: 0.0,
        }
    }

    /// Tension in a joint, positive where it pulls \[N\].
    pub fn tension(&self, chain: usize, joint: usize) -> f64 {
        -self.joints[chain][joint].axial
    }
}

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Machine {
    /// Number of cylinders of a chain.
    pub(crate) const fn cylinders(&self, chain: usize) -> usize {
        if chain == 0 {
            self.layout.back
        } else {
            self.layout.front
        }
    }

    /// Poses of a chain among all poses.
    pub(crate) fn chain_poses<'p>(&self, chain: usize, poses: &'p [Pose]) -> &'p [Pose] {
        let (back, front) = poses.split_at(self.layout.back);
        if chain == 0 { back } else { front }
    }

    /// The arc that a chain wraps.
    pub(crate) const fn arc(&self, chain: usize) -> &Arc {
        if chain == 0 {
            &self.description.back_arc
        } else {
            &self.description.front_arc
        }
    }

    /// Law of a joint.
    pub(crate) fn law<'r>(&self, chain: usize, joint: usize, ropes: &'r Ropes) -> &'r Bushing {
        if joint == 0 {
            &ropes.base
        } else if joint == self.cylinders(chain) {
            &ropes.anchor
        } else {
            &ropes.joint
        }
    }

    /// Markers I and J of a joint.
    pub(crate) fn markers(
        &self,
        chain: usize,
        joint: usize,
        poses: &[Pose],
        at: &Instant<'_>,
    ) -> [Marker; 2] {
        let half = 0.5 * self.description.rope.pitch;
        let poses = self.chain_poses(chain, poses);
        let i = poses.get(joint).map_or_else(
            || self.anchor_marker(chain, at),
            |pose| on_cylinder(pose, -half),
        );
        let j = if joint == 0 {
            self.base_marker(chain, at)
        } else {
            on_cylinder(&poses[joint - 1], half)
        };
        [i, j]
    }

    /// The joint on the crossbeam end of the rod, or on the suspension point.
    fn base_marker(&self, chain: usize, at: &Instant<'_>) -> Marker {
        let (q, v) = (at.q, at.v);
        if chain == 0 {
            let rod = self.layout.rod();
            let (s, c) = sin_cos(q[rod]);
            let [pin, pin_velocity, _] = at.drive.pin;
            return Marker {
                p: V3::new(pin.x, pin.y, 0.0),
                rho: V3::new(c, s, 0.0) * self.description.rod.length,
                v: V3::new(pin_velocity.x, pin_velocity.y, 0.0),
                w: V3::new(0.0, 0.0, v[rod]),
                R: turned(s, c),
            };
        }
        let height = self.layout.suspension();
        Marker {
            p: V3::new(self.suspension_x, q[height], 0.0),
            rho: V3::zeros(),
            v: V3::new(0.0, v[height], 0.0),
            w: V3::zeros(),
            R: turned(1.0, 0.0),
        }
    }

    /// The fixed end of a rope on its head. The reference point carries the head's deflection, so
    /// that the arm stays rigid.
    fn anchor_marker(&self, chain: usize, at: &Instant<'_>) -> Marker {
        let beam = self.layout.beam();
        let (theta, rate) = (at.q[beam], at.v[beam]);
        let arc = self.arc(chain);
        let (s, c) = sin_cos(arc.anchor);
        let place = V3::new(
            arc.center[0] + arc.radius * c,
            arc.center[1] + arc.radius * s,
            0.0,
        );
        let (sb, cb) = sin_cos(theta);
        let R = turned(sb, cb);
        let w = V3::new(0.0, 0.0, rate);
        let (mut p, mut v) = (V3::zeros(), V3::zeros());
        if chain == 0 {
            for (k, shape) in self.anchor_shape.iter().enumerate() {
                let direction = R * V3::new(shape[0], shape[1], 0.0);
                p += direction * at.q[self.layout.mode(k)];
                v += direction * at.v[self.layout.mode(k)];
            }
            v += w.cross(&p);
        }
        // the rope's axis: towards the anchor along the arc
        let (sa, ca) = sin_cos(arc.anchor + theta);
        let (st, ct) = (arc.sense * ca, -arc.sense * sa);
        Marker {
            p,
            rho: R * place,
            v,
            w,
            R: turned(st, ct),
        }
    }
}

/// An individual's machine at one instant.
#[derive(Clone, Copy, Debug)]
pub struct Instant<'a> {
    /// The individual's ropes.
    pub ropes: &'a Ropes,
    /// Crank and load.
    pub drive: &'a DriveState,
    /// Coordinates.
    pub q: &'a [f64],
    /// Their rates.
    pub v: &'a [f64],
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

/// Rotation about z whose x axis is `(cosine, sine)`.
fn turned(sine: f64, cosine: f64) -> M3 {
    M3::new(cosine, -sine, 0.0, sine, cosine, 0.0, 0.0, 0.0, 1.0)
}
