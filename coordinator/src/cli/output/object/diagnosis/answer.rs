//! The object as a whole.
use super::{
    effects::{EffectOutput, ForceOutput, RoundOutput, effect, force, rounds},
    gap::{GapOutput, PredictionOutput, gap, predictions},
    place::{WhereOutput, whereabouts},
    wander::{WanderedOutput, wandered},
};
use discrepancy::{
    diagnose::{Absorbed, Diagnosis, Estimate, Limit, LookAlikes, NeverExact},
    ground::preflight::Preflight,
    verdict::Verdict,
};
use report::diagnosis::Subject;
use serde::Serialize;
use std::collections::BTreeMap;

/// Of `horsehead diagnose`.
#[derive(Debug, Serialize)]
pub(crate) struct DiagnoseOutput {
    run: String,
    case: String,
    verdict: Verdict,
    /// Why, where the verdict needs a reason.
    reason: Option<String>,
    /// Added effects, then the other members of their ambiguity sets; the best first. Empty where the
    /// verdict names nothing: suspects stand in the rounds.
    effects: Vec<EffectOutput>,
    /// Form and joint of a force that beats every name.
    generic: Option<String>,
    /// That force with its size, also where the verdict does not believe it.
    generic_force: Option<ForceOutput>,
    rounds: Vec<RoundOutput>,
    #[serde(rename = "where")]
    whereabouts: Option<WhereOutput>,
    wander: WanderedOutput,
    detection_limits: Vec<Limit>,
    /// What the instruments are off by, beside the answer.
    nuisances: Vec<NeverExact>,
    /// Effects that this record cannot show, for the unknowns take them up, the largest share first.
    absorbed: Vec<Absorbed>,
    /// Pairs that this record cannot tell apart at three times their detection limits.
    inseparable: Vec<[String; 2]>,
    /// What would part those pairs, in their order.
    data_worth: Vec<LookAlikes>,
    gap: GapOutput,
    /// Predictive scores of the answer, or of what is withheld as a suspect, on everything that took no part in the
    /// fit.
    prediction: Vec<PredictionOutput>,
    whiteness: Option<WhitenessOutput>,
    rival: Option<RivalOutput>,
    assumed_noise: bool,
    numerical_error: Option<NumericalOutput>,
    genes: BTreeMap<String, f64>,
    /// Stages that used up the simulations that they may cost.
    ran_out: Vec<&'static str>,
    stages: Vec<StageOutput>,
    wall_s: f64,
}

/// Tail probabilities that what is left is white noise.
#[derive(Debug, Serialize)]
struct WhitenessOutput {
    p_before: f64,
    p_after: f64,
}

#[derive(Debug, Serialize)]
struct RivalOutput {
    id: String,
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

/// The object of a diagnosis.
pub(crate) fn object(subject: &Subject<'_>) -> DiagnoseOutput {
    let diagnosis = &subject.diagnosed.diagnosis;
    let genes = diagnosis
        .after
        .as_ref()
        .map(|fit| fit.model.genes(fit.x()))
        .unwrap_or_default();
    DiagnoseOutput {
        run: subject.origin.run.clone(),
        case: subject.case.name.clone(),
        verdict: diagnosis.verdict,
        reason: diagnosis.reason.clone(),
        effects: named(diagnosis)
            .iter()
            .map(|e| effect(diagnosis, e))
            .collect(),
        generic: diagnosis.generic.clone(),
        generic_force: diagnosis.force.as_ref().map(force),
        rounds: rounds(diagnosis),
        whereabouts: whereabouts(subject),
        wander: wandered(subject),
        detection_limits: diagnosis.detection_limits().map(bounded).collect(),
        nuisances: diagnosis.nuisances.clone(),
        absorbed: diagnosis.absorbed.clone(),
        inseparable: diagnosis
            .look_alikes
            .iter()
            .map(|pair| pair.effects.clone())
            .collect(),
        data_worth: diagnosis.look_alikes.clone(),
        gap: gap(&diagnosis.rows),
        prediction: predictions(subject.case, &diagnosis.prediction),
        whiteness: diagnosis
            .whiteness
            .map(|[p_before, p_after]| WhitenessOutput { p_before, p_after }),
        rival: diagnosis.rival.as_ref().map(|(id, rows)| RivalOutput {
            id: id.clone(),
            gap: gap(rows),
        }),
        assumed_noise: !diagnosis.noise.is_seen(),
        numerical_error: numerical_error(diagnosis),
        genes: subject
            .case
            .unknowns
            .iter()
            .zip(genes)
            .map(|(unknown, value)| (unknown.name.clone(), value))
            .collect(),
        ran_out: diagnosis.ran_out.iter().map(|stage| stage.name()).collect(),
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

/// Effects of an answer that names some.
fn named(diagnosis: &Diagnosis) -> &[Estimate] {
    match diagnosis.verdict {
        Verdict::Named | Verdict::Ambiguous | Verdict::Unlisted => &diagnosis.effects,
        Verdict::NothingDetected | Verdict::Unresolved => &[],
    }
}

fn numerical_error(diagnosis: &Diagnosis) -> Option<NumericalOutput> {
    let at_answer = diagnosis.preflight_after.as_ref();
    diagnosis.preflight.as_ref().map(|check| NumericalOutput {
        at_answer: at_answer.map(|after| Box::new(NumericalOutput::of(after))),
        ..NumericalOutput::of(check)
    })
}

/// A limit as programs read it: null where no size within the effect's bounds would be seen.
fn bounded(limit: &Limit) -> Limit {
    Limit {
        size: if limit.is_within_bounds() {
            limit.size
        } else {
            f64::INFINITY
        },
        ..limit.clone()
    }
}
