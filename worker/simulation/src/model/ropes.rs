//! Coefficients of all ropes of an individual, in which the searched coefficients enter linearly.
use crate::element::{bushing::Bushing, impact::Impact};
use crate::model::description::{Rope, RopeLaw};

/// Coefficients of all ropes of an individual, scaled to the pitch of the chain and to the share of one of
/// the ropes on a head.
#[derive(Clone, Copy, Debug)]
pub struct Ropes {
    /// Joint between two cylinders.
    pub joint: Bushing,
    /// Joint between crossbeam or suspension and the first cylinder.
    pub base: Bushing,
    /// Joint between the last cylinder and the head.
    pub anchor: Bushing,
    /// Contact between a cylinder and a head.
    pub contact: Impact,
}

impl Ropes {
    /// Scales an individual's coefficients to the pitch of a rope, so that the stiffness per length is
    /// unchanged, and to one of `ropes` ropes on a head.
    pub fn new(law: &RopeLaw, rope: &Rope, ropes: usize) -> Self {
        let per_length = rope.reference_pitch / rope.pitch;
        let share = 1.0 / ropes as f64;
        let mut joint = law.bushing.scaled(per_length).scaled(share);
        joint.preload *= share;
        let contact = Impact {
            stiffness: law.contact.stiffness / per_length * share,
            damping: law.contact.damping / per_length * share,
            ..law.contact
        };
        Self::of(joint, contact, rope, ropes)
    }

    /// Builds the coefficients of all ropes from the laws of a joint between two cylinders and of a contact;
    /// the laws of the end joints are derived from the inner joint.
    pub(crate) fn of(joint: Bushing, contact: Impact, rope: &Rope, ropes: usize) -> Self {
        let anchor = joint.scaled(1.0 / rope.end_pitches);
        Self {
            joint,
            base: if ropes > 1 {
                anchor.pinned()
            } else {
                anchor.revolute()
            },
            anchor,
            contact,
        }
    }
}
