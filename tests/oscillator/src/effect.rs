//! Effects that may be added to the oscillator with its springs and dampers, each with an exact solution.
//!
//! This module describes the effects and reads their parameters from a case or a job; [`crate::simulate`]
//! applies them to the motion.
use protocol::announce::{EffectDescriptor, ParameterDescriptor, Place, Role, Sign};
use protocol::case::EffectSetting;

/// Parameters of all effects, zero where an effect is absent.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Effects {
    /// Dry friction force of the guide \[N\].
    pub friction_n: f64,
    /// Cosine and sine coefficient of the second harmonic of the driving force \[N\].
    pub second_order_n: [f64; 2],
    /// Cosine and sine coefficient of the first harmonic of the foundation's motion \[mm\].
    pub base_mm: [f64; 2],
    /// Time constant of the force sensor \[ms\].
    pub lag_ms: f64,
}

/// Parameter of an effect in `TABLE`: name, unit, sign, greatest value, typical value.
type Number = (&'static str, &'static str, Sign, f64, f64);

/// Effect in `TABLE`: identifier, title, part of the test rig on which it acts, place in the simulation, and
/// parameters.
type Row = (
    &'static str,
    &'static str,
    &'static str,
    Place,
    &'static [Number],
);

const TABLE: [Row; 4] = [
    (
        "dry_friction",
        "dry friction of the guide",
        "guide",
        Place::Dynamics,
        &[("force", "N", Sign::Positive, 20.0, 1.0)],
    ),
    (
        "second_order",
        "a second order in the shaker's force",
        "shaker",
        Place::Drive,
        &[
            ("cosine", "N", Sign::Either, 20.0, 1.0),
            ("sine", "N", Sign::Either, 20.0, 1.0),
        ],
    ),
    (
        "base_motion",
        "a foundation that moves with the shaker",
        "foundation",
        Place::Dynamics,
        &[
            ("cosine", "mm", Sign::Either, 2.0, 0.05),
            ("sine", "mm", Sign::Either, 2.0, 0.05),
        ],
    ),
    (
        "force_lag",
        "a slow force sensor",
        "force_sensor",
        Place::Sensor,
        &[("time", "ms", Sign::Positive, 20.0, 1.0)],
    ),
];

/// Returns the descriptors of the effects that the model can add to the oscillator.
pub fn descriptors() -> Vec<EffectDescriptor> {
    let number = |&(name, unit, sign, greatest, typical): &Number| ParameterDescriptor {
        name: name.to_owned(),
        unit: unit.to_owned(),
        role: Role::Size,
        sign,
        lower: if sign == Sign::Positive {
            0.0
        } else {
            -greatest
        },
        upper: greatest,
        absent: 0.0,
        typical,
        scale: typical,
    };
    let row = |&(id, title, joint, place, numbers): &Row| EffectDescriptor {
        id: id.to_owned(),
        title: title.to_owned(),
        joint: joint.to_owned(),
        place,
        generic: false,
        parameters: numbers.iter().map(number).collect(),
    };
    TABLE.iter().map(row).collect()
}

/// Returns the unit of a parameter, by the identifier of its effect; `None` if there is no such parameter.
pub fn unit(id: &str, parameter: &str) -> Option<&'static str> {
    let row = TABLE.iter().find(|row| row.0 == id)?;
    let number = row.4.iter().find(|number| number.0 == parameter)?;
    Some(number.1)
}

impl Effects {
    /// Reads the parameters of all effects from the settings of a case or a job.
    ///
    /// # Errors
    /// The first field that the model does not have, or that is beyond its bounds, and the reason.
    pub fn read(settings: &[EffectSetting]) -> Result<Self, (String, String)> {
        let mut all = Self::default();
        for setting in settings {
            for (name, value) in &setting.parameters {
                let field = format!("{}.{name}", setting.id);
                let refused = |why: String| (field.clone(), why);
                let slot = all.slot(&setting.id, name);
                let slot = slot.ok_or_else(|| {
                    refused("the oscillator has no such effect parameter".to_owned())
                })?;
                let row = TABLE.iter().find(|row| row.0 == setting.id);
                let numbers = row.map_or(&[][..], |row| row.4);
                let bound = numbers.iter().find(|number| number.0 == name);
                let bound = bound.map_or(0.0, |&(_, _, sign, greatest, _)| {
                    if sign == Sign::Positive && *value < 0.0 {
                        0.0
                    } else {
                        greatest
                    }
                });
                if value.is_nan() || value.abs() > bound {
                    return Err(refused(format!(
                        "is {value}, but its magnitude must be at most {bound}"
                    )));
                }
                *slot = *value;
            }
        }
        Ok(all)
    }

    fn slot(&mut self, id: &str, parameter: &str) -> Option<&mut f64> {
        let [cosine, sine] = &mut self.second_order_n;
        let [base_cosine, base_sine] = &mut self.base_mm;
        match (id, parameter) {
            ("dry_friction", "force") => Some(&mut self.friction_n),
            ("second_order", "cosine") => Some(cosine),
            ("second_order", "sine") => Some(sine),
            ("base_motion", "cosine") => Some(base_cosine),
            ("base_motion", "sine") => Some(base_sine),
            ("force_lag", "time") => Some(&mut self.lag_ms),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_that_is_described_has_its_place() {
        for effect in descriptors() {
            for parameter in &effect.parameters {
                let read = |value| {
                    let one = EffectSetting::new(&effect.id, &[(parameter.name.as_str(), value)]);
                    Effects::read(&[one])
                };
                assert_ne!(read(parameter.typical).unwrap(), Effects::default());
                assert_eq!(read(parameter.absent).unwrap(), Effects::default());
                read(1.01 * parameter.upper).unwrap_err();
                assert_eq!(
                    read(-parameter.typical).is_err(),
                    parameter.sign == Sign::Positive
                );
                assert_eq!(
                    unit(&effect.id, &parameter.name),
                    Some(parameter.unit.as_str())
                );
            }
        }
        let (field, _) =
            Effects::read(&[EffectSetting::new("wear", &[("depth", 1.0)])]).unwrap_err();
        assert_eq!(
            (field.as_str(), unit("wear", "depth")),
            ("wear.depth", None)
        );
    }
}
