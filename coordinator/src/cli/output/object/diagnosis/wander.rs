//! Unknowns whose fitted value would have to change along the turn or between conditions, a sign of missing
//! physics.
use discrepancy::{
    model::Fit,
    place::wander::{Part, Shift, Wander},
};
use report::diagnosis::Subject;
use serde::Serialize;

/// Unknowns whose values would have to vary under the recalibrated baseline model, and under the final model;
/// empty for the latter if no effect was added.
#[derive(Debug, Serialize)]
pub(super) struct WanderedOutput {
    before: Vec<WanderOutput>,
    after: Vec<WanderOutput>,
}

/// Unknown refitted alone on parts of the turn and under other conditions.
#[derive(Debug, Serialize)]
struct WanderOutput {
    gene: String,
    /// Share of the residual along the turn that the varying unknown would explain [1].
    explained: f64,
    parts: Vec<PartOutput>,
}

#[derive(Debug, Serialize)]
struct PartOutput {
    /// Angular sector of the turn (degrees); null for the whole turn under another condition.
    sector_deg: Option<[f64; 2]>,
    /// Name of the other condition; null for a sector of the turn.
    condition: Option<String>,
    /// Value of the unknown refitted on this part (declared unit).
    value: f64,
    p_value: f64,
}

/// Converts the unknowns whose values would have to vary, before and after effects were added, to their JSON
/// form.
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
