//! Unknowns of the case that are off, that is at a value where they have no effect. They are held there in
//! every fit and tested like effects of the library: an unknown by its own name with one size, or several
//! unknowns together.
use protocol::announce::{EffectDescriptor, ParameterDescriptor, Place, Role, Sign};
use protocol::case::Unknown;

/// Typical size at which a switched-off unknown is tested, as a share of the larger part of its interval
/// beside the absent value.
const SHARE: f64 = 0.25;

/// Unknowns that are off and are tested together as one candidate effect.
#[derive(Clone, Debug, PartialEq)]
pub struct InactiveUnknowns {
    /// Indices of the unknowns in the case, in the order of the candidate effect's parameters.
    pub positions: Vec<usize>,
    /// Candidate effect that stands for these unknowns.
    pub candidate: EffectDescriptor,
}

impl InactiveUnknowns {
    /// Collects the switched-off unknowns of a case, grouped by the candidate effect that they form.
    pub fn of(unknowns: &[Unknown]) -> Vec<Self> {
        let mut all: Vec<Self> = Vec::new();
        for (position, unknown) in unknowns.iter().enumerate() {
            let Some(parameter) = parameter(unknown) else {
                continue;
            };
            let id = unknown.suspect.as_ref().unwrap_or(&unknown.name);
            if let Some(own) = all.iter_mut().find(|own| own.candidate.id == *id) {
                own.positions.push(position);
                own.candidate.parameters.push(parameter);
                // alone its title was that of the first
                own.candidate.title.clone_from(id);
                continue;
            }
            all.push(Self {
                positions: vec![position],
                candidate: EffectDescriptor {
                    id: id.clone(),
                    title: unknown.title.clone(),
                    joint: String::new(),
                    place: Place::Dynamics,
                    generic: false,
                    parameters: vec![parameter],
                },
            });
        }
        all
    }
}

/// Describes an unknown as a size of a candidate effect; `None` for an unknown that is on, fixed, or tied to
/// another one.
fn parameter(unknown: &Unknown) -> Option<ParameterDescriptor> {
    let absent = unknown
        .absent
        .filter(|_| unknown.is_off() && !unknown.fixed && unknown.tie.is_none())?;
    let (above, below) = (unknown.upper - absent, absent - unknown.lower);
    let scale = SHARE * above.max(below);
    Some(ParameterDescriptor {
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
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::case::Scale;

    #[test]
    fn unknowns_of_one_suspect_act_together() {
        let off = |name: &str, suspect: Option<&str>| Unknown {
            absent: Some(0.0),
            suspect: suspect.map(str::to_owned),
            ..Unknown::new(name, "N", Scale::Linear, 0.0, [-1.0, 1.0])
        };
        let on = Unknown::new("k", "N/mm", Scale::Logarithmic, 1.0, [0.1, 10.0]);
        let all = [
            off("cosine", Some("unbalance")),
            on,
            off("friction", None),
            off("sine", Some("unbalance")),
        ];
        let found = InactiveUnknowns::of(&all);
        let shown: Vec<(&str, &[usize])> = found
            .iter()
            .map(|off| (off.candidate.id.as_str(), &off.positions[..]))
            .collect();
        assert_eq!(shown, [("unbalance", &[0, 3][..]), ("friction", &[2])]);
        let names = found[0]
            .candidate
            .parameters
            .iter()
            .map(|p| p.name.as_str());
        assert_eq!(names.collect::<Vec<_>>(), ["cosine", "sine"]);
    }
}
