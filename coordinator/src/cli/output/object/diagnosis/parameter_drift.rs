//! Unknowns whose fitted value would have to change along the turn or between conditions, a sign of missing
//! physics.
use discrepancy::{
    localisation::parameter_drift::{ParameterDrift, ParameterShift, RecordPart},
    model::FitSummary,
};
use report::diagnosis::DiagnosisInput;
use search::space::Space;
use serde::Serialize;

/// Unknowns whose values would have to vary along the turn or between conditions, under the recalibrated
/// baseline model and under the final model; empty for the latter if no effect was added.
#[derive(Debug, Serialize)]
pub(super) struct VaryingUnknownsOutput {
    before: Vec<VaryingUnknownOutput>,
    after: Vec<VaryingUnknownOutput>,
}

/// Unknown that was refitted on its own for each sector of a period and for each other condition.
#[derive(Debug, Serialize)]
struct VaryingUnknownOutput {
    gene: String,
    /// Share of the residual along the turn that the varying unknown would explain [1].
    explained: f64,
    parts: Vec<PartOutput>,
}

#[derive(Debug, Serialize)]
struct PartOutput {
    /// Sector of the period (degrees) on which the unknown was refitted; null for the whole period
    /// under another condition.
    sector_deg: Option<[f64; 2]>,
    /// Name of the other condition under which the unknown was refitted; null for a sector of the turn.
    condition: Option<String>,
    /// Value of the unknown refitted on this sector or condition alone (declared unit).
    value: f64,
    p_value: f64,
}

/// Converts the unknowns whose values would have to vary to their JSON form, for the models before and after
/// effects were added.
pub(super) fn varying_unknowns(subject: &DiagnosisInput<'_>) -> VaryingUnknownsOutput {
    let diagnosis = &subject.diagnosed.result.diagnosis;
    VaryingUnknownsOutput {
        before: wanders(subject, diagnosis.before.as_ref(), &diagnosis.drifts),
        after: wanders(subject, diagnosis.after.as_ref(), &diagnosis.drifts_after),
    }
}

fn wanders(
    subject: &DiagnosisInput<'_>,
    fit: Option<&FitSummary>,
    all: &[ParameterDrift],
) -> Vec<VaryingUnknownOutput> {
    let space = Space::new(&subject.case.unknowns).ok();
    let Some((fit, space)) = fit.zip(space) else {
        return Vec::new();
    };
    let axes: Vec<_> = space.axes().iter().zip(&fit.coordinates).collect();
    let of_gene = |wander: &ParameterDrift| {
        let (axis, x) = axes.get(wander.unknown)?;
        let condition = |index: usize| {
            let of_case = subject.case.conditions.get(index);
            of_case.map(|condition| condition.name.clone())
        };
        let part = |shift: &ParameterShift| PartOutput {
            sector_deg: match shift.part {
                RecordPart::Sector { from, to } => Some([from, to]),
                RecordPart::Condition(_) => None,
            },
            condition: match shift.part {
                RecordPart::Sector { .. } => None,
                RecordPart::Condition(index) => condition(index),
            },
            value: axis.value(**x + shift.by),
            p_value: shift.p_value,
        };
        Some(VaryingUnknownOutput {
            gene: axis.unknown.name.clone(),
            explained: wander.explained,
            parts: wander.shifts.iter().map(part).collect(),
        })
    };
    all.iter().filter_map(of_gene).collect()
}
