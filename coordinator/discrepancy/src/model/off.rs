//! Unknowns of the case that stand where they do nothing: held there in every fit, and suspected like the
//! effects of the library, by their own name with one size, or several of them together.
use protocol::announce::{EffectDescriptor, ParameterDescriptor, Place, Role, Sign};
use protocol::case::Unknown;

/// How large an unknown of which the case says nothing more commonly is, over its interval.
const SHARE: f64 = 0.25;

/// Unknowns that are off, and suspected together.
#[derive(Clone, Debug, PartialEq)]
pub struct Off {
    /// Their places in the case, in the order of the suspect's parameters.
    pub positions: Vec<usize>,
    /// What is suspected.
    pub suspect: EffectDescriptor,
}

impl Off {
    /// Those of a case.
    pub fn of(unknowns: &[Unknown]) -> Vec<Self> {
        let mut all: Vec<Self> = Vec::new();
        for (position, unknown) in unknowns.iter().enumerate() {
            let Some(parameter) = parameter(unknown) else {
                continue;
            };
            let id = unknown.suspect.as_ref().unwrap_or(&unknown.name);
            if let Some(own) = all.iter_mut().find(|own| own.suspect.id == *id) {
                own.positions.push(position);
                own.suspect.parameters.push(parameter);
                // alone its title was that of the first
                own.suspect.title.clone_from(id);
                continue;
            }
            all.push(Self {
                positions: vec![position],
                suspect: EffectDescriptor {
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

/// An unknown as the size of a suspect; nothing of one that is on, fixed, or follows another.
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
        let found = Off::of(&all);
        let shown: Vec<(&str, &[usize])> = found
            .iter()
            .map(|off| (off.suspect.id.as_str(), &off.positions[..]))
            .collect();
        assert_eq!(shown, [("unbalance", &[0, 3][..]), ("friction", &[2])]);
        let names = found[0].suspect.parameters.iter().map(|p| p.name.as_str());
        assert_eq!(names.collect::<Vec<_>>(), ["cosine", "sine"]);
    }
}
