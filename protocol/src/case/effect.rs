//! Effects that a case adds to its machine: ordinary physics, named and sized.
//!
//! What effects there are, and what their numbers mean, is a model's business: it comes in a
//! worker's announcement ([`crate::announce::EffectDescriptor`]). Here they are names and numbers.
use serde::{Deserialize, Serialize};

/// One effect with its numbers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct EffectSetting {
    /// Fixed identifier, as `pivot_friction`.
    pub id: String,
    /// Names and values, in the units that the effect declares. What is not named keeps the value
    /// that the model gives it: absent for a size, typical for a shape.
    pub parameters: Vec<(String, f64)>,
}

impl EffectSetting {
    /// An effect with its numbers.
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

/// The effects of a case with those of a job added: an effect that both name is the job's.
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
