//! Machine ready for simulation, with constants derived once from a description.
use crate::math::spline::Splines;
use crate::model::chain::parts::Chain;
use crate::model::cycle::Cycle;
use crate::model::description::{AddedMode, Description, RopeLaw};
use crate::model::extension::{Effect, Extensions, Site};
use crate::model::kinematics::{Mechanism, Position};
use crate::model::layout::{Layout, Motion};
use crate::model::parallel_ropes::{BACK, HeadResponse, ParallelRope, faces, strands};
use crate::model::ropes::Ropes;
use crate::model::valid::{InvalidDescription, check};

/// Machine under one working condition; immutable and shared by all individuals.
#[derive(Clone, Debug)]
pub struct Machine {
    /// Description that the machine was built from.
    pub description: Description,
    /// Indices of the machine's coordinates.
    pub layout: Layout,
    /// Bottom dead centre of the inextensible mechanism, where the turn angle is zero.
    pub bottom: Position,
    /// Height in the world frame W of the suspension point at its lowest design position \[m\]: bottom dead
    /// centre without effects, front rope unstretched.
    pub lowest_suspension: f64,
    /// Horizontal position of the guided suspension point \[m\].
    pub suspension_x: f64,
    pub(crate) card: Splines,
    /// Chains of cylinders, one per rope: those of the back head, then those of the front head.
    pub(crate) chains: Vec<Chain>,
    pub(crate) strands: Vec<ParallelRope>,
    /// Elastic response of the back head (mode shapes, stress influence lines) for each back rope.
    pub(crate) faces: Vec<HeadResponse>,
    pub(crate) extensions: Extensions,
    /// Effects of the machine, and the curves of the ideal mechanism that they refer to; `None` without
    /// effects.
    effects: Option<(Vec<std::sync::Arc<dyn Effect>>, Cycle)>,
}

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Machine {
    /// Checks a machine description and derives the constants of the model.
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

    /// Builds a machine as [`Self::new`] does, with effects. The turn angle is zero at the bottom dead centre
    /// of the machine without effects, because the crank is marked there.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_effects(
        description: Description,
        modes: usize,
        effects: &[std::sync::Arc<dyn Effect>],
    ) -> Result<Self, InvalidDescription> {
        if effects.is_empty() {
            return Self::new(description, modes);
        }
        check(&description, modes)?;
        let marked = Mechanism::of(&description).bottom_dead_centre()?;
        let lowest = lowest_suspension(&description, &marked);
        let (mut edited, mut kept) = (description, modes);
        for effect in effects {
            effect.describe(&mut edited, &mut kept);
        }
        check(&edited, kept)?;
        let mechanism = Mechanism::of(&edited);
        let bottom = mechanism.position(marked.pin, marked.beam, marked.tangent)?;
        let cycle = Cycle::new(&edited, &mechanism, &bottom)?;
        let mut machine = Self::assemble(edited, kept, bottom, lowest);
        machine.effects = Some((effects.to_vec(), cycle));
        machine.install_effects();
        Ok(machine)
    }

    /// Installs the extensions of the effects again, because they hold coordinate indices that a change of
    /// the layout invalidates.
    fn install_effects(&mut self) {
        let mut extensions = Extensions::default();
        if let Some((effects, cycle)) = &self.effects {
            let site = self.site(cycle);
            for effect in effects {
                effect.install(&site, &mut extensions);
            }
        }
        self.extensions = extensions;
    }

    /// Returns the extensions (forces, laws, readings) that an effect would add to the machine, without adding
    /// them.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub(crate) fn pieces_of(&self, effect: &dyn Effect) -> Result<Extensions, InvalidDescription> {
        let d = &self.description;
        let own = match &self.effects {
            Some((_, cycle)) => cycle.clone(),
            None => Cycle::new(d, &Mechanism::of(d), &self.bottom)?,
        };
        let mut extensions = Extensions::default();
        effect.install(&self.site(&own), &mut extensions);
        Ok(extensions)
    }

    fn site<'a>(&'a self, cycle: &'a Cycle) -> Site<'a> {
        Site {
            description: &self.description,
            layout: self.layout,
            cycle,
            bottom: self.bottom,
            lowest_suspension: self.lowest_suspension,
            card: &self.card,
            faces: &self.faces,
        }
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
        let chain = |(k, strand): (usize, &ParallelRope)| {
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
            extensions: Extensions::default(),
            effects: None,
            description,
        }
    }

    /// Converts the machine to six coordinates per cylinder.
    ///
    /// [`Self::new`] uses three, because a symmetric machine stays in its plane; the conversion serves to
    /// verify this.
    #[must_use]
    pub fn in_space(mut self) -> Self {
        self.layout.motion = Motion::Space;
        for chain in &mut self.chains {
            chain.motion = Motion::Space;
        }
        self.install_effects();
        self
    }

    /// Returns the share of one rope in the stiffnesses, damping and masses that a description states for all
    /// ropes on a head: 1 for a single rope, 0.5 for twin ropes.
    pub(crate) fn rope_share(&self) -> f64 {
        1.0 / self.layout.ropes as f64
    }

    /// Returns a chain on the back head (0) or on the front head (1).
    pub(crate) fn chain_on(&self, rope: usize) -> &Chain {
        &self.chains[if rope == BACK { 0 } else { self.layout.ropes }]
    }

    /// Returns the coefficients of an individual's ropes, scaled to the cylinder length and, for twin ropes,
    /// to one of the two.
    pub fn ropes(&self, law: &RopeLaw) -> Ropes {
        Ropes::new(law, &self.description.rope, self.layout.ropes)
    }
}

/// Appends the out-of-plane head modes to the in-plane modes that are kept, and returns the number of
/// out-of-plane modes.
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
