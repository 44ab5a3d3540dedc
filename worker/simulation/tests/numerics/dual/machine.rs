//! Independent second implementation of the machine's equations, for planar motion and a rigid head.
//!
//! Only the machine's description, the layout of its coordinates, the crank's motion and the load card come
//! from the code under test.
use super::number::{Dual, Vector, number};
use simulation::drive::DriveState;
use simulation::model::Machine;
use simulation::model::contact::GAUSS;
use simulation::model::description::RopeLaw;
use simulation::sensitivity::Coefficient;
use std::f64::consts::{FRAC_PI_2, LN_10, PI, TAU};

/// Attachment point on a body: position and velocity of the body's reference point, the arm from there to the
/// attachment point, the body's angle and its rate.
#[derive(Clone, Copy, Default)]
struct Marker {
    point: Vector,
    velocity: Vector,
    arm: Vector,
    angle: Dual,
    rate: Dual,
}

impl Marker {
    fn place(&self) -> Vector {
        self.point.plus(self.arm)
    }

    fn moves(&self) -> Vector {
        self.velocity.plus(self.arm.across().times(self.rate))
    }
}

/// Stiffness and damping of a bushing: in axial direction, in lateral direction and in bending.
type Law = [[Dual; 2]; 3];

/// Computes the force of a bushing on body I and its torques on I and J (paper, Eqs. 1 to 3, in the axes of
/// J).
fn bushing([along, across, bending]: Law, i: &Marker, j: &Marker) -> (Vector, [Dual; 2]) {
    let apart = i.place().minus(j.place());
    let speed = i.moves().minus(j.moves());
    let seen = speed.minus(apart.across().times(j.rate));
    let axis = Vector::at(j.angle);
    let pull = |[k, c]: [Dual; 2], e: Vector| e.times(k * e.dot(apart) + c * e.dot(seen));
    let force = -pull(along, axis).plus(pull(across, axis.across()));
    let turn = i.angle - j.angle;
    let turn = turn - number(TAU * (turn.0 / TAU).round());
    let torque = -(bending[0] * turn + bending[1] * (i.rate - j.rate));
    // the force acts at I's place on both
    let on_j = apart.plus(j.arm).moment(force);
    (force, [torque + i.arm.moment(force), -torque - on_j])
}

/// Coordinates, rates and accelerations as dual numbers, which carry the derivative with respect to one
/// coefficient.
pub(super) type Motion = [Vec<Dual>; 3];

/// Machine with one rope law, evaluated in dual numbers that carry the derivative with respect to the decimal
/// logarithm of one coefficient.
pub(super) struct DualMachine<'a> {
    machine: &'a Machine,
    laws: [Law; 3],
    /// Stiffness and damping of the contact, and the penetration at which its damping is fully active.
    contact: [Dual; 3],
}

impl<'a> DualMachine<'a> {
    pub(super) fn new(machine: &'a Machine, law: &RopeLaw, by: Coefficient) -> Self {
        let rope = &machine.description.rope;
        let per_length = rope.reference_pitch / rope.pitch;
        let scaled = |which: Coefficient, factor: f64| {
            let value = factor * *which.of(&mut law.clone());
            Dual(value, if which == by { LN_10 * value } else { 0.0 })
        };
        let [inner, head] = [per_length, per_length / rope.end_pitches].map(|factor| {
            [
                [Coefficient::Kb1, Coefficient::Cb1],
                [Coefficient::Kb23, Coefficient::Cb23],
                [Coefficient::Kb56, Coefficient::Cb56],
            ]
            .map(|pair| pair.map(|which| scaled(which, factor)))
        });
        let [k, c] =
            [Coefficient::Kc, Coefficient::Cc].map(|which| scaled(which, 1.0 / per_length));
        Self {
            machine,
            laws: [inner, [head[0], head[0], [Dual::default(); 2]], head],
            contact: [k, c, number(law.contact.full_damping_penetration)],
        }
    }

    /// Computes the residual `Q - M a` and the torque that the crank must supply.
    pub(super) fn residual(&self, drive: &DriveState, motion: &Motion) -> (Vec<Dual>, Dual) {
        let mut out = vec![Dual::default(); motion[0].len()];
        let mut pin = self.rigid(drive, motion, &mut out);
        for chain in 0..2 {
            let pull = self.joints((drive, motion), chain, &mut out);
            self.cylinders(motion, chain, &mut out);
            if chain == 0 {
                pin = pin.plus(pull);
            }
        }
        let crank = &self.machine.description.crank;
        let arm = Vector::at(number(drive.pin_angle)).times(number(crank.sense * crank.radius));
        (out, arm.moment(pin))
    }

    /// Adds the forces on rod, suspension and beam; returns the force that the rod alone requires at the
    /// crank pin.
    fn rigid(&self, drive: &DriveState, [q, v, a]: &Motion, out: &mut [Dual]) -> Vector {
        let (d, layout) = (&self.machine.description, &self.machine.layout);
        let (rod, hook, beam) = (layout.rod(), layout.suspension(), layout.beam());
        let gravity = number(d.gravity);
        let along = Vector::at(q[rod]).times(number(d.rod.center_of_mass));
        let rise = Vector::new(drive.pin[2].x, drive.pin[2].y + d.gravity);
        let turned = along.across().times(a[rod]);
        let rise = rise.plus(turned).minus(along.times(v[rod] * v[rod]));
        let asked = rise.times(number(d.rod.mass));
        out[rod] = -(along.moment(asked) + number(d.rod.inertia) * a[rod]);
        let hung = number(d.suspension_mass);
        out[hook] = -(hung * (gravity + a[hook]) + number(drive.load));
        let [c, s] = Vector::at(q[beam]).0;
        let level = number(d.beam_gravity_moment) * c - number(d.beam_gravity_height) * s;
        out[beam] = -(level + number(d.beam_inertia) * a[beam]);
        asked
    }

