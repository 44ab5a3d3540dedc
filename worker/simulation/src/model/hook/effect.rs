//! What an effect is to the machine: something that edits its description, or hangs pieces on it.
use super::set::Hooks;
use crate::math::spline::Splines;
use crate::model::cycle::Cycle;
use crate::model::description::Description;
use crate::model::kinematics::Position;
use crate::model::layout::Layout;
use crate::model::strand::Face;
use std::fmt::Debug;

/// An effect with its values.
pub trait Effect: Debug + Send + Sync {
    /// Edits the machine before it is built: geometry, inertia, samples of the card; `modes` is the
    /// number of head modes that are kept.
    fn describe(&self, _description: &mut Description, _modes: &mut usize) {}

    /// Hangs pieces on the built machine.
    fn install(&self, _site: &Site<'_>, _hooks: &mut Hooks) {}
}

/// What an effect sees of the machine that it is installed on.
#[derive(Clone, Copy, Debug)]
pub struct Site<'a> {
    /// What the machine was made from, as the effects have edited it.
    pub description: &'a Description,
    /// Where its coordinates live.
    pub layout: Layout,
    /// One turn of its ideal mechanism.
    pub cycle: &'a Cycle,
    /// Bottom dead centre of the inextensible mechanism: where the turn angle is zero.
    pub bottom: Position,
    /// Height in W of the suspension point's lowest design position \[m\].
    pub lowest_suspension: f64,
    /// Load over the turn \[N\].
    pub card: &'a Splines,
    /// The back head as each back rope sees it.
    pub(crate) faces: &'a [Face],
}
