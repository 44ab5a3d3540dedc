//! Genes that would have to wander along the turn or between conditions.
use discrepancy::{
    model::Fit,
    place::wander::{Part, Shift, Wander},
};
use report::diagnosis::Subject;
use serde::Serialize;

/// Genes that would have to wander under the recalibrated model, and under the answer; empty where
/// nothing was added.
#[derive(Debug, Serialize)]
pub(super) struct WanderedOutput {
    before: Vec<WanderOutput>,
    after: Vec<WanderOutput>,
}

/// A gene refitted alone on parts of the turn and under other conditions.
#[derive(Debug, Serialize)]
struct WanderOutput {
    gene: String,
    /// Share of what is left along the turn that it would take up [1].
    explained: f64,
    parts: Vec<PartOutput>,
}

#[derive(Debug, Serialize)]
struct PartOutput {
    /// Part of the turn; null for the whole turn under another condition.
    sector_deg: Option<[f64; 2]>,
    /// That condition.
    condition: Option<String>,
    /// The value that it would take (declared unit).
    value: f64,
    p_value: f64,
}

/// Genes that would have to wander, before and after the answer.
pub(super) fn wandered(subject: &Subject<'_>) -> WanderedOutput {
    let diagnosis = &subject.diagnosed.diagnosis;
    WanderedOutput {
        before: wanders(subject, diagnosis.before.as_ref(), &diagnosis.wander),
        after: wanders(subject, diagnosis.after.as_ref(), &diagnosis.wander_after),
    }
}

fn wanders(subject: &Subject<'_>, fit: Option<&Fit>, all: &[Wander]) -> Vec<WanderOutput> {
    let Some(fit) = fit else {
        return Vec::new();
    };
    let axes: Vec<_> = fit.model.space.axes().iter().zip(fit.x()).collect();
    let of_gene = |wander: &Wander| {
        let (axis, x) = axes.get(wander.unknown)?;
        let condition = |index: usize| {
            let of_case = subject.case.conditions.get(index);
            of_case.map(|condition| condition.name.clone())
        };
        let part = |shift: &Shift| PartOutput {
            sector_deg: match shift.part {
                Part::Sector { from, to } => Some([from, to]),
                Part::Condition(_) => None,
            },
            condition: match shift.part {
                Part::Sector { .. } => None,
                Part::Condition(index) => condition(index),
            },
            value: axis.value(**x + shift.by),
            p_value: shift.p_value,
        };
        Some(WanderOutput {
            gene: axis.unknown.name.clone(),
            explained: wander.explained,
            parts: wander.shifts.iter().map(part).collect(),
        })
    };
    all.iter().filter_map(of_gene).collect()
}
