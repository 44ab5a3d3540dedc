//! Derivatives of simulated curves by the unknowns of a model, by the chain rule: the derivative by a
//! parameter of the simulation (a derivative column) times that parameter's rate per unit of the unknown.
//!
//! Unknowns of the case are measured in coordinates of the search space, parameters of effects in units of
//! their physical scale.
use crate::model::nuisance_parameter::{NuisanceParameter, apply_gains, effects};
use crate::model::parameter::setting;
use crate::model::unknowns::{FittedModel, Point};
use protocol::announce::EffectDescriptor;
use protocol::job::{Column, Derivative};
use record::{Curves, Record};
use search::derivative::DerivativeTerm;

/// Returns the chain-rule terms (derivative column and rate) of the curves' derivative by the `k`-th unknown
/// of a model at a point.
fn terms(model: &FittedModel, x: &[f64], k: usize) -> Vec<DerivativeTerm> {
    if k >= model.first_of(0) {
        return term_of_added(model, x, k).into_iter().collect();
    }
    if let Some((_, nuisance)) = model.indexed_nuisances().find(|(place, _)| *place == k) {
        return term_of_nuisance(model, x, nuisance).into_iter().collect();
    }
    search::derivative::terms(&model.space, k, x, &model.genes(x))
}

fn term_of_added(model: &FittedModel, x: &[f64], k: usize) -> Option<DerivativeTerm> {
    let mut all = model.added.iter().enumerate();
    let (at, effect) = all.rfind(|(at, _)| model.first_of(*at) <= k)?;
    let parameter = effect.parameters.get(k - model.first_of(at))?;
    Some(DerivativeTerm {
        column: Column::new(column_name(model, effect, &parameter.name)),
        value: parameter.absent + x[k] * parameter.scale,
        rate: parameter.scale,
    })
}

/// Returns the chain-rule term of a nuisance parameter that acts as an effect; `None` for an instrument gain,
/// which needs no derivative column.
fn term_of_nuisance(
    model: &FittedModel,
    x: &[f64],
    nuisance: &NuisanceParameter,
) -> Option<DerivativeTerm> {
    let (effect, k) = nuisance.effect()?;
    let own = &effect.parameters[k];
    let of_effect = model
        .nuisance_values(x)
        .filter(|(one, _)| one.is(&effect.id));
    let of_effect: Vec<(&NuisanceParameter, f64)> = of_effect.collect();
    let there = of_effect.iter().any(|(_, x)| *x != 0.0);
    let (_, values) = effects(of_effect.into_iter()).pop()?;
    Some(DerivativeTerm {
        column: Column {
            name: format!("{}.{}", effect.id, own.name),
            values: if there {
                Vec::new()
            } else {
                setting(effect, &values).parameters
            },
        },
        value: own.absent + values[k] * own.scale,
        rate: nuisance.nuisance.deviation,
    })
}

/// Returns the name of the derivative column by a parameter of a candidate effect: prefixed with the effect's
/// id, except where the effect stands for an unknown of the case.
fn column_name(model: &FittedModel, effect: &EffectDescriptor, parameter: &str) -> String {
    if is_off(model, effect) {
        parameter.to_owned()
    } else {
        format!("{}.{parameter}", effect.id)
    }
}

fn is_off(model: &FittedModel, effect: &EffectDescriptor) -> bool {
    model.off.iter().any(|off| off.candidate.id == effect.id)
}

/// Returns the chain-rule term of the derivative by a size of a candidate effect that the model does not
/// contain, at the scaled values `shape` of the effect's parameters; `None` where the point already contains
/// the effect as a nonzero nuisance parameter.
pub(crate) fn candidate_term(
    Point { model, x }: &Point,
    effect: &EffectDescriptor,
    shape: &[f64],
    size: usize,
) -> Option<DerivativeTerm> {
    let mut nuisances = model.nuisance_values(x);
    if nuisances.any(|(one, x)| one.is(&effect.id) && x != 0.0) {
        return None;
    }
    let own = &effect.parameters[size];
    Some(DerivativeTerm {
        column: Column {
            name: column_name(model, effect, &own.name),
            values: if is_off(model, effect) {
                Vec::new()
            } else {
                setting(effect, shape).parameters
            },
        },
        value: own.absent,
        rate: own.scale,
    })
}

/// Point to be simulated, with the derivatives that are requested there.
pub(crate) struct DerivativeRequest {
    pub(crate) point: Point,
    /// Chain-rule terms of each requested derivative; a derivative is their sum.
    changes: Vec<Vec<DerivativeTerm>>,
    /// Whether the requested derivatives are those by all unknowns of the point.
    by_unknowns: bool,
}

