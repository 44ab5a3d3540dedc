//! Conditions that an objective sums over, as a case file names them: one name, or a list of names, of which
//! all but the first may have a weight.
use crate::{
    document::{Document, DocumentStep, nearest},
    error::CaseError,
};
use protocol::case::WeightedCondition;
use serde::Deserialize;

/// Key `condition` of an objective: a name, or a list of conditions.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged, expecting = "a name, or a list of names")]
pub(crate) enum FittedConditions {
    /// Name of the only condition.
    One(String),
    /// Several conditions, the first of which is the one that diagnoses fit.
    Several(Vec<FittedCondition>),
}

/// Condition in a list: its name, or its name with the weight of its errors.
#[derive(Clone, Debug, Deserialize)]
#[serde(
    untagged,
    expecting = "a name, or { name = \"NAME\", weight = NUMBER }"
)]
pub(crate) enum FittedCondition {
    /// Name of a condition whose weight is 1.
    Plain(String),
    /// Condition with a weight relative to the first one.
    Weighted(WeightedName),
}

/// Name of a condition, with the weight of its errors relative to the first one.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct WeightedName {
    name: String,
    weight: f64,
}

impl FittedConditions {
    /// Returns the named conditions in their order, with their weights; `None` where none is stated.
    fn all(&self) -> Vec<(&str, Option<f64>)> {
        match self {
            Self::One(name) => vec![(name, None)],
            Self::Several(list) => list
                .iter()
                .map(|one| match one {
                    FittedCondition::Plain(name) => (name.as_str(), None),
                    FittedCondition::Weighted(one) => (one.name.as_str(), Some(one.weight)),
                })
                .collect(),
        }
    }

    /// Returns whether a condition of this name takes part in the objective.
    pub(crate) fn names(&self, condition: &str) -> bool {
        self.all().iter().any(|(name, _)| *name == condition)
    }

    /// Returns the index of the first condition, and the others with their weights. `conditions` are the names
    /// of the case's conditions, each with whether it is held out.
    ///
    /// # Errors
    /// If the list is empty, names a condition that does not exist, is held out or occurs twice, or states a
    /// weight for the first condition or one that is not positive.
    pub(crate) fn resolve(
        &self,
        document: &Document,
        conditions: &[(&str, bool)],
    ) -> Result<(usize, Vec<WeightedCondition>), CaseError> {
        let keys = [
            DocumentStep::Key("objective"),
            DocumentStep::Key("condition"),
        ];
        let mut found: Vec<WeightedCondition> = Vec::new();
        for (at, (name, weight)) in self.all().into_iter().enumerate() {
            let condition = position(document, name, conditions)?;
            let refuse = |wanted: &str, help: &str| {
                Err(document.field(&keys, format!("\"{name}\""), wanted, help))
            };
            if found.iter().any(|own| own.condition == condition) {
                return refuse(
                    "each condition once",
                    "remove the repeated name; { name = \"NAME\", weight = 2.0 } gives a condition more weight",
                );
            }
            if conditions
                .get(condition)
                .is_some_and(|(_, held_out)| *held_out)
            {
                return refuse(
                    "conditions that take part in fits",
                    "remove held_out from that condition, or the condition from the objective",
                );
            }
            if at == 0 && weight.is_some() {
                return refuse(
                    "a first condition without a weight",
                    "state the weights of the others, which are relative to the first",
                );
            }
            let weight = weight.unwrap_or(1.0);
            if !(weight > 0.0 && weight <= 1.0e6) {
                let keys = [
                    keys[0],
                    keys[1],
                    DocumentStep::Index(at),
                    DocumentStep::Key("weight"),
                ];
                return Err(document.field(
                    &keys,
                    weight,
                    "above 0, at most 1e6",
                    "remove a condition that is not part of the objective",
                ));
            }
            found.push(WeightedCondition { condition, weight });
        }
        match found.split_first() {
            Some((first, others)) => Ok((first.condition, others.to_vec())),
            None => Err(document.field(
                &keys,
                "[]",
                "at least one condition",
                "write condition = \"NAME\", or a list of names",
            )),
        }
    }
}

/// Returns the index of the condition with this name.
fn position(
    document: &Document,
    name: &str,
    conditions: &[(&str, bool)],
) -> Result<usize, CaseError> {
    let names = conditions.iter().map(|(name, _)| *name);
    names.clone().position(|own| own == name).ok_or_else(|| {
        let near = nearest(name, names.clone());
        document.field(
            &[
                DocumentStep::Key("objective"),
                DocumentStep::Key("condition"),
            ],
            format!("\"{name}\""),
            format!(
                "the name of a condition: {}",
                names.collect::<Vec<_>>().join(", ")
            ),
            &near.map_or("name one of the conditions".to_owned(), |near| {
                format!("did you mean `{near}`?")
            }),
        )
    })
}
