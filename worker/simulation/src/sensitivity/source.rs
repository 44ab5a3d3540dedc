//! Right-hand side `dR/dp` of a column at a stage: derivative of the residual with respect to the column's
//! parameter at a fixed state.
//!
//! Closed form: coefficients of the ropes, in which forces are linear, and generic forces, which are linear
//! in their amplitude. Finite differences: those terms of the residual in which the perturbed machine
//! differs.
use super::differences::Difference;
use super::perturbed::PerturbedModel;
use crate::effect::Place;
use crate::element::impact::DerivativeVariable;
use crate::linear::Lanes;
use crate::math::vector::add_scaled;
use crate::model::chain::unit_loads::UnitLoads;
use crate::model::description::{Arc, Head};
use crate::model::extension::Extensions;
use crate::model::forces::Terms;
use crate::model::{Machine, RopeMachine};
use crate::system::State;

/// Method of computing the right-hand side `dR/dp` of a column.
#[derive(Clone, Debug)]
pub(super) enum Source<'a> {
    /// Forces of rope joints with one coefficient equal to 1 and all others zero.
    Joints(Box<Joints<'a>>),
    /// Derivative of the contact forces with respect to contact stiffness or damping, times a factor.
    Contact {
        /// Contact coefficient: stiffness or damping.
        by: DerivativeVariable,
        /// Factor that converts to the derivative with respect to the decimal logarithm of the contact
        /// coefficient.
        factor: f64,
    },
    /// Generalised forces of an effect's extensions at amplitude 1.
    Pieces(&'a Extensions),
    /// Difference of residuals between perturbed machines: force terms to evaluate, whether inertia is
    /// included, and the derivative of the front head's radius with respect to the parameter, by which the
    /// contact forces are differentiated in closed form.
    Difference(Terms, bool, Option<f64>),
    /// Zero right-hand side, because the parameter does not influence the motion.
    Nothing,
}

/// Ropes in which one joint coefficient is 1 and all others are zero.
#[derive(Clone, Debug)]
pub(super) struct Joints<'a> {
    pub(super) unit: PerturbedModel<'a>,
    /// Factor that converts the forces at coefficient 1 into the derivative with respect to the coefficient's
    /// decimal logarithm.
    pub(super) factor: f64,
    /// Index of the unit joint force and its factor for the joints between cylinders, for motion in the
    /// plane; `None` if the coefficient has no effect in the plane.
    pub(super) inner: Option<(usize, f64)>,
}

/// Differences between a perturbed machine and the simulated one, which decide what must be evaluated.
#[derive(Clone, Copy, Debug)]
pub(super) struct ChangedTerms {
    /// Force terms that differ, and whether the inertia differs; `None` if both machines move alike.
    pub(super) terms: Option<(Terms, bool)>,
    /// Whether the front heads of the two machines differ in the radius of their arc and in nothing else.
    pub(super) front_radius: bool,
    /// Whether the machines differ in the gauge stress at a given state, in the time of a sample, or in the measuring
    /// chain.
    pub(super) reading: bool,
}

impl ChangedTerms {
    /// Determines the differences between two machines; `place` is the part of the model that the varied
    /// effect changes, and `axial` states whether the effect has axial laws of its own.
    pub(super) fn between(own: &Machine, beside: &Machine, (place, axial): (Place, bool)) -> Self {
        let (d, o) = (&own.description, &beside.description);
        let arcs = d.front_arc != o.front_arc || d.back_arc != o.back_arc;
        // damping of the modes acts on the modes alone
        let head = Head {
            damping_ratio: d.head.damping_ratio,
            ..o.head.clone()
        };
        let head = d.head != head;
        let built = arcs || d.rod != o.rod || head || d.twins != o.twins;
        let any = |has: fn(&Extensions) -> bool| has(&own.extensions) || has(&beside.extensions);
        let driven = place == Place::Drive || any(Extensions::has_warps);
        let both = d.twins != o.twins || d.rope != o.rope;
        let back = d.back_arc != o.back_arc
            || head
            || !own.extensions.has_same_profile(&beside.extensions);
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
            pulls: any(Extensions::has_axial) && (axial || driven || both) && !joints,
            contact,
        };
        let touching = contact.contains(&true);
        let inertia =
            built || d.beam_inertia.to_bits() != o.beam_inertia.to_bits() || d.rope != o.rope;
        let still = place == Place::Gauge && !built && !joints && !terms.pulls && !touching;
        Self {
            terms: (!still).then_some((terms, inertia)),
            front_radius: !front && d.front_arc != o.front_arc,
            reading: back || both || driven || place == Place::Gauge,
        }
    }
}

impl Joints<'_> {
    /// Adds `dR/dp` to one of the lanes of `right`, for motion in the plane; returns false, and adds nothing, in
    /// space, where `units` is empty.
    pub(super) fn add_unit_forces(
        &self,
        individual: &mut RopeMachine<'_>,
        (state, units): (&State, &[UnitLoads]),
        (right, lane): (&mut [Lanes], usize),
    ) -> bool {
        let unit = (self.unit.ropes(), self.inner);
        let units = (units, self.factor);
        individual.add_unit_forces(state.motion(), unit, units, right, |x| &mut x.0[lane]);
        !units.0.is_empty()
    }
}

/// Selection of the force terms that depend on the ropes' coefficients: joints and contact.
pub(super) const ROPES: Terms = Terms {
    ends: true,
    joints: true,
    contact: [true; 2],
    ..Terms::NONE
};

impl Source<'_> {
    /// Computes `dR/dp` into `sum`, at a state whose cylinder poses and contact points `individual` holds;
    /// `units` are the result of [`RopeMachine::unit_loads`], empty in space.
    pub(super) fn right_hand_side(
        &mut self,
        individual: &mut RopeMachine<'_>,
        (state, units): (&State, &[UnitLoads]),
        (own, sides, difference): (
            &mut PerturbedModel<'_>,
            &mut [PerturbedModel<'_>],
            &Difference,
        ),
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
                let terms = Terms {
                    contact: [false; 2],
                    ..ROPES
                };
                let unit = &mut joints.unit;
                unit.residual(&mut individual.scratch, state, (terms, false), sum);
                scale(sum, joints.factor);
            }
            Self::Contact { by, factor } => {
                individual.contact_by(at, (*by, [true; 2]), sum);
                scale(sum, *factor);
            }
            Self::Pieces(extensions) => individual.forces_of(extensions, at, units, sum),
            Self::Difference(terms, inertia, raised) => {
                sum.fill(0.0);
                let asked = (*terms, *inertia);
                let scratch = &mut individual.scratch;
                if difference.own != 0.0 {
                    own.residual(scratch, state, asked, one);
                    add_scaled(sum, difference.own, one);
                }
                for (side, weight) in sides.iter_mut().zip(difference.weights) {
                    side.residual(scratch, state, asked, one);
                    add_scaled(sum, weight, one);
                }
                if let Some(factor) = raised {
                    individual.contact_by(
                        at,
                        (DerivativeVariable::Penetration, [false, true]),
                        one,
                    );
                    add_scaled(sum, *factor, one);
                }
            }
            Self::Nothing => sum.fill(0.0),
        }
    }
}
