//! What curves change by per unit of a model's unknown: the columns of simulations, times rates.
//!
//! Unknowns of the case count by the coordinates of their space, parameters of effects by their scales.
use crate::model::parameter::setting;
use crate::model::unknowns::{Model, Point};
use crate::record::measured::{Curves, Record};
use protocol::announce::EffectDescriptor;
use protocol::job::{Column, Derivative};
use search::derivative::Term;

/// The terms of a change by the k-th unknown of a model at a point.
fn terms(model: &Model, x: &[f64], k: usize) -> Vec<Term> {
    if k >= model.space.dimension() {
        return term_of_added(model, x, k).into_iter().collect();
    }
    search::derivative::terms(&model.space, k, x, &model.genes(x))
}

fn term_of_added(model: &Model, x: &[f64], k: usize) -> Option<Term> {
    let mut all = model.added.iter().enumerate();
    let (at, effect) = all.rfind(|(at, _)| model.first_of(*at) <= k)?;
    let parameter = effect.parameters.get(k - model.first_of(at))?;
    Some(Term {
        column: Column::of(column_name(model, effect, &parameter.name)),
        value: parameter.absent + x[k] * parameter.scale,
        rate: parameter.scale,
    })
}

/// The name of a parameter of something suspected among the columns: an unknown that is off is one
/// of the case.
fn column_name(model: &Model, effect: &EffectDescriptor, parameter: &str) -> String {
    if is_off(model, effect) {
        effect.id.clone()
    } else {
        format!("{}.{parameter}", effect.id)
    }
}

fn is_off(model: &Model, effect: &EffectDescriptor) -> bool {
    model.off.iter().any(|off| off.suspect.id == effect.id)
}

/// The change by a size of something suspected that the model does not have, at a shape: scaled values
/// of its parameters.
pub(crate) fn term_of_absent(
    model: &Model,
    effect: &EffectDescriptor,
    shape: &[f64],
    size: usize,
) -> Term {
    let own = &effect.parameters[size];
    Term {
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
    }
}

/// A point whose curves are wanted with changes of them.
pub(crate) struct Wanted {
    pub(crate) point: Point,
    /// The terms of each.
    pub(crate) changes: Vec<Vec<Term>>,
}

impl Wanted {
    /// A point and its changes by all of its unknowns, or by none.
    pub(crate) fn new(point: Point, with_changes: bool) -> Self {
        let unknowns = if with_changes { point.x.len() } else { 0 };
        let changes = (0..unknowns).map(|k| terms(&point.model, &point.x, k));
        Self {
            changes: changes.collect(),
            point,
        }
    }

    /// The columns that this takes.
    pub(crate) fn columns(&self) -> Vec<Column> {
        let terms = self.changes.iter().flatten();
        terms.map(|term| term.column.clone()).collect()
    }

    /// The changes from those columns, in the record's channels; none for one that lacks a column.
    pub(crate) fn changes(
        &self,
        columns: &[Derivative],
        (record, like): (&Record, &Curves),
    ) -> Vec<Option<Curves>> {
        let mut columns = columns.iter();
        let change = |terms: &Vec<Term>| {
            let mut sum: Curves = like.iter().map(|c| vec![0.0; c.len()]).collect();
            let mut known = !terms.is_empty();
            for term in terms {
                // every term takes its column, known or not
                let column = columns.next();
                let mut each = sum.iter_mut().zip(&record.channels);
                known &= column.is_some_and(|column| {
                    each.all(|(sum, own)| term.add(column, own.curve, sum).is_some())
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
    use crate::record::measured::{Stated, tests::recorded};
    use protocol::case::{Scale, Tie, Unknown};
    use protocol::job::Per;
    use search::space::Space;

    /// Two unknowns that move together, and one alone: the terms of a change are taken in order, and what
    /// lacks a column is not known, whatever stands beside it. Never zeros.
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
        let model = Model::plain(space);
        let x = vec![0.0, 0.0];
        let wanted = Wanted::new(Point { model, x }, true);
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
