//! Complete JSON object of `horsehead diagnose`.
use super::{
    effects::{EffectOutput, ForceOutput, RoundOutput, effect, force, rounds},
    gap::{GapOutput, LeftOutput, PredictionOutput, gap, left, predictions},
    localisation::{LocalisationOutput, localisation},
    parameter_drift::{VaryingUnknownsOutput, varying_unknowns},
};
use discrepancy::{
    baseline::discretisation_check::Preflight,
    diagnose::{
        Absorbed, Diagnosis, DiscrepancyEstimate, Estimate, IndistinguishablePair, Limit,
        NuisanceEstimate,
    },
    verdict::Verdict,
};
use report::{MachineCheck, diagnosis::DiagnosisInput};
use serde::Serialize;
use std::collections::BTreeMap;

/// JSON object printed by `horsehead diagnose CASE --output json`.
#[derive(Debug, Serialize)]
pub(crate) struct DiagnoseOutput {
    run: String,
    case: String,
    verdict: Verdict,
    /// Whether the verdict claims a part only: more than noise is left, or a stage that it rests on used up its
    /// budget.
    in_part: bool,
    /// Reason for the verdict of the diagnosis; null if it needs none.
    reason: Option<String>,
    /// Share of the fitted record's gap that the answer closes; null without an answer.
    explained: Option<f64>,
    /// Smooth discrepancy that the model of the answer still needs on the fitted record; null if it needs none.
    discrepancy: Option<DiscrepancyOutput>,
    /// Records, fitted or not, on which the model of the answer leaves more than noise.
    left: Vec<LeftOutput>,
    converged: bool,
    /// Unknowns, instruments and effect parameters of the answer that stand at a bound.
    at_bounds: Vec<String>,
    /// Instruments that the answer would need far beyond their tolerance.
    beyond: Vec<String>,
    /// Effects that the diagnosis added to the model, followed by the other members of their ambiguity sets,
    /// best first. Empty if the verdict names no effect: suspected effects are listed in the rounds.
    effects: Vec<EffectOutput>,
    /// Effects that are significant, but change no channel by more than models of real machines err.
    traces: Vec<EffectOutput>,
    /// Generic force (form and joint) that fits better than every named effect.
    generic: Option<String>,
    /// Best-fitting generic force with its size, reported even if the verdict does not accept it.
    generic_force: Option<ForceOutput>,
    rounds: Vec<RoundOutput>,
    #[serde(rename = "where")]
    whereabouts: Option<LocalisationOutput>,
    wander: VaryingUnknownsOutput,
    detection_limits: Vec<LimitOutput>,
    /// Estimated instrument errors (nuisance parameters), reported separately from the effects.
    nuisances: Vec<NuisanceEstimate>,
    /// Effects that the measured record cannot reveal because a change of the unknowns imitates them, largest
    /// imitated share first.
    absorbed: Vec<Absorbed>,
    /// Pairs of effects that the measured record cannot distinguish when each is three times its detection
    /// limit.
    inseparable: Vec<[String; 2]>,
    /// Further measurements that would distinguish the pairs in `inseparable`, in the order of the pairs.
    data_worth: Vec<IndistinguishablePair>,
    gap: GapOutput,
    /// Quantities of the machine under every condition by which the answer is judged, without (`before`) and with
    /// (`after`) the added effects; empty for kinds of model that have none.
    machine: Vec<MachineCheck>,
    /// Predictive scores, on all data excluded from the fit, of the accepted model or, if none was accepted,
    /// of the withheld suspected effect.
    prediction: Vec<PredictionOutput>,
    whiteness: Option<WhitenessOutput>,
    rival: Option<RivalOutput>,
    assumed_noise: bool,
    numerical_error: Option<NumericalOutput>,
    genes: BTreeMap<String, f64>,
    /// Names of the stages of the diagnosis that exhausted their simulation budget.
    ran_out: Vec<&'static str>,
    stages: Vec<StageOutput>,
    wall_s: f64,
}

/// Smooth discrepancy beside a model.
#[derive(Debug, Serialize)]
struct DiscrepancyOutput {
    /// Share of the gap without effects that it takes.
    share: f64,
    /// Correlation length as a share of the abscissa's span.
    length: f64,
    /// Expected curve and half-width of its 95 % band by channel, in the channel's unit.
    channels: BTreeMap<String, BandOutput>,
}

#[derive(Debug, Serialize)]
struct BandOutput {
    unit: String,
    at: Vec<f64>,
    mean: Vec<f64>,
    half: Vec<f64>,
}