impl DerivativeRequest {
    /// Requests a point with its derivatives by all of its unknowns, or by none.
    pub(crate) fn new(point: Point, with_changes: bool) -> Self {
        let unknowns = if with_changes { point.x.len() } else { 0 };
        let changes = (0..unknowns).map(|k| terms(&point.model, &point.x, k));
        Self {
            changes: changes.collect(),
            by_unknowns: with_changes,
            point,
        }
    }

    /// Requests a point with one first-order derivative per term.
    pub(crate) fn with_terms(point: Point, terms: &[DerivativeTerm]) -> Self {
        Self {
            point,
            changes: terms.iter().map(|term| vec![term.clone()]).collect(),
            by_unknowns: false,
        }
    }

    /// Returns the derivative columns that a job must ask the simulator for.
    pub(crate) fn columns(&self) -> Vec<Column> {
        let terms = self.changes.iter().flatten();
        terms.map(|term| term.column.clone()).collect()
    }

    /// Combines simulated derivative columns into the requested derivatives of the record's channels; `None`
    /// for a derivative that lacks a column. Derivatives by gains are computed from the simulated curves.
    pub(crate) fn changes(
        &self,
        columns: &[Derivative],
        (record, like): (&Record, &Curves),
    ) -> Vec<Option<Curves>> {
        let mut changes = self.by_columns(columns, (record, like));
        let Point { model, x } = &self.point;
        for change in changes.iter_mut().flatten() {
            apply_gains(model.nuisance_values(x), record, change);
        }
        if !self.by_unknowns {
            return changes;
        }
        for (place, one) in model.indexed_nuisances() {
            if let Some(channel) = one.channel(record) {
                let mut gained: Curves = like.iter().map(|c| vec![0.0; c.len()]).collect();
                let grown = like[channel].iter().map(|y| y * one.nuisance.deviation);
                gained[channel] = grown.collect();
                changes[place] = Some(gained);
            }
        }
        changes
    }

    fn by_columns(
        &self,
        columns: &[Derivative],
        (record, like): (&Record, &Curves),
    ) -> Vec<Option<Curves>> {
        let mut columns = columns.iter();
        let change = |terms: &Vec<DerivativeTerm>| {
            let mut sum: Curves = like.iter().map(|c| vec![0.0; c.len()]).collect();
            let mut known = !terms.is_empty();
            for term in terms {
                // every term takes its column, known or not
                let column = columns.next();
                let mut each = sum.iter_mut().zip(&record.channels);
                known &= column.is_some_and(|column| {
                    each.all(|(sum, own)| {
                        let place = (own.curve, own.rows.as_deref());
                        term.add(column, place, sum).is_some()
                    })
                });
            }
            known.then_some(sum)
        };
        self.changes.iter().map(change).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::case::{Scale, Tie, Unknown};
    use protocol::job::Per;
    use record::{Stated, recorded};
    use search::space::Space;

    /// Checks, for two tied unknowns and a single one, that columns are consumed in the order of the terms
    /// and that a derivative that lacks a column is `None`, never zeros, whichever other columns are present.
    #[test]
    fn what_has_no_column_is_not_known() {
        let unknown = |name: &str| Unknown::new(name, "mm", Scale::Linear, 2.0, [0.0, 8.0]);
        let tie = Tie {
            to: "a".to_owned(),
            ratio: 1.0,
        };
        let tied = Unknown {
            tie: Some(tie),
            ..unknown("b")
        };
        let space = Space::new(&[unknown("a"), tied, unknown("c")]).unwrap();
        let model = FittedModel::plain(space);
        let x = vec![0.0, 0.0];
        let wanted = DerivativeRequest::new(Point { model, x }, true);
        let names: Vec<String> = wanted.columns().into_iter().map(|c| c.name).collect();
        assert_eq!(names, ["a", "b", "c"]);
        let record = Record {
            condition: 0,
            channels: vec![recorded(1)],
            cycles: Vec::new(),
            held_out: false,
            stated: Stated::default(),
        };
        let curve = |x: f32| Derivative::Curves {
            per: Per::Unit("mm".to_owned()),
            curves: vec![Vec::new(), vec![x; 3]],
        };
        let none = || Derivative::Missing {
            reason: "none".to_owned(),
        };
        let like = vec![vec![7.0; 3]];
        let of = |columns: &[Derivative]| wanted.changes(columns, (&record, &like));
        // a coordinate is half the interval: 4 mm
        let change = |x: f64| Some(vec![vec![4.0 * x; 3]]);
        let all = [curve(1.0), curve(2.0), curve(5.0)];
        assert_eq!(of(&all), [change(3.0), change(5.0)]);
        assert_eq!(of(&[none(), curve(2.0), curve(5.0)]), [None, change(5.0)]);
        assert_eq!(of(&all[..2]), [change(3.0), None]);
        assert_eq!(of(&[]), [None, None]);
    }
}
