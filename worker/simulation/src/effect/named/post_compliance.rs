//! Compliance of post and foundation: the beam's pivot moves, `u / c + D u' = T + F + W`, with displacement
//! `u`, compliance `c`, damping `D`, rope tension `T`, load `F` and weight `W`.
//!
//! The pivot's displacement is represented by two additional modes of the back head, whose shapes are rigid
//! translations along the axes of the beam frame: contact, anchor and weight act on them as on any mode. The
//! front rope does not act on these modes: the load and the weight at the suspension point act on the pivot
//! as a prescribed force instead. The post is equally stiff along and across the beam; `mass` moves with the
//! pivot.
//!
//! Source: elastic supports: Craig and Kurdila, *Fundamentals of Structural Dynamics*, 2nd ed. (2006).
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;
use crate::linear::Bordered;
use crate::math::elementary::sin_cos;
use crate::model::cycle::Cycle;
use crate::model::description::{AddedMode, Description};
use crate::model::extension::{Dashpot, Effect, Extensions, Force, Site};
use crate::model::layout::MAX_MODES;
use crate::model::machine_state::MachineState;
use std::f64::consts::TAU;

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new("post_compliance", "Compliance of post and foundation")
        .with_location("saddle", Place::Dynamics)
        .size("compliance", Unit::MetrePerNewton, 5e-8, [0.0, 1e-6])
        .shape("damping", Unit::One, 0.03, [0.0, 0.5])
        .shape("mass", Unit::Kilogram, 5100.0, [500.0, 5e4])
        .with_constructor(|v| Post {
            compliance: v.get("compliance"),
            damping: v.get("damping"),
            mass: v.get("mass"),
        })
}

#[derive(Clone, Copy, Debug)]
struct Post {
    compliance: f64,
    damping: f64,
    mass: f64,
}

impl Post {
    /// Computes twice the largest quasi-static load on the pivot \[N\], as an upper bound that dynamic loads
    /// stay well below.
    fn heaviest(&self, d: &Description, cycle: &Cycle) -> f64 {
        let turns = (0..360_u32).map(|k| TAU * f64::from(k) / 360.0);
        let rope = turns.map(|turn| cycle.tension(turn)).fold(0.0, f64::max);
        let load = d.card.iter().copied().fold(0.0, f64::max);
        2.0 * (rope + load + (d.suspension_mass + self.mass) * d.gravity)
    }

    /// Computes the angular frequency of `mass` on the compliant post [rad/s].
    fn frequency(&self) -> f64 {
        (1.0 / (self.compliance * self.mass)).sqrt()
    }
}

impl Effect for Post {
    fn describe(&self, d: &mut Description, modes: &mut usize) {
        let head = &mut d.head;
        *modes = (*modes).min(MAX_MODES - 2);
        head.keep(*modes);
        let stations = head.radial.first().map_or(27, Vec::len);
        let root = self.mass.sqrt();
        let at = |i: usize| sin_cos(head.start + head.step * i as f64);
        let shapes: [[Vec<f64>; 2]; 2] = [
            [
                (0..stations).map(|i| at(i).1 / root).collect(),
                (0..stations).map(|i| -at(i).0 / root).collect(),
            ],
            [
                (0..stations).map(|i| at(i).0 / root).collect(),
                (0..stations).map(|i| at(i).1 / root).collect(),
            ],
        ];
        // the assembly's static moment couples its sinking with its turning
        let offset = d.beam_gravity_moment / d.gravity / root;
        let couplings = [[root, 0.0, 0.0], [0.0, root, offset]];
        for ([radial, tangential], coupling) in shapes.into_iter().zip(couplings) {
            head.add(AddedMode {
                frequency: self.frequency(),
                radial,
                tangential,
                participation: coupling,
            });
        }
        *modes += 2;
    }

    fn install(&self, site: &Site<'_>, extensions: &mut Extensions) {
        let d = &site.description;
        extensions.add_rise(self.compliance * self.heaviest(d, site.cycle));
        let layout = site.layout;
        let [along, across] = [2, 1]
            .map(|k| layout.plane_modes() - k)
            .map(|k| layout.mode(k));
        extensions.add_force(FrontPull {
            weight: d.suspension_mass * d.gravity,
            root: self.mass.sqrt(),
            along,
            across,
            beam: layout.beam(),
        });
        // beside what every mode of the head has
        let damping = 2.0 * (self.damping - d.head.damping_ratio) * self.frequency();
        for coordinate in [along, across] {
            extensions.add_line_force(coordinate, Dashpot { damping });
        }
    }
}

/// Force on the displaced pivot by the load `P` at the front head; two modal coordinates `x`, `y` displace
/// the pivot by `(x, y) / sqrt(m)` in the beam frame. Its potential is `V = P (x sin theta + y cos theta) /
/// sqrt(m)`.
#[derive(Clone, Copy, Debug)]
struct FrontPull {
    weight: f64,
    root: f64,
    along: usize,
    across: usize,
    beam: usize,
}

impl FrontPull {
    /// Returns the terms of the force: the load divided by `sqrt(m)`; the pivot's height times `sqrt(m)` with
    /// its derivative with respect to the beam angle; sine and cosine of the beam angle.
    fn parts(&self, at: &MachineState<'_>) -> (f64, [f64; 2], (f64, f64)) {
        let (s, c) = sin_cos(at.q[self.beam]);
        let (x, y) = (at.q[self.along], at.q[self.across]);
        let pull = (at.drive.load + self.weight) / self.root;
        (pull, [x * s + y * c, x * c - y * s], (s, c))
    }
}

impl Force for FrontPull {
    fn add(&self, at: &MachineState<'_>, force: &mut [f64]) {
        let (pull, [_, turned], (s, c)) = self.parts(at);
        force[self.along] -= pull * s;
        force[self.across] -= pull * c;
        force[self.beam] -= pull * turned;
    }

    fn add_tangent(&self, at: &MachineState<'_>, _: f64, matrix: &mut Bordered) {
        let (pull, [height, _], (s, c)) = self.parts(at);
        for (index, value) in [(self.along, pull * c), (self.across, -(pull * s))] {
            matrix.add(index, self.beam, value);
            matrix.add(self.beam, index, value);
        }
        matrix.add(self.beam, self.beam, -(pull * height));
    }

    fn energy(&self, _: &MachineState<'_>) -> f64 {
        0.0
    }

    fn potential(&self, at: &MachineState<'_>) -> f64 {
        let (pull, [height, _], _) = self.parts(at);
        pull * height
    }

    /// Computes the power that the load at the front head receives as the pivot sinks \[W\].
    fn lost(&self, at: &MachineState<'_>) -> f64 {
        let (pull, [_, turned], (s, c)) = self.parts(at);
        pull * (s * at.v[self.along] + c * at.v[self.across] + turned * at.v[self.beam])
    }
}
