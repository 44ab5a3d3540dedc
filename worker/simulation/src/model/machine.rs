//! A machine ready to be simulated: constants derived once from a description.
use crate::effect::{Cycle, Hooks, Selection};
use crate::element::{bushing::Bushing, impact::Impact};
use crate::math::spline::{Splines, sum::Sum};
use crate::model::chain::{Chain, ChainState};
use crate::model::description::{AddedMode, Arc, Description, RopeLaw};
use crate::model::kinematics::{Mechanism, Position};
use crate::model::layout::{Layout, Motion};
use crate::model::strand::{BACK, Face, Strand, faces, strands};
use crate::model::valid::{InvalidDescription, check};

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
    pub(crate) card: Splines,
    /// Back ropes, then front ropes: what they are made of, and where they hang.
    pub(crate) chains: Vec<Chain>,
    pub(crate) strands: Vec<Strand>,
    /// The back head as each back rope sees it.
    pub(crate) faces: Vec<Face>,
    /// What effects add.
    pub(crate) hooks: Hooks,
    /// The effects, and the ideal turn that they refer to.
    effects: Option<(Selection, Cycle)>,
}

/// Every rope of one individual: coefficients scaled to the pitch of the chain, and to the rope's share
/// of them where it is one of two.
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
        Ok(Self::assemble(description, modes, bottom, lowest))
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
        let mut machine = Self::assemble(edited, kept, bottom, lowest);
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
        mut description: Description,
        modes: usize,
        bottom: Position,
        lowest_suspension: f64,
    ) -> Self {
        let sway = join_families(&mut description, modes);
        let d = &description;
        let layout = Layout {
            back: d.rope.back,
            front: d.rope.front,
            modes: modes + sway,
            sway,
            ropes: if d.twins.is_some() { 2 } else { 1 },
            motion: if d.twins.is_some() {
                Motion::Space
            } else {
                Motion::Plane
            },
        };
        let strands = strands(d);
        let chain = |(k, strand): (usize, &Strand)| {
            let count = [d.rope.back, d.rope.front][strand.rope];
            let density = d.rope.density / layout.ropes as f64;
            let first = layout.first(k);
            let chain = Chain::solid(first, count, d.rope.diameter, d.rope.pitch, density);
            Chain {
                motion: layout.motion,
                ..chain
            }
        };
        Self {
            layout,
            bottom,
            lowest_suspension,
            suspension_x: d.front_arc.center[0] + d.front_arc.radius,
            card: Splines::periodic(
                0.0,
                std::f64::consts::TAU / d.card.len() as f64,
                std::slice::from_ref(&d.card),
            ),
            chains: strands.iter().enumerate().map(chain).collect(),
            faces: faces(d, &layout),
            strands,
            hooks: Hooks::default(),
            effects: None,
            description,
        }
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

    /// Share of one rope in what a description states of the rope on a head.
    pub(crate) fn share(&self) -> f64 {
        1.0 / self.layout.ropes as f64
    }

    /// A chain on the back head (0) or on the front head (1).
    pub(crate) fn chain_on(&self, rope: usize) -> &Chain {
        &self.chains[if rope == BACK { 0 } else { self.layout.ropes }]
    }

    /// Scales an individual's coefficients to this chain's pitch, so that the rope stays the same, and
    /// to one rope of two.
    pub fn ropes(&self, law: &RopeLaw) -> Ropes {
        let rope = &self.description.rope;
        let per_length = rope.reference_pitch / rope.pitch;
        let share = self.share();
        let mut joint = law.bushing.scaled(per_length).scaled(share);
        joint.preload *= share;
        let [base, anchor] = self.ends(&joint);
        Ropes {
            joint,
            base,
            anchor,
            contact: Impact {
                stiffness: law.contact.stiffness / per_length * share,
                damping: law.contact.damping / per_length * share,
                ..law.contact
            },
        }
    }

    /// The joints that hold a rope's first and last cylinder, from that between two cylinders.
    pub(crate) fn ends(&self, joint: &Bushing) -> [Bushing; 2] {
        let end = joint.scaled(1.0 / self.description.rope.end_pitches);
        if self.layout.twins() {
            [end.pinned(), end]
        } else {
            [end.revolute(), end]
        }
    }
}

/// Buffers of a simulation.
#[derive(Clone, Debug)]
pub struct Scratch {
    /// Poses and loads of the back ropes, then of the front ropes.
    pub chains: Vec<ChainState>,
    /// Deflection of the back head's arc under each back rope.
    pub deflection: Vec<Sum>,
}

impl Scratch {
    /// Buffers for a machine.
    pub fn new(machine: &Machine) -> Self {
        Self {
            chains: machine.chains.iter().map(ChainState::new).collect(),
            deflection: vec![Sum::default(); machine.faces.len()],
        }
    }

    /// Deepest penetration of a rope into a head \[m\].
    pub(crate) fn deepest(&self) -> f64 {
        self.chains
            .iter()
            .fold(0.0, |deepest, chain| deepest.max(chain.deepest))
    }
}

/// Puts the modes out of the plane behind those that are kept; returns how many there are.
fn join_families(d: &mut Description, modes: usize) -> usize {
    let Some(twins) = &d.twins else { return 0 };
    d.head.keep(modes);
    for (k, &frequency) in twins.sway.frequencies.iter().enumerate() {
        let stations = twins.sway.radial[k].len();
        // what a rope sees of them depends on its side: the faces know
        d.head.add(AddedMode {
            frequency,
            radial: vec![0.0; stations],
            tangential: vec![0.0; stations],
            participation: [0.0; 3],
        });
        d.head.gauge_stress[modes + k] = twins.sway.gauge_stress[k];
    }
    twins.sway.frequencies.len()
}

fn lowest_suspension(d: &Description, bottom: &Position) -> f64 {
    let rope = d.rope.front as f64 * d.rope.pitch;
    let lowest = d.front_arc.radius * bottom.beam;
    let wrapped = d.front_arc.radius * d.front_arc.anchor + lowest;
    wrapped - rope
}