    /// Returns a point on the axis of cylinder `j`; `along` is its distance from the centre in half lengths.
    fn on(&self, [q, v, _]: &Motion, (chain, j): (usize, usize), along: f64) -> Marker {
        let at = 3 * (self.machine.layout.first(chain) + j);
        let half = number(0.5 * along * self.machine.description.rope.pitch);
        Marker {
            point: Vector([q[at], q[at + 1]]),
            velocity: Vector([v[at], v[at + 1]]),
            arm: Vector::at(q[at + 2]).times(half),
            angle: q[at + 2],
            rate: v[at + 2],
        }
    }

    /// Returns the centre of a head's arc for a given beam angle.
    fn center(&self, beam: Dual, chain: usize) -> Vector {
        let d = &self.machine.description;
        let [x, y] = [&d.back_arc, &d.front_arc][chain].center;
        let axis = Vector::at(beam);
        axis.times(number(x)).plus(axis.across().times(number(y)))
    }

    /// Adds the joint forces of a rope; returns the force on its first cylinder.
    fn joints(
        &self,
        (drive, motion): (&DriveState, &Motion),
        chain: usize,
        out: &mut [Dual],
    ) -> Vector {
        let (d, layout) = (&self.machine.description, &self.machine.layout);
        let (rod, hook, beam) = (layout.rod(), layout.suspension(), layout.beam());
        let [q, v, _] = motion;
        let (arc, count) = [(&d.back_arc, layout.back), (&d.front_arc, layout.front)][chain];
        let first = 3 * layout.first(chain);
        let [place, velocity, _] = drive.pin.map(|x| Vector::new(x.x, x.y));
        let base = [
            Marker {
                point: place,
                velocity,
                arm: Vector::at(q[rod]).times(number(d.rod.length)),
                angle: q[rod],
                rate: v[rod],
            },
            Marker {
                point: Vector([number(self.machine.suspension_x), q[hook]]),
                velocity: Vector([Dual::default(), v[hook]]),
                ..Marker::default()
            },
        ][chain];
        let anchor = q[beam] + number(arc.anchor);
        let out_there = Vector::at(anchor).times(number(arc.radius));
        let head = Marker {
            arm: self.center(q[beam], chain).plus(out_there),
            angle: anchor + number(arc.sense * FRAC_PI_2),
            rate: v[beam],
            ..Marker::default()
        };
        let mut first_pull = Vector::default();
        for joint in 0..=count {
            let last = joint == count;
            let i = if last {
                head
            } else {
                self.on(motion, (chain, joint), -1.0)
            };
            let before = joint.checked_sub(1);
            let j = before.map_or(base, |before| self.on(motion, (chain, before), 1.0));
            let law = if last { 2 } else { usize::from(joint == 0) };
            let (force, [on_i, on_j]) = bushing(self.laws[law], &i, &j);
            match before {
                Some(before) => push(&mut out[first + 3 * before..], -force, on_j),
                None if chain == 0 => out[rod] = out[rod] + on_j,
                None => out[hook] = out[hook] - force.0[1],
            }
            if last {
                out[beam] = out[beam] + on_i;
            } else {
                push(&mut out[first + 3 * joint..], force, on_i);
            }
            if joint == 0 {
                first_pull = force;
            }
        }
        first_pull
    }

    /// Adds weight, inertia and contact forces of a rope's cylinders (paper, Eqs. 4 and 6).
    fn cylinders(&self, motion: &Motion, chain: usize, out: &mut [Dual]) {
        let (d, layout) = (&self.machine.description, &self.machine.layout);
        let (arc, count) = [(&d.back_arc, layout.back), (&d.front_arc, layout.front)][chain];
        let [q, v, a] = motion;
        let beam = layout.beam();
        let center = self.center(q[beam], chain);
        let carried = center.across().times(v[beam]);
        let (rope, radius) = (&d.rope, 0.5 * d.rope.diameter);
        let mass = rope.density * PI * radius * radius * rope.pitch;
        let inertia = mass * (3.0 * radius * radius + rope.pitch * rope.pitch) / 12.0;
        for j in 0..count {
            let own = 3 * (layout.first(chain) + j);
            let rise = Vector([a[own], a[own + 1] + number(d.gravity)]);
            let turn = number(inertia) * a[own + 2];
            push(&mut out[own..], rise.times(number(-mass)), -turn);
            for (along, share) in GAUSS {
                let at = self.on(motion, (chain, j), along);
                let toward = at.place().minus(center);
                let distance = toward.dot(toward).sqrt();
                let depth = number(arc.radius) - distance;
                if depth.0 <= 0.0 {
                    continue;
                }
                let normal = toward.times(number(1.0).over(distance));
                let [k, c, full] = self.contact;
                let u = depth.over(full);
                let u = if u.0 < 1.0 { u } else { number(1.0) };
                let step = u * u * (number(3.0) - number(2.0) * u);
                let leaves = normal.dot(at.moves().minus(carried));
                let force = k * depth * depth.sqrt() - c * step * leaves;
                if force.0 > 0.0 {
                    let force = normal.times(force * number(share));
                    push(&mut out[own..], force, at.arm.moment(force));
                    out[beam] = out[beam] - at.place().moment(force);
                }
            }
        }
    }
}

/// Adds a force and a torque on a cylinder to the three elements of the residual that belong to it.
fn push(rows: &mut [Dual], force: Vector, torque: Dual) {
    for (row, x) in rows.iter_mut().zip([force.0[0], force.0[1], torque]) {
        *row = *row + x;
    }
}
