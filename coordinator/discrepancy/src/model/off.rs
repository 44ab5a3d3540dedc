//! Unknowns of the case that stand where they do nothing: held there in every fit, and suspected like the
//! effects of the library, by their own name and with one size.
use protocol::announce::{EffectDescriptor, ParameterDescriptor, Place, Role, Sign};
use protocol::case::Unknown;

/// How large an unknown of which the case says nothing more commonly is, over its interval.
const SHARE: f64 = 0.25;

/// An unknown that is off.
#[derive(Clone, Debug, PartialEq)]
pub struct Off {
    /// Its place in the case.
    pub position: usize,
    /// What is suspected.
    pub suspect: EffectDescriptor,
}

impl Off {
    /// Those of a case.
    pub fn of(unknowns: &[Unknown]) -> Vec<Self> {
        let unknowns = unknowns.iter().enumerate();
        unknowns
            .filter_map(|(position, unknown)| Self::new(position, unknown))
            .collect()
    }

    /// Nothing for one that is on, fixed, or follows another.
    fn new(position: usize, unknown: &Unknown) -> Option<Self> {
        let absent = unknown
            .absent
            .filter(|_| unknown.is_off() && !unknown.fixed)?;
        if unknown.tie.is_some() {
            return None;
        }
        let (above, below) = (unknown.upper - absent, absent - unknown.lower);
        let scale = SHARE * above.max(below);
        let parameter = ParameterDescriptor {
            name: unknown.name.clone(),
            unit: unknown.unit.clone(),
            role: Role::Size,
            sign: if below > 0.0 {
                Sign::Either
            } else {
                Sign::Positive
            },
            lower: unknown.lower,
            upper: unknown.upper,
            absent,
            typical: if above >= below {
                absent + scale
            } else {
                absent - scale
            },
            scale,
        };
        let suspect = EffectDescriptor {
            id: unknown.name.clone(),
            title: unknown.title.clone(),
            joint: String::new(),
            place: Place::Dynamics,
            generic: false,
            parameters: vec![parameter],
        };
        Some(Self { position, suspect })
    }
}
