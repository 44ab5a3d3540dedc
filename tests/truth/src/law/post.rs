//! Compliance of the foundation: the beam's pivot sinks vertically under its load.
//!
//! The vertical motion is one additional mode of the head, a rigid translation across the beam; the load on
//! the front side acts on it as a prescribed force.
use super::kind::{HiddenEffect, Shape, record_shape};
use crate::draw::RandomStream;
use libm::{cos, sin, sqrt};
use simulation::effect::{Dashpot, Effect, Extensions, Force, Site};
use simulation::linear::Bordered;
use simulation::model::MachineState;
use simulation::model::description::{AddedMode, Description};
use std::sync::Arc;

pub(super) fn sinking(
    size: f64,
    draw: &mut RandomStream,
    shape: &mut Shape,
) -> Arc<dyn HiddenEffect> {
    Arc::new(FoundationCompliance {
        compliance: size,
        damping: record_shape(shape, "damping_1", draw.between(0.02, 0.06)),
        mass: record_shape(shape, "mass_kg", draw.between(5e3, 12e3)),
    })
}

#[derive(Clone, Copy, Debug)]
struct FoundationCompliance {
    compliance: f64,
    damping: f64,
    mass: f64,
}

impl FoundationCompliance {
    fn frequency(&self) -> f64 {
        sqrt(1.0 / (self.compliance * self.mass))
    }
}

impl Effect for FoundationCompliance {
    fn describe(&self, d: &mut Description, modes: &mut usize) {
        let head = &mut d.head;
        head.keep(*modes);
        let stations = head.radial.first().map_or(2, Vec::len);
        let root = sqrt(self.mass);
        let angle = |i: usize| head.start + head.step * i as f64;
        let [radial, tangential] = [sin, cos].map(|part| {
            (0..stations)
                .map(|i| part(angle(i)) / root)
                .collect::<Vec<f64>>()
        });
        let offset = d.beam_gravity_moment / d.gravity / root;
        head.add(AddedMode {
            frequency: self.frequency(),
            radial,
            tangential,
            participation: [0.0, root, offset],
        });
        *modes += 1;
    }

    fn install(&self, site: &Site<'_>, extensions: &mut Extensions) {
        let d = &site.description;
        let heaviest = (0..360)
            .map(|k| site.cycle.tension(f64::from(k).to_radians()))
            .chain(d.card.iter().copied())
            .fold(0.0, f64::max);
        extensions.add_rise(5.0 * self.compliance * heaviest);
        let mode = site.layout.mode(site.layout.modes - 1);
        extensions.add_force(FrontPull {
            weight: d.suspension_mass * d.gravity,
            root: sqrt(self.mass),
            mode,
            beam: site.layout.beam(),
        });
        // beside what every mode of the head has
        let damping = 2.0 * (self.damping - d.head.damping_ratio) * self.frequency();
        extensions.add_line_force(mode, Dashpot { damping });
    }
}

impl HiddenEffect for FoundationCompliance {}

/// Front load `P` as a force on the sinking pivot; its potential is `P u cos(theta)` with the beam angle
/// `theta` and the displacement `u = y / sqrt(m)` of the pivot across the beam (`y`: modal coordinate).
#[derive(Clone, Copy, Debug)]
struct FrontPull {
    weight: f64,
    root: f64,
    mode: usize,
    beam: usize,
}

impl FrontPull {
    /// Returns the terms from which force, tangent and potential are built: `P / sqrt(m)`, `y sin(theta)`, `y
    /// cos(theta)`, `sin(theta)` and `cos(theta)`, with load `P`, modal coordinate `y` and beam angle
    /// `theta`.
    fn parts(&self, at: &MachineState<'_>) -> [f64; 5] {
        let (s, c) = (sin(at.q[self.beam]), cos(at.q[self.beam]));
        let y = at.q[self.mode];
        [
            (at.drive.load + self.weight) / self.root,
            y * s,
            y * c,
            s,
            c,
        ]
    }
}

impl Force for FrontPull {
    fn add(&self, at: &MachineState<'_>, force: &mut [f64]) {
        let [pull, along, _, _, c] = self.parts(at);
        force[self.mode] -= pull * c;
        force[self.beam] += pull * along;
    }

    fn add_tangent(&self, at: &MachineState<'_>, _: f64, matrix: &mut Bordered) {
        // the matrix takes the derivative of the force with the other sign
        let [pull, _, across, s, _] = self.parts(at);
        matrix.add(self.mode, self.beam, -(pull * s));
        matrix.add(self.beam, self.mode, -(pull * s));
        matrix.add(self.beam, self.beam, -(pull * across));
    }

    fn energy(&self, _: &MachineState<'_>) -> f64 {
        0.0
    }

    fn potential(&self, at: &MachineState<'_>) -> f64 {
        let [pull, _, across, ..] = self.parts(at);
        pull * across
    }

    fn lost(&self, at: &MachineState<'_>) -> f64 {
        let [pull, along, _, _, c] = self.parts(at);
        pull * (c * at.v[self.mode] - along * at.v[self.beam])
    }
}
