//! The object that `horsehead diagnose --output json` prints: a contract, more may be added.
use crate::report::diagnosis::Subject;
use crate::study::Account;
use discrepancy::bench::Fit;
use discrepancy::diagnose::{Diagnosis, Estimate, Force, Limit};
use discrepancy::laboratory::Stage;
use discrepancy::locate::wander::{Part, Shift, Wander};
use discrepancy::stage::preflight::Preflight;
use discrepancy::stage::show::Row;
use discrepancy::verdict::Verdict;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::time::Duration;

/// Of `horsehead diagnose`.
#[derive(Debug, Serialize)]
pub(super) struct DiagnoseOutput {
    run: String,
    case: String,
    verdict: Verdict,
    /// Why, where the verdict needs a reason.
    reason: Option<String>,
    /// Added effects, then the other members of their ambiguity sets; the best first. Where the
    /// verdict is unresolved, suspects, of which none is added.
    effects: Vec<EffectOutput>,
    /// Form and joint of a force that beats every name.
    generic: Option<String>,
    /// That force with its size, also where the verdict does not believe it.
    generic_force: Option<ForceOutput>,
    rounds: Vec<RoundOutput>,
    #[serde(rename = "where")]
    whereabouts: Option<WhereOutput>,
    wander: WanderedOutput,
    detection_limits: Vec<LimitOutput>,
    /// Pairs that this record cannot tell apart at three times their detection limits.
    inseparable: Vec<[String; 2]>,
    /// What would part those pairs, in their order.
    data_worth: Vec<WorthOutput>,
    gap: GapOutput,
    whiteness: Option<WhitenessOutput>,
    rival: Option<RivalOutput>,
    assumed_noise: bool,
    numerical_error: Option<NumericalOutput>,
    genes: BTreeMap<String, f64>,
    stages: Vec<StageOutput>,
    wall_s: f64,
}

/// Tail probabilities that what is left is white noise.
#[derive(Debug, Serialize)]
struct WhitenessOutput {
    p_before: f64,
    p_after: f64,
}

/// An effect with its size.
#[derive(Debug, Serialize)]
struct EffectOutput {
    id: String,
    title: String,
    added: bool,
    parameters: BTreeMap<String, ParameterOutput>,
    p_value: f64,
    ln_evidence: f64,
}

/// How many times as many cycles would part two effects.
#[derive(Debug, Serialize)]
struct WorthOutput {
    effects: [String; 2],
    cycles: f64,
    cycles_with_other_conditions: Option<f64>,
}

#[derive(Debug, Serialize)]
struct ParameterOutput {
    value: f64,
    unit: String,
    ci95: [f64; 2],
}

#[derive(Debug, Serialize)]
struct RoundOutput {
    p_value: f64,
    misfit: f64,
    added: Option<String>,
    set: Vec<String>,
    reason: Option<String>,
    suspects: Vec<SuspectOutput>,
}

/// One suspect: its test, and its refit where it was refitted.
#[derive(Debug, Serialize)]
struct SuspectOutput {
    id: String,
    p_value: f64,
    statistic: f64,
    absorbed: Option<f64>,
    ln_evidence: Option<f64>,
}

#[derive(Debug, Serialize)]
struct WhereOutput {
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
    /// Whether it is not told apart from the best.
    equivalent: bool,
    /// Unit of the likeliest force, and its harmonics of the turn from bottom dead centre.
    unit: String,
    force: Vec<HarmonicOutput>,
}

#[derive(Debug, Serialize)]
struct HarmonicOutput {
    order: usize,
    sine: bool,
    amplitude: f64,
}

