//! A machine ready to be simulated: constants derived once from a description.
use crate::effect::{Cycle, Hooks, Selection};
use crate::element::{bushing::Bushing, impact::Impact};
use crate::math::elementary::sin_cos;
use crate::math::spline::{Splines, sum::Sum};
use crate::model::chain::{Chain, ChainState};
use crate::model::description::{Arc, Description, RopeLaw};
use crate::model::kinematics::{DoesNotClose, Mechanism, Position};
use crate::model::layout::{Layout, Motion};

/// A machine under one working condition; immutable and shared by every individual.
#[derive(Clone, Debug)]
pub struct Machine {
    /// What it was made from.
    pub description: Description,
    /// Where its coordinates live.
    pub layout: Layout,
    /// Bottom dead centre of the inextensible mechanism: where the turn angle is zero.
    pub bottom: Position,
    /// Height in W of the suspension point's lowest design position \[m\]: bottom dead centre without
    /// effects, the front rope unstretched.
    pub lowest_suspension: f64,
    /// Horizontal place of the guided suspension point \[m\].
    pub suspension_x: f64,
    pub(crate) radial: Splines,
    pub(crate) card: Splines,
    /// Shapes at the back anchor in the beam frame, mode by mode.
    pub(crate) anchor_shape: Vec<[f64; 2]>,
    /// Back rope and front rope.
    pub(crate) chains: [Chain; 2],
    pub(crate) normal_influence: Splines,
    pub(crate) tangential_influence: Splines,
    /// What effects add.
    pub(crate) hooks: Hooks,
    /// The effects, and the ideal turn that they refer to.
    effects: Option<(Selection, Cycle)>,
}

/// The ropes of one individual: coefficients scaled to the pitch of the chain.
#[derive(Clone, Copy, Debug)]
pub struct Ropes {
    /// Between two cylinders.
    pub joint: Bushing,
    /// Between crossbeam or suspension and the first cylinder.
    pub base: Bushing,
    /// Between the last cylinder and the head.
    pub anchor: Bushing,
    /// Between a cylinder and a head.
    pub contact: Impact,
}

