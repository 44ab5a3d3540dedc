//! Localisation of the difference between simulation and record: windows of the abscissa, orders of the
//! period, joints.
use discrepancy::localisation::joint::Harmonic;
use report::diagnosis::DiagnosisInput;
use serde::Serialize;

/// Localisation of the residual: windows of the abscissa, harmonic orders, joints.
#[derive(Debug, Serialize)]
pub(super) struct LocalisationOutput {
    windows: Vec<WindowOutput>,
    orders: Vec<PeakOutput>,
    joints: Vec<JointOutput>,
}

#[derive(Debug, Serialize)]
struct WindowOutput {
    channel: String,
    from_deg: f64,
    to_deg: f64,
    strength: f64,
    p_value: f64,
}

#[derive(Debug, Serialize)]
struct PeakOutput {
    channel: String,
    order: usize,
    ratio: f64,
    p_value: f64,
}

#[derive(Debug, Serialize)]
struct JointOutput {
    joint: String,
    ln_bayes: f64,
    /// Whether this joint explains the residual as well as the best joint, within statistical uncertainty.
    equivalent: bool,
    /// Unit of the most likely force at this joint, whose harmonics over the turn, counted from bottom dead
    /// centre, are in `force`.
    unit: String,
    force: Vec<Harmonic>,
}

/// Builds the localisation of the residual; `None` if the diagnosis did not perform it.
pub(super) fn localisation(subject: &DiagnosisInput<'_>) -> Option<LocalisationOutput> {
    let seen = subject.diagnosed.result.diagnosis.localisation.as_ref()?;
    let record = subject
        .diagnosed
        .records
        .iter()
        .find(|r| r.condition == subject.case.objective.condition)?;
    let channel = |c: usize| {
        let found = record.channels.get(c);
        found
            .map(|own| own.channel.title.clone())
            .unwrap_or_default()
    };
    Some(LocalisationOutput {
        windows: seen
            .along
            .windows
            .iter()
            .map(|window| WindowOutput {
                channel: channel(window.channel),
                from_deg: window.from,
                to_deg: window.to,
                strength: window.strength,
                p_value: window.p_value,
            })
            .collect(),
        orders: seen
            .order
            .peaks
            .iter()
            .map(|peak| PeakOutput {
                channel: channel(peak.channel),
                order: peak.order,
                ratio: peak.ratio,
                p_value: peak.p_value,
            })
            .collect(),
        joints: seen
            .joints
            .iter()
            .enumerate()
            .map(|(k, joint)| JointOutput {
                joint: joint.joint.clone(),
                ln_bayes: joint.log_bayes,
                equivalent: k < seen.equivalent,
                unit: joint.unit.clone(),
                force: joint.force.clone(),
            })
            .collect(),
    })
}
