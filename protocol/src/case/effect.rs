//! Effects that a case adds to its machine, each a named physical effect with parameter values.
//!
//! The available effects and the meaning of their parameters are defined by the model and described in a
//! worker's announcement ([`crate::announce::EffectDescriptor`]). This module holds only names and numbers.
use serde::{Deserialize, Serialize};

/// Effect that a case or a job adds to the machine, with its parameter values.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct EffectSetting {
    /// Fixed identifier of the effect, e.g. `pivot_friction`.
    pub id: String,
    /// Names and values of the effect's parameters, in the units declared by the effect. A parameter not
    /// listed keeps the model's default: for a size parameter the value at which the effect vanishes, for a
    /// shape parameter its typical value.
    pub parameters: Vec<(String, f64)>,
}

impl EffectSetting {
    /// Creates an effect from its identifier and parameter values.
    pub fn new(id: &str, parameters: &[(&str, f64)]) -> Self {
        Self {
            id: id.to_owned(),
            parameters: parameters
                .iter()
                .map(|&(name, value)| (name.to_owned(), value))
                .collect(),
        }
    }
}

/// Combines the effects of a case with those of a job; an effect named by both is taken from the job.
pub fn merged(case: &[EffectSetting], job: &[EffectSetting]) -> Vec<EffectSetting> {
    let kept = case
        .iter()
        .filter(|own| job.iter().all(|other| other.id != own.id));
    kept.chain(job).cloned().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_effect_of_the_job_replaces_that_of_the_case_whole() {
        let case = [
            EffectSetting::new("a", &[("x", 1.0), ("y", 2.0)]),
            EffectSetting::new("b", &[("x", 3.0)]),
        ];
        let job = [
            EffectSetting::new("c", &[]),
            EffectSetting::new("a", &[("x", 9.0)]),
        ];
        let all = merged(&case, &job);
        assert_eq!(all, [case[1].clone(), job[0].clone(), job[1].clone()]);
        assert_eq!(merged(&case, &[]), case);
    }
}
