//! What curves change by per unit of a model's unknown: the columns of simulations, times rates.
//!
//! Unknowns of the case count by the coordinates of their space, parameters of effects by their scales.
use crate::model::parameter::setting;
use crate::model::unknowns::{Model, Point};
use crate::record::measured::{Curves, Record, Recorded};
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
            let mut sum: Option<Curves> = Some(like.iter().map(|c| vec![0.0; c.len()]).collect());
            for (term, column) in terms.iter().zip(columns.by_ref()) {
                sum = sum.and_then(|sum| added(sum, term, column, record));
            }
            sum.filter(|_| !terms.is_empty())
        };
        self.changes.iter().map(change).collect()
    }
}

/// A sum and a term; nothing where the term has no column in a channel of the record.
fn added(mut sum: Curves, term: &Term, column: &Derivative, record: &Record) -> Option<Curves> {
    match column {
        Derivative::Curves { per, curves } => {
            let factor = term.factor(per);
            let channels: &[Recorded] = &record.channels;
            for (sum, channel) in sum.iter_mut().zip(channels) {
                let own = curves.get(channel.curve)?;
                if own.len() != sum.len() {
                    return None;
                }
                for (sum, x) in sum.iter_mut().zip(own) {
                    *sum += factor * f64::from(*x);
                }
            }
            Some(sum)
        }
        Derivative::Nothing { .. } => Some(sum),
        Derivative::Missing { .. } => None,
    }
}
