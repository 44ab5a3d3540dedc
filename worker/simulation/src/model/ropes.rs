//! Every rope of one individual: where its searched coefficients enter, linearly throughout.
use crate::element::{bushing::Bushing, impact::Impact};
use crate::model::description::{Rope, RopeLaw};

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

impl Ropes {
    /// Scales an individual's coefficients to a rope's pitch, so that the rope stays the same, and to
    /// one of so many ropes on a head.
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

    /// Ropes of a joint between two cylinders and of a contact; the joints at their ends follow.
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
