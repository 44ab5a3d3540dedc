//! Test rig for a single rope: the machine's chain with other end conditions.
//!
//! Every verification of the rope's physics (cantilever, catenary, vibration, a rope on a drum, a bounce)
//! uses this model with different ends; forces, tangent, solver and integrator are those of the machine.
//! There is no beam and therefore no border.
use crate::element::{
    bushing::{Bushing, Marker},
    impact::Impact,
};
use crate::linear::{BLOCK, Bordered, MatrixEntry};
use crate::math::rotation::about_z;
use crate::model::chain::{Chain, ChainState, EndJoint, Joints};
use crate::model::contact::Surface;
use crate::model::description::Arc;
use crate::norm::{cylinders_error, cylinders_newton};
use crate::system::{Equations, LoadedState, Powers, StateRef, StateShift, Static};
use nalgebra::Vector3;

type V3 = Vector3<f64>;

/// End condition of the rig's chain of cylinders.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// Free end of the chain; the loads on it have a potential.
    Free {
        /// Force on the outer end of the end cylinder, of constant direction in the world frame W \[N\].
        force: V3,
        /// Torque on the end cylinder about its own axis [N m].
        twist: f64,
        /// Torque on the end cylinder about the z axis of the world frame W [N m].
        turn: f64,
    },
    /// End of the chain joined to the ground.
    Held {
        /// Position of the joint to the ground, in the world frame W \[m\].
        place: V3,
        /// Direction of the chain's axis at the joint to the ground, as an angle from +x in the plane
        /// \[rad\].
        angle: f64,
        /// Law of the joint to the ground: clamped, or revolute by [`Bushing::revolute`].
        law: Bushing,
    },
}

/// Drum about the z axis, fixed in the world frame W, and the law of a cylinder's contact with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drum {
    /// Centre of the drum \[m\].
    pub center: [f64; 2],
    /// Radius of the centre line of the rope lying on the drum \[m\].
    pub radius: f64,
    /// Law of a cylinder's contact with the drum.
    pub law: Impact,
}

/// Parameters of a rope test rig.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setup {
    /// Chain of cylinders of the rig, whose coordinate blocks start at 0.
    pub chain: Chain,
    /// Acceleration of gravity [m/s2].
    pub gravity: V3,
    /// Law of the joint between two cylinders.
    pub joint: Bushing,
    /// End conditions before the first and after the last cylinder.
    pub ends: [End; 2],
    /// Drum that the chain may touch, if any.
    pub drum: Option<Drum>,
}

/// Equations of motion of a test rig, with the loads of its last evaluation.
#[derive(Clone, Debug)]
pub struct Rig {
    /// Parameters of the rig.
    pub setup: Setup,
    /// Poses and loads of the last evaluation.
    pub state: ChainState,
}

impl End {
    /// Returns a free end of a chain without loads.
    pub fn free() -> Self {
        Self::Free {
            force: V3::zeros(),
            twist: 0.0,
            turn: 0.0,
        }
    }

    fn held(&self) -> Option<EndJoint<'_>> {
        let Self::Held { place, angle, law } = self else {
            return None;
        };
        let (s, c) = crate::math::elementary::sin_cos(*angle);
        Some(EndJoint {
            marker: Marker {
                p: *place,
                rho: V3::zeros(),
                v: V3::zeros(),
                w: V3::zeros(),
                R: about_z(s, c),
            },
            law,
            pinned: false,
        })
    }
}

impl Setup {
    fn joints(&self) -> Joints<'_> {
        let [base, head] = &self.ends;
        Joints {
            inner: &self.joint,
            base: base.held(),
            head: head.held(),
            axial: None,
        }
    }
}

impl Rig {
    /// Creates the equations of motion of a rig and allocates the buffers for its loads.
    pub fn new(setup: Setup) -> Self {
        Self {
            setup,
            state: ChainState::new(&setup.chain),
        }
    }

    /// Returns the coordinates of a straight, unstretched chain from `start` in the direction `angle` in the
    /// plane.
    pub fn straight(&self, start: V3, angle: f64) -> Vec<f64> {
        let Chain { count, pitch, .. } = self.setup.chain;
        let (s, c) = crate::math::elementary::sin_cos(angle);
        (0..count)
            .flat_map(|j| {
                let along = (j as f64 + 0.5) * pitch;
                [
                    start.x + along * c,
                    start.y + along * s,
                    start.z,
                    0.0,
                    0.0,
                    angle,
                ]
            })
            .collect()
    }

    /// Returns the position in the world frame W of the end of cylinder `j` that faces the end of the chain
    /// \[m\].
    pub fn outer_end(&self, j: usize) -> V3 {
        let pose = &self.state.poses[j];
        pose.p + pose.axis() * (0.5 * self.setup.chain.pitch)
    }

    /// Returns kinetic plus potential energy at a state, including the potential of the dead loads \[J\].
    pub fn energy(&mut self, q: &[f64], v: &[f64]) -> f64 {
        self.setup.chain.pose(q, v, &mut self.state);
        if let Some((surface, law)) = self.surface() {
            self.setup
                .chain
                .evaluate_contact(&surface, &law, &mut self.state);
        }
        let mut momentum = vec![0.0; v.len()];
        self.subtract_inertia(q, v, &mut momentum);
        let kinetic: f64 = momentum.iter().zip(v).map(|(p, v)| -0.5 * p * v).sum();
        kinetic + self.potential_energy(q)
    }

