//! Stiffness and damping coefficients of all ropes of an individual, linear in the searched coefficients.
use crate::element::{bushing::Bushing, impact::Impact};
use crate::model::description::{Rope, RopeLaw};

/// Stiffness and damping coefficients of an individual's ropes, scaled to the cylinder length and, for twin
/// ropes, to one of the two.
#[derive(Clone, Copy, Debug)]
pub struct Ropes {
    /// Law of the joint between two cylinders.
    pub joint: Bushing,
    /// Law of the joint between crossbeam or suspension and the first cylinder.
    pub base: Bushing,
    /// Law of the joint between the last cylinder and the head.
    pub anchor: Bushing,
    /// Law of the contact between a cylinder and a head.
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