/// A description that cannot be a machine.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InvalidDescription {
    /// A number that must be positive and finite is not.
    #[error("{what} is {value}; it must be a positive number")]
    NotPositive {
        /// Which number.
        what: &'static str,
        /// Its value, SI.
        value: f64,
    },
    /// A table has the wrong size.
    #[error("{what} has {found} entries; expected {expected}")]
    Shape {
        /// Which table.
        what: &'static str,
        /// Entries found.
        found: usize,
        /// Entries expected.
        expected: usize,
    },
    /// The mechanism does not turn through.
    #[error("the crank cannot turn through: {0}")]
    Mechanism(#[from] DoesNotClose),
}

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Machine {
    /// Checks a description and derives the constants.
    ///
    /// `modes` is the number of head modes to keep.
    ///
    /// # Errors
    /// [`InvalidDescription`] naming the number or table that is wrong.
    pub fn new(description: Description, modes: usize) -> Result<Self, InvalidDescription> {
        check(&description, modes)?;
        let bottom = Mechanism::of(&description).bottom_dead_centre()?;
        let lowest = lowest_suspension(&description, &bottom);
        Self::assemble(description, modes, bottom, lowest)
    }

    /// As [`Self::new`], with effects. Turn 0 stays where the machine without them has its bottom
    /// dead centre: that is where its crank is marked.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_effects(
        description: Description,
        modes: usize,
        selection: &Selection,
    ) -> Result<Self, InvalidDescription> {
        if selection.is_empty() {
            return Self::new(description, modes);
        }
        check(&description, modes)?;
        let marked = Mechanism::of(&description).bottom_dead_centre()?;
        let lowest = lowest_suspension(&description, &marked);
        let (mut edited, mut kept) = (description, modes);
        for effect in &selection.effects {
            effect.describe(&mut edited, &mut kept);
        }
        check(&edited, kept)?;
        let mechanism = Mechanism::of(&edited);
        let bottom = mechanism.position(marked.pin, marked.beam, marked.tangent)?;
        let cycle = Cycle::new(&edited, &mechanism, &bottom)?;
        let mut machine = Self::assemble(edited, kept, bottom, lowest)?;
        machine.effects = Some((selection.clone(), cycle));
        machine.install_effects();
        Ok(machine)
    }

    /// Hangs the effects' pieces, which know where in the layout they act.
    fn install_effects(&mut self) {
        let mut hooks = Hooks::default();
        if let Some((selection, cycle)) = &self.effects {
            for effect in &selection.effects {
                effect.install(self, cycle, &mut hooks);
            }
        }
        self.hooks = hooks;
    }

    fn assemble(
        description: Description,
        modes: usize,
        bottom: Position,
        lowest_suspension: f64,
    ) -> Result<Self, InvalidDescription> {
        let d = &description;
        let layout = Layout {
            back: d.rope.back,
            front: d.rope.front,
            modes,
            motion: Motion::Plane,
        };
        let chain = |k: usize, count: usize| {
            let first = layout.base_block(k) + 1;
            let chain = Chain::solid(first, count, d.rope.diameter, d.rope.pitch, d.rope.density);
            Chain {
                motion: layout.motion,
                ..chain
            }
        };
        let chains = [chain(0, d.rope.back), chain(1, d.rope.front)];
        let radial = Splines::natural(d.head.start, d.head.step, &d.head.radial[..modes]);
        let tangential = Splines::natural(d.head.start, d.head.step, &d.head.tangential[..modes]);
        let (s, c) = sin_cos(d.back_arc.anchor);
        let anchor_shape = (0..modes)
            .map(|k| {
                let r = radial.value(d.back_arc.anchor, k);
                let t = tangential.value(d.back_arc.anchor, k);
                [r * c - t * s, r * s + t * c]
            })
            .collect();
        let influence = |curves: &[Vec<f64>]| {
            Splines::natural(d.head.influence_start, d.head.influence_step, curves)
        };
        Ok(Self {
            layout,
            bottom,
            lowest_suspension,
            suspension_x: d.front_arc.center[0] + d.front_arc.radius,
            card: Splines::periodic(
                0.0,
                std::f64::consts::TAU / d.card.len() as f64,
                std::slice::from_ref(&d.card),
            ),
            anchor_shape,
            chains,
            normal_influence: influence(&d.head.normal_influence),
            tangential_influence: influence(&d.head.tangential_influence),
            radial,
            hooks: Hooks::default(),
            effects: None,
            description,
        })
    }

    /// The same machine with six coordinates per cylinder.
    ///
    /// [`Self::new`] takes three, because a symmetric machine stays in its plane; this one shows
    /// that it does.
    #[must_use]
    pub fn in_space(mut self) -> Self {
        self.layout.motion = Motion::Space;
        for chain in &mut self.chains {
            chain.motion = Motion::Space;
        }
        self.install_effects();
        self
    }

    /// Range of the beam on the inextensible mechanism \[rad\].
    pub fn swing(&self) -> [f64; 2] {
        let mechanism = self.mechanism(self.description.back_arc.radius, self.back_length());
        let mut at = self.bottom;
        let mut highest = at.beam;
        for k in 1..=90 {
            let pin = self.bottom.pin + std::f64::consts::TAU * f64::from(k) / 90.0;
            if let Ok(next) = mechanism.position(pin, at.beam, at.tangent) {
                at = next;
                highest = highest.max(at.beam);
            }
        }
        [self.bottom.beam, highest]
    }

    /// The inextensible mechanism with another effective radius and length.
    pub fn mechanism(&self, radius: f64, length: f64) -> Mechanism {
        Mechanism {
            crank: self.description.crank,
            arc: Arc {
                radius,
                ..self.description.back_arc
            },
            length,
        }
    }

    /// Length from crank pin to back anchor along rod and unstretched rope \[m\].
    pub fn back_length(&self) -> f64 {
        self.description.rope.back as f64 * self.description.rope.pitch
            + self.description.rod.length
    }

    /// Scales an individual's coefficients to this chain's pitch, so that the rope stays the same.
    pub fn ropes(&self, law: &RopeLaw) -> Ropes {
        let rope = &self.description.rope;
        let per_length = rope.reference_pitch / rope.pitch;
        let joint = law.bushing.scaled(per_length);
        let end = joint.scaled(1.0 / rope.end_pitches);
        Ropes {
            joint,
            base: end.revolute(),
            anchor: end,
            contact: Impact {
                stiffness: law.contact.stiffness / per_length,
                damping: law.contact.damping / per_length,
                ..law.contact
            },
        }
    }
}