    fn surface(&self) -> Option<(Surface<'static>, Impact)> {
        self.setup.drum.map(|drum| {
            let arc = Arc {
                center: drum.center,
                radius: drum.radius,
                anchor: 0.0,
                sense: 1.0,
            };
            (Surface::new(&arc, [0.0; 2], None), drum.law)
        })
    }

    /// Returns the loads of each free end: cylinder, position along its axis \[m\], force, and generalised
    /// torques on twist and plane angle.
    fn dead_loads(&self) -> impl Iterator<Item = (usize, f64, V3, [f64; 2])> {
        let Chain { count, pitch, .. } = self.setup.chain;
        let place = [(0, -0.5 * pitch), (count - 1, 0.5 * pitch)];
        self.setup
            .ends
            .into_iter()
            .zip(place)
            .filter_map(|(end, (j, along))| match end {
                End::Free { force, twist, turn } => Some((j, along, force, [twist, turn])),
                End::Held { .. } => None,
            })
    }

    fn potential_energy(&self, q: &[f64]) -> f64 {
        let mut sum = 0.0;
        self.setup.chain.add_potential(
            &mut sum,
            &self.setup.gravity,
            &self.setup.joints(),
            self.setup.drum.as_ref().map(|drum| &drum.law),
            &self.state,
        );
        for (j, along, force, [twist, turn]) in self.dead_loads() {
            let pose = &self.state.poses[j];
            sum -= force.dot(&(pose.p + pose.axis() * along));
            sum -= twist * q[j * BLOCK + 3] + turn * q[j * BLOCK + 5];
        }
        sum
    }
}

impl Equations for Rig {
    fn matrix(&self) -> Bordered {
        Bordered::space(&[self.setup.chain.count], [0; 2])
    }

    fn forces(&mut self, StateRef { q, v, .. }: StateRef<'_>, force: &mut [f64]) {
        let chain = self.setup.chain;
        force.fill(0.0);
        chain.pose(q, v, &mut self.state);
        chain.add_weights(&self.setup.gravity, &self.state, force);
        chain.add_joints(&self.setup.joints(), &mut self.state, force);
        if let Some((surface, law)) = self.surface() {
            chain.add_contact(&surface, &law, &mut self.state, force, &mut []);
        }
        for (j, along, dead, [twist, turn]) in self.dead_loads() {
            let pose = &self.state.poses[j];
            let at = j * BLOCK;
            for k in 0..3 {
                force[at + k] += dead[k];
            }
            force[at + 3] += twist;
            force[at + 5] += turn;
            for (k, axis) in pose.axis_by.iter().enumerate() {
                force[at + 4 + k] += along * dead.dot(axis);
            }
        }
    }

    fn subtract_inertia<T: MatrixEntry>(&self, q: &[f64], a: &[T], out: &mut [T]) {
        self.setup.chain.subtract_inertia(q, a, out);
    }

    fn tangent(&self, at: LoadedState<'_>, shift: StateShift, matrix: &mut Bordered) {
        let StateShift { mass, damping } = shift;
        let chain = self.setup.chain;
        matrix.clear();
        chain.add_inertia_blocks(at.state().q, mass, matrix);
        let joints = self.setup.joints();
        chain.add_joint_tangent(&joints, &self.state, damping, (None, &mut *matrix));
        let ends = chain.ends(&joints, &self.state);
        chain.add_end_tangent(&ends, damping, matrix);
        if let Some((surface, law)) = self.surface() {
            let on = (&surface, &law);
            chain.add_contact_tangent(on, &self.state, damping, (None, &mut *matrix));
        }
        for (j, along, force, _) in self.dead_loads() {
            let bends = self.state.poses[j].axis_by_twice();
            for a in 0..2 {
                for b in 0..2 {
                    matrix.add_diagonal(j, 4 + a, 4 + b, -along * force.dot(&bends[a + b]));
                }
            }
        }
    }

    fn add_velocity_inertia_tangent(
        &self,
        at: StateRef<'_>,
        a: &[f64],
        damping: f64,
        matrix: &mut Bordered,
    ) {
        let chain = self.setup.chain;
        chain.add_spin_tangent(at, a, damping, matrix);
    }

    fn newton_norm(&self, change: &[f64]) -> f64 {
        cylinders_newton(0.0, change, BLOCK)
    }

    fn error_norm(&self, error: &[f64]) -> f64 {
        cylinders_error(0.0, error, BLOCK)
    }

    fn powers(&self, _: LoadedState<'_>, _: &[f64]) -> Powers {
        Powers {
            dissipated: self.state.losses(),
            ..Powers::default()
        }
    }
}

impl Static for Rig {
    fn potential(&self, at: LoadedState<'_>) -> f64 {
        self.potential_energy(at.state().q)
    }

    fn add_static_weight(&self, lambda: f64, matrix: &mut Bordered) {
        self.setup.chain.add_static_weight(lambda, matrix);
    }
}