impl DiscrepancyOutput {
    fn of(found: &DiscrepancyEstimate) -> Self {
        let curves = found.mean.iter().zip(&found.half);
        let channels = found
            .channels
            .iter()
            .zip(curves)
            .map(|(own, (mean, half))| {
                let band = BandOutput {
                    unit: own.unit.clone(),
                    at: own.abscissa.points.clone(),
                    mean: mean.clone(),
                    half: half.clone(),
                };
                (own.name.clone(), band)
            });
        Self {
            share: found.share,
            length: found.length,
            channels: channels.collect(),
        }
    }
}

/// P-values of the test whether the residual is white noise, before and after the effects were added.
#[derive(Debug, Serialize)]
struct WhitenessOutput {
    p_before: f64,
    p_after: f64,
}

/// Detection limit of an effect.
#[derive(Debug, Serialize)]
struct LimitOutput {
    id: String,
    parameter: String,
    unit: String,
    /// Smallest size that would be detected; null if no size within the effect's bounds would be.
    size: Option<f64>,
}

#[derive(Debug, Serialize)]
struct RivalOutput {
    id: String,
    gap: GapOutput,
}

/// Discretisation error of the simulation: change of each channel under a finer model, in the channel's unit.
#[derive(Debug, Serialize)]
struct NumericalOutput {
    rms: Vec<f64>,
    rms_after_recalibration: Vec<f64>,
    standard_error: Vec<f64>,
    /// Discretisation error of the final model, which contains the found effects; absent if no effect was
    /// found.
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
    /// Simulations that also computed derivatives.
    with_derivatives: u64,
    /// Experiments that an equal one had answered.
    known: u64,
    failed: u64,
    batches: u64,
    /// Slot time of the simulations, summed (s).
    busy_s: f64,
}

/// Builds the JSON object of a diagnosis.
pub(crate) fn object(subject: &DiagnosisInput<'_>) -> DiagnoseOutput {
    let diagnosis = &subject.diagnosed.result.diagnosis;
    let genes = diagnosis
        .after
        .as_ref()
        .map(|fit| fit.genes.clone())
        .unwrap_or_default();
    DiagnoseOutput {
        run: subject.origin.run.clone(),
        case: subject.case.name.clone(),
        verdict: diagnosis.verdict,
        in_part: diagnosis.is_in_part(),
        reason: diagnosis.reason.clone(),
        explained: diagnosis.remainder.explained,
        discrepancy: diagnosis
            .remainder
            .discrepancy
            .as_ref()
            .map(DiscrepancyOutput::of),
        left: left(subject.case, &diagnosis.remainder.left),
        converged: diagnosis.remainder.is_converged,
        at_bounds: diagnosis.remainder.at_bounds.clone(),
        beyond: diagnosis.remainder.beyond.clone(),
        effects: named(diagnosis).map(|e| effect(diagnosis, e)).collect(),
        traces: diagnosis
            .traces()
            .into_iter()
            .map(|(own, _)| effect(diagnosis, own))
            .collect(),
        generic: diagnosis.generic.clone(),
        generic_force: diagnosis.force.as_ref().map(force),
        rounds: rounds(diagnosis),
        whereabouts: localisation(subject),
        wander: varying_unknowns(subject),
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
        machine: report::diagnosis::checks(subject),
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
            .result
            .accounts
            .iter()
            .map(|(stage, account)| StageOutput {
                stage: stage.name(),
                simulations: account.experiments,
                with_derivatives: account.with_derivatives,
                known: account.known,
                failed: account.failed,
                batches: account.batches,
                busy_s: subject.busy(*stage).as_secs_f64(),
            })
            .collect(),
        wall_s: subject.wall_s,
    }
}

/// Iterates over the effects that the verdict names: added effects and the members of their ambiguity sets.
fn named(diagnosis: &Diagnosis) -> impl Iterator<Item = &Estimate> {
    let silent = matches!(
        diagnosis.verdict,
        Verdict::NothingDetected | Verdict::Unresolved
    );
    let effects = diagnosis.effects.iter();
    effects.filter(move |own| !silent && diagnosis.holds(&own.id))
}

fn numerical_error(diagnosis: &Diagnosis) -> Option<NumericalOutput> {
    let at_answer = diagnosis.preflight_after.as_ref();
    diagnosis.preflight.as_ref().map(|check| NumericalOutput {
        at_answer: at_answer.map(|after| Box::new(NumericalOutput::of(after))),
        ..NumericalOutput::of(check)
    })
}

/// Converts a detection limit to its JSON form.
fn bounded(limit: &Limit) -> LimitOutput {
    LimitOutput {
        id: limit.id.clone(),
        parameter: limit.parameter.clone(),
        unit: limit.unit.clone(),
        size: limit.is_within_bounds().then_some(limit.size),
    }
}