/// Buffers of a simulation.
#[derive(Clone, Debug)]
pub struct Scratch {
    /// Poses and loads of back rope and front rope.
    pub chains: [ChainState; 2],
    /// Deflection of the back head's arc.
    pub deflection: Sum,
}

impl Scratch {
    /// Buffers for a machine.
    pub fn new(machine: &Machine) -> Self {
        Self {
            chains: machine.chains.each_ref().map(ChainState::new),
            deflection: Sum::default(),
        }
    }

    /// Deepest penetration of a rope into a head \[m\].
    pub(crate) fn deepest(&self) -> f64 {
        self.chains[0].deepest.max(self.chains[1].deepest)
    }
}

fn lowest_suspension(d: &Description, bottom: &Position) -> f64 {
    let rope = d.rope.front as f64 * d.rope.pitch;
    let lowest = d.front_arc.radius * bottom.beam;
    let wrapped = d.front_arc.radius * d.front_arc.anchor + lowest;
    wrapped - rope
}

fn check(d: &Description, modes: usize) -> Result<(), InvalidDescription> {
    let positive: [(&'static str, f64); 14] = [
        ("gravity", d.gravity),
        ("beam inertia", d.beam_inertia),
        ("crank radius", d.crank.radius),
        ("crank speed", d.crank.speed),
        ("rod length", d.rod.length),
        ("rod mass", d.rod.mass),
        ("rod inertia", d.rod.inertia),
        ("suspension mass", d.suspension_mass),
        ("rope diameter", d.rope.diameter),
        ("cylinder length", d.rope.pitch),
        ("rope density", d.rope.density),
        ("reference length", d.rope.reference_pitch),
        ("front radius", d.front_arc.radius),
        ("back radius", d.back_arc.radius),
    ];
    for (what, value) in positive {
        if !(value > 0.0 && value.is_finite()) {
            return Err(InvalidDescription::NotPositive { what, value });
        }
    }
    let stations = d.head.radial.first().map_or(0, Vec::len);
    let sizes = [
        ("radial shapes", d.head.radial.len().min(modes), modes),
        (
            "tangential shapes",
            d.head.tangential.len().min(modes),
            modes,
        ),
        (
            "head frequencies",
            d.head.frequencies.len().min(modes),
            modes,
        ),
        (
            "gauge stresses",
            d.head.gauge_stress.len().min(modes),
            modes,
        ),
        (
            "participations",
            d.head.participation.len().min(modes),
            modes,
        ),
        ("normal influence lines", d.head.normal_influence.len(), 4),
        (
            "tangential influence lines",
            d.head.tangential_influence.len(),
            4,
        ),
        ("back rope", d.rope.back.min(3), 3),
        ("front rope", d.rope.front.min(3), 3),
        ("load card", d.card.len().min(8), 8),
    ];
    for (what, found, expected) in sizes {
        if found != expected {
            return Err(InvalidDescription::Shape {
                what,
                found,
                expected,
            });
        }
    }
    for table in d.head.radial.iter().chain(&d.head.tangential) {
        if table.len() != stations {
            return Err(InvalidDescription::Shape {
                what: "mode shape",
                found: table.len(),
                expected: stations,
            });
        }
    }
    Ok(())
}
