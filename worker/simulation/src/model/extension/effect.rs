//! Interface of an effect: editing the description of a machine, or adding extensions to the machine.
use super::set::Extensions;
use crate::math::spline::Splines;
use crate::model::cycle::Cycle;
use crate::model::description::Description;
use crate::model::kinematics::Position;
use crate::model::layout::Layout;
use crate::model::parallel_ropes::HeadResponse;
use std::fmt::Debug;

/// Effect (optional physical phenomenon added to the model) with its parameter values.
pub trait Effect: Debug + Send + Sync {
    /// Edits the description before the machine is built (geometry, inertia, samples of the card) and the
    /// number `modes` of head modes that are kept.
    fn describe(&self, _description: &mut Description, _modes: &mut usize) {}

    /// Adds the extensions of the effect (forces, laws, readings) to the built machine.
    fn install(&self, _site: &Site<'_>, _extensions: &mut Extensions) {}
}

/// Properties of a machine that an effect may read while it adds its extensions.
#[derive(Clone, Copy, Debug)]
pub struct Site<'a> {
    /// Description that the machine was built from, including the edits of effects.
    pub description: &'a Description,
    /// Indices of the machine's coordinates.
    pub layout: Layout,
    /// Beam angle and other curves of the machine's inextensible mechanism over one turn.
    pub cycle: &'a Cycle,
    /// Bottom dead centre of the inextensible mechanism, where the turn angle is zero.
    pub bottom: Position,
    /// Height in the world frame W of the suspension point at its lowest design position \[m\].
    pub lowest_suspension: f64,
    /// Load card: load at the suspension point as a function of the turn angle \[N\].
    pub card: &'a Splines,
    /// Elastic response of the back head (mode shapes, stress influence lines) for each back rope.
    pub(crate) faces: &'a [HeadResponse],
}