/// Genes that would have to wander under the recalibrated model, and under the answer; empty where
/// nothing was added.
#[derive(Debug, Serialize)]
struct WanderedOutput {
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

#[derive(Debug, Serialize)]
struct LimitOutput {
    id: String,
    parameter: String,
    unit: String,
    /// Null where recalibration absorbs the effect wholly.
    size: f64,
}

/// The gap of the answer.
#[derive(Debug, Default, Serialize)]
struct GapOutput {
    calibration: Option<ClosedOutput>,
    held_out: Option<ClosedOutput>,
    other_condition: Option<ClosedOutput>,
}

#[derive(Debug, Serialize)]
struct ClosedOutput {
    before: f64,
    after: f64,
    closed: f64,
    ci95: Option<[f64; 2]>,
}

#[derive(Debug, Serialize)]
struct RivalOutput {
    id: String,
    gap: GapOutput,
}

/// A force without a cause.
#[derive(Debug, Serialize)]
struct ForceOutput {
    id: String,
    joint: String,
    form: String,
    amplitude: ParameterOutput,
    /// Of a harmonic.
    phase_deg: Option<f64>,
    ln_evidence: f64,
    gap: GapOutput,
}

/// How far a finer model moves the channels (in their units).
#[derive(Debug, Serialize)]
struct NumericalOutput {
    rms: Vec<f64>,
    rms_after_recalibration: Vec<f64>,
    standard_error: Vec<f64>,
    /// The same at the answer, where there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    at_answer: Option<Box<Self>>,
}

impl NumericalOutput {
    fn of(check: &Preflight) -> Self {
        Self {
            rms: check.rms.clone(),
            rms_after_recalibration: check.rms_left.clone(),
            standard_error: check.standard_error.clone(),
            at_answer: None,
        }
    }
}

#[derive(Debug, Serialize)]
struct StageOutput {
    stage: &'static str,
    simulations: u64,
    failed: u64,
    batches: u64,
    wall_s: f64,
}

/// The times in an object that was written earlier.
#[derive(Debug, Deserialize)]
pub(super) struct Times {
    stages: Vec<StageTime>,
}

#[derive(Debug, Deserialize)]
struct StageTime {
    stage: String,
    wall_s: f64,
}

impl Times {
    /// Puts the times of the stages back.
    pub(super) fn restore(&self, accounts: &mut [(Stage, Account)]) {
        for (stage, account) in accounts {
            let known = self.stages.iter().find(|time| time.stage == stage.name());
            let wall = known.and_then(|time| Duration::try_from_secs_f64(time.wall_s).ok());
            account.wall = wall.unwrap_or(account.wall);
        }
    }
}

/// The object of a diagnosis.
pub(super) fn object(subject: &Subject<'_>) -> DiagnoseOutput {
    let diagnosis = &subject.diagnosed.diagnosis;
    let calibrated = subject.case.objective.condition;
    let genes = diagnosis
        .after
        .as_ref()
        .map(|fit| fit.model.genes(fit.x()))
        .unwrap_or_default();
    DiagnoseOutput {
        run: subject.provenance.run.clone(),
        case: subject.case.name.clone(),
        verdict: diagnosis.verdict,
        reason: diagnosis.reason.clone(),
        effects: diagnosis
            .effects
            .iter()
            .map(|e| effect(diagnosis, e))
            .collect(),
        generic: diagnosis.generic.clone(),
        generic_force: diagnosis
            .force
            .as_ref()
            .map(|found| force(found, calibrated)),
        rounds: rounds(diagnosis),
        whereabouts: whereabouts(subject),
        wander: wandered(subject),
        detection_limits: diagnosis.limits.iter().map(limit).collect(),
        inseparable: diagnosis
            .look_alikes
            .iter()
            .map(|pair| pair.effects.clone())
            .collect(),
        data_worth: diagnosis
            .look_alikes
            .iter()
            .map(|pair| WorthOutput {
                effects: pair.effects.clone(),
                cycles: pair.cycles,
                cycles_with_other_conditions: pair.cycles_with_others,
            })
            .collect(),
        gap: gap(&diagnosis.rows, calibrated),
        whiteness: diagnosis
            .whiteness
            .map(|[p_before, p_after]| WhitenessOutput { p_before, p_after }),
        rival: diagnosis.rival.as_ref().map(|(id, rows)| RivalOutput {
            id: id.clone(),
            gap: gap(rows, calibrated),
        }),
        assumed_noise: diagnosis.assumed_noise,
        numerical_error: numerical_error(diagnosis),
        genes: subject
            .case
            .genes
            .iter()
            .zip(genes)
            .map(|(gene, value)| (gene.label(), value))
            .collect(),
        stages: subject
            .diagnosed
            .accounts
            .iter()
            .map(|(stage, account)| StageOutput {
                stage: stage.name(),
                simulations: account.experiments,
                failed: account.failed,
                batches: account.batches,
                wall_s: account.wall.as_secs_f64(),
            })
            .collect(),
        wall_s: subject.wall_s,
    }
}

fn effect(diagnosis: &Diagnosis, found: &Estimate) -> EffectOutput {
    let parameter = |(name, unit, value, ci95): &(String, String, f64, [f64; 2])| {
        let output = ParameterOutput {
            value: *value,
            unit: unit.clone(),
            ci95: *ci95,
        };
        (name.clone(), output)
    };
    EffectOutput {
        id: found.id.clone(),
        title: found.title.clone(),
        added: diagnosis
            .rounds
            .iter()
            .any(|round| round.added.as_ref() == Some(&found.id)),
        parameters: found.parameters.iter().map(parameter).collect(),
        p_value: found.p_value,
        ln_evidence: found.ln_evidence,
    }
}

fn numerical_error(diagnosis: &Diagnosis) -> Option<NumericalOutput> {
    let at_answer = diagnosis.preflight_after.as_ref();
    diagnosis.preflight.as_ref().map(|check| NumericalOutput {
        at_answer: at_answer.map(|after| Box::new(NumericalOutput::of(after))),
        ..NumericalOutput::of(check)
    })
}

fn force(found: &Force, calibrated: usize) -> ForceOutput {
    ForceOutput {
        id: found.id.clone(),
        joint: found.joint.clone(),
        form: found.form.clone(),
        amplitude: ParameterOutput {
            value: found.amplitude,
            unit: found.unit.clone(),
            ci95: found.interval,
        },
        phase_deg: found.phase_deg,
        ln_evidence: found.ln_evidence,
        gap: gap(&found.rows, calibrated),
    }
}

fn rounds(diagnosis: &Diagnosis) -> Vec<RoundOutput> {
    let round = |round: &discrepancy::diagnose::Round| RoundOutput {
        p_value: round.p_value,
        misfit: round.phi,
        added: round.added.clone(),
        set: round.set.clone(),
        reason: round.reason.clone(),
        suspects: round
            .suspects
            .iter()
            .map(|suspect| SuspectOutput {
                id: suspect.effect.id.clone(),
                p_value: suspect.p_value(),
                statistic: suspect.statistic(),
                absorbed: suspect.score.as_ref().map(|score| score.absorbed),
                ln_evidence: round
                    .refits
                    .iter()
                    .find(|refit| refit.id == suspect.effect.id)
                    .map(|refit| {
                        (refit.log_evidence - round.null_evidence) / (round.phi * round.phi)
                    }),
            })
            .collect(),
    };
    diagnosis.rounds.iter().map(round).collect()
}

fn whereabouts(subject: &Subject<'_>) -> Option<WhereOutput> {
    let seen = subject.diagnosed.diagnosis.whereabouts.as_ref()?;
    let record = subject
        .records
        .iter()
        .find(|r| r.condition == subject.case.objective.condition)?;
    let channel = |c: usize| record.channels.get(c).map(|s| s.name()).unwrap_or_default();
    Some(WhereOutput {
        windows: seen
            .angle
            .windows
            .iter()
            .map(|window| WindowOutput {
                channel: channel(window.channel),
                from_deg: window.from_deg,
                to_deg: window.to_deg,
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
                force: joint
                    .force
                    .iter()
                    .map(|part| HarmonicOutput {
                        order: part.order,
                        sine: part.sine,
                        amplitude: part.amplitude,
                    })
                    .collect(),
            })
            .collect(),
    })
}

fn limit(limit: &Limit) -> LimitOutput {
    LimitOutput {
        id: limit.id.clone(),
        parameter: limit.parameter.clone(),
        unit: limit.unit.clone(),
        size: limit.size,
    }
}

fn wandered(subject: &Subject<'_>) -> WanderedOutput {
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
    let genes = subject.case.genes.iter().zip(fit.model.space.axes());
    let genes: Vec<_> = genes.zip(fit.x()).collect();
    let of_gene = |wander: &Wander| {
        let ((gene, axis), x) = genes.get(wander.unknown)?;
        let condition = |index: usize| {
            let of_case = subject.case.conditions.get(index);
            of_case.map(|condition| condition.name.clone())
        };
        let part = |shift: &Shift| PartOutput {
            sector_deg: match shift.part {
                Part::Sector { from_deg, to_deg } => Some([from_deg, to_deg]),
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
            gene: gene.label(),
            explained: wander.explained,
            parts: wander.shifts.iter().map(part).collect(),
        })
    };
    all.iter().filter_map(of_gene).collect()
}

fn gap(rows: &[Row], calibrated: usize) -> GapOutput {
    let one = |fitted: bool, own: bool| {
        let row = rows
            .iter()
            .find(|row| row.fitted == fitted && (row.condition == calibrated) == own)?;
        Some(ClosedOutput {
            before: row.closed.before,
            after: row.closed.after,
            closed: row.closed.closed,
            ci95: row.closed.interval,
        })
    };
    GapOutput {
        calibration: one(true, true),
        held_out: one(false, true),
        other_condition: one(false, false),
    }
}

#[cfg(test)]
#[path = "diagnosis_json_tests.rs"]
mod tests;
