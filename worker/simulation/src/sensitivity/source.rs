//! How `dR/dp` of a column comes about at a stage, at the state as it is.
//!
//! Closed: coefficients of the ropes, in which forces are linear, and generic forces, which are linear in
//! their amplitude. Differenced: those terms of the residual in which a machine beside differs.
use super::differences::Difference;
use super::side::Side;
use crate::effect::Place;
use crate::element::impact::By;
use crate::element::plane::PLANE_UNITS;
use crate::model::description::{Arc, Head};
use crate::model::forces::Terms;
use crate::model::hook::Hooks;
use crate::model::{Individual, Machine};
use crate::system::State;

/// How `dR/dp` comes about.
#[derive(Clone, Debug)]
pub(super) enum Source<'a> {
    /// What the joints of ropes say that have a coefficient of 1 and no other.
    Joints(Box<Joints<'a>>),
    /// Times a factor, the contact's derivative by its stiffness, or by its damping.
    Contact {
        /// By stiffness or by damping.
        by: By,
        /// The factor.
        factor: f64,
    },
    /// What pieces of amplitude 1 say.
    Pieces(&'a Hooks),
    /// A difference between machines: of so many terms, of inertia or not, and the contact's derivative by
    /// the radius of the front head times that of the radius.
    Difference(Terms, bool, Option<f64>),
    /// The motion does not know of the parameter.
    Nothing,
}

/// Ropes that have a coefficient of 1 and no other.
#[derive(Clone, Debug)]
pub(super) struct Joints<'a> {
    pub(super) unit: Side<'a>,
    /// What their forces are times.
    pub(super) factor: f64,
    /// In the plane, which of the units that are at hand the joints between cylinders are times what;
    /// none where the coefficient turns nothing there.
    pub(super) inner: Option<(usize, f64)>,
}

/// What a machine beside differs in.
#[derive(Clone, Copy, Debug)]
pub(super) struct Differing {
    /// Terms of its forces, and whether its inertia.
    pub(super) terms: Option<(Terms, bool)>,
    /// Whether the arc of the front head has another radius, and is the same otherwise.
    pub(super) raised: bool,
    /// Whether its head answers a given state with another stress, or another time belongs to a sample.
    pub(super) stress: bool,
}

impl Differing {
    /// What a machine beside differs in, by an effect that changes this of the model.
    pub(super) fn between(own: &Machine, beside: &Machine, place: Place) -> Self {
        let (d, o) = (&own.description, &beside.description);
        let arcs = d.front_arc != o.front_arc || d.back_arc != o.back_arc;
        // damping of the modes acts on the modes alone
        let head = Head {
            damping_ratio: d.head.damping_ratio,
            ..o.head.clone()
        };
        let head = d.head != head;
        let built = arcs || d.rod != o.rod || head || d.twins != o.twins;
        let any = |has: fn(&Hooks) -> bool| has(&own.hooks) || has(&beside.hooks);
        let driven = place == Place::Drive || any(Hooks::has_warps);
        let both = d.twins != o.twins || d.rope != o.rope;
        let back = d.back_arc != o.back_arc || head || !own.hooks.digs_as(&beside.hooks);
        let moved = Arc {
            radius: d.front_arc.radius,
            ..o.front_arc
        };
        let front = d.front_arc != moved || both;
        let contact = [back || both, front];
        let joints = d.rope != o.rope;
        let terms = Terms {
            rigid: true,
            weights: d.rope != o.rope,
            ends: built || driven,
            joints,
            pulls: any(Hooks::has_axial) && !joints,
            contact,
        };
        let touching = contact.contains(&true);
        let inertia =
            built || d.beam_inertia.to_bits() != o.beam_inertia.to_bits() || d.rope != o.rope;
        let still = place == Place::Gauge && !built && !joints && !terms.pulls && !touching;
        Self {
            terms: (!still).then_some((terms, inertia)),
            raised: !front && d.front_arc != o.front_arc,
            stress: back || both || driven,
        }
    }
}

/// Forces of the ropes alone.
pub(super) const ROPES: Terms = Terms {
    ends: true,
    joints: true,
    contact: [true; 2],
    ..Terms::NONE
};

impl Source<'_> {
    /// `dR/dp` into `sum`, at a state whose poses and points of contact `individual` has; `units` are
    /// those of [`Individual::joint_units`], or none in space.
    pub(super) fn right(
        &mut self,
        individual: &mut Individual<'_>,
        (state, units): (&State, &[[f64; PLANE_UNITS]]),
        (own, sides, difference): (&mut Side<'_>, &mut [Side<'_>], &Difference),
        [one, sum]: [&mut [f64]; 2],
    ) {
        let at = state.motion();
        let scale = |sum: &mut [f64], factor: f64| {
            for x in sum {
                *x *= factor;
            }
        };
        match self {
            Self::Joints(joints) => {
                let Joints {
                    unit,
                    factor,
                    inner,
                } = &mut **joints;
                let terms = Terms {
                    contact: [false; 2],
                    joints: units.is_empty(),
                    ..ROPES
                };
                unit.residual(&mut individual.scratch, state, (terms, false), sum);
                if let Some((which, times)) = *inner {
                    for (sum, units) in sum.iter_mut().zip(units) {
                        *sum += times * units[which];
                    }
                }
                scale(sum, *factor);
            }
            Self::Contact { by, factor } => {
                individual.contact_by(at, (*by, [true; 2]), sum);
                scale(sum, *factor);
            }
            Self::Pieces(hooks) => individual.forces_of(hooks, at, units, sum),
            Self::Difference(terms, inertia, raised) => {
                sum.fill(0.0);
                let asked = (*terms, *inertia);
                let scratch = &mut individual.scratch;
                if difference.own != 0.0 {
                    own.residual(scratch, state, asked, one);
                    add(sum, difference.own, one);
                }
                for (side, weight) in sides.iter_mut().zip(difference.weights) {
                    side.residual(scratch, state, asked, one);
                    add(sum, weight, one);
                }
                if let Some(factor) = raised {
                    individual.contact_by(at, (By::Penetration, [false, true]), one);
                    add(sum, *factor, one);
                }
            }
            Self::Nothing => sum.fill(0.0),
        }
    }
}

pub(super) fn add(to: &mut [f64], weight: f64, x: &[f64]) {
    for (to, x) in to.iter_mut().zip(x) {
        *to += weight * x;
    }
}
