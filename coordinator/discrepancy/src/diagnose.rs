//! A diagnosis from the record to the verdict: the order of the stages and what they hand on.
use crate::bench::Fit;
use crate::estimate::estimates;
pub use crate::estimate::{Estimate, Limit};
use crate::evidence::misfit;
use crate::laboratory::Laboratory;
use crate::model::Model;
use crate::record::Record;
pub use crate::rounds::Round;
use crate::rounds::rounds;
use crate::settings::Settings;
use crate::stage::establish::{Base, establish};
use crate::stage::preflight::Preflight;
use crate::stage::show::Row;
use crate::stage::whereabouts::Where;
pub use crate::stage::worth::LookAlikes;
use crate::stage::{show, whereabouts};
use crate::verdict::{Findings, Verdict, verdict};
use protocol::announce::EffectDescriptor;
use protocol::job::Refinement;
use search::space::Space;

/// What is diagnosed.
#[derive(Clone, Debug)]
pub struct Inputs {
    /// Genes and their bounds.
    pub space: Space,
    /// Records, the calibrated condition's first.
    pub records: Vec<Record>,
    /// What the workers can simulate.
    pub library: Vec<EffectDescriptor>,
    /// A calibrated point (decades), if there is one.
    pub start: Option<Vec<f64>>,
    /// Discretisation of all experiments but that of the numerical check.
    pub usual: Refinement,
    /// A finer discretisation, for the numerical check.
    pub finer: Refinement,
    /// Seed of the way into the valley.
    pub seed: u64,
    /// Thresholds.
    pub settings: Settings,
}

/// A finished diagnosis.
#[derive(Clone, Debug)]
pub struct Diagnosis {
    /// The answer.
    pub verdict: Verdict,
    /// Why, in a sentence, where the answer needs one.
    pub reason: Option<String>,
    /// Added effects, then the other members of their ambiguity sets.
    pub effects: Vec<Estimate>,
    /// The rounds.
    pub rounds: Vec<Round>,
    /// Where the recalibrated model and the record part.
    pub whereabouts: Option<Where>,
    /// The numerical check.
    pub preflight: Option<Preflight>,
    /// Detection limits of all effects.
    pub limits: Vec<Limit>,
    /// Effects that this record cannot tell apart, and what would.
    pub look_alikes: Vec<LookAlikes>,
    /// The recalibrated model without effects.
    pub before: Option<Fit>,
    /// The model of the answer.
    pub after: Option<Fit>,
    /// The gap of the answer by record.
    pub rows: Vec<Row>,
    /// The best rejected rival and its gap by record.
    pub rival: Option<(String, Vec<Row>)>,
    /// Form and joint of a force that beats every name.
    pub generic: Option<String>,
    /// Whether the noise was assumed.
    pub assumed_noise: bool,
    /// What else should be known.
    pub notes: Vec<String>,
}

/// Diagnoses.
///
/// # Errors
/// Of the laboratory: nobody simulates any more, or the user stopped.
pub async fn diagnose<L: Laboratory>(lab: &mut L, inputs: &Inputs) -> Result<Diagnosis, L::Error> {
    let Some(record) = inputs.records.first().filter(|r| !r.cycles.is_empty()) else {
        return Ok(Diagnosis::unresolved(
            "there is no record of the calibrated condition",
        ));
    };
    let (fitted, held) = record.split();
    let model = Model::plain(inputs.space.clone());
    let Some(base) = establish(lab, inputs, &model, fitted).await? else {
        return Ok(Diagnosis::unresolved(
            "no point near the recommended parameters completes its simulation",
        ));
    };
    let phi = misfit(base.fit.chi_squared(), base.bench.metric.len());
    let whereabouts = whereabouts::look(
        lab,
        &base.bench,
        &base.fit,
        &inputs.library,
        (&inputs.settings, base.freedom),
        phi,
    )
    .await?;
    let mut diagnosis = Diagnosis {
        whereabouts: Some(whereabouts),
        assumed_noise: base.assumed,
        preflight: base.preflight.clone(),
        notes: base.notes.clone(),
        before: Some(base.fit.clone()),
        ..Diagnosis::unresolved("")
    };
    diagnosis.reason = None;
    let promised = base.fit.search.promised_decrease();
    if promised > PROMISED {
        diagnosis.reason = Some(format!(
            "the recalibration did not converge: one more step promises to lower the misfit by {:.0} %, \
             so a test would report calibration error",
            100.0 * promised
        ));
        return Ok(diagnosis);
    }
    let after = rounds(lab, inputs, &base, &mut diagnosis).await?;
    finish(lab, inputs, &base, (after, &held), &mut diagnosis).await?;
    Ok(diagnosis)
}

/// A fit that one more step promises to lower by more than this share has not converged. What lies
/// below is taken off by the tests themselves, which look at the residual after that step.
const PROMISED: f64 = 0.1;

/// Estimates, the proof and the verdict.
async fn finish<L: Laboratory>(
    lab: &mut L,
    inputs: &Inputs,
    base: &Base,
    (after, held): (Fit, &Record),
    diagnosis: &mut Diagnosis,
) -> Result<(), L::Error> {
    let mut records: Vec<(&Record, bool)> = vec![(&base.bench.record, true), (held, false)];
    records.extend(inputs.records.iter().skip(1).map(|record| (record, false)));
    records.retain(|(record, _)| !record.cycles.is_empty());
    let refinement = base.bench.refinement;
    let added = after.model.added.len();
    diagnosis.rows = show::compare(lab, &records, (&base.fit, &after), refinement).await?;
    let rival = diagnosis.rounds.first().and_then(|round| {
        let outside = round.refits.iter().find(|r| !round.set.contains(&r.id));
        outside.or_else(|| round.refits.get(1)).cloned()
    });
    if let Some(rival) = rival.filter(|_| added > 0) {
        let rows = show::compare(lab, &records, (&base.fit, &rival.fit), refinement).await?;
        diagnosis.rival = Some((rival.id, rows));
    }
    diagnosis.effects = estimates(&diagnosis.rounds, &after);
    let names = diagnosis
        .rounds
        .first()
        .is_some_and(|r| r.p_value < inputs.settings.alpha);
    let parameters = after.x().len();
    let misfit = !base.is_noise(after.chi_squared(), parameters, inputs.settings.adequacy);
    if misfit && diagnosis.generic.is_none() {
        let ratio = after.chi_squared() / base.bench.metric.len() as f64;
        diagnosis.notes.push(format!(
            "what is left is {ratio:.2} times the noise: more than noise, and not explained"
        ));
    }
    let findings = Findings {
        sound: true,
        rejected: misfit || names,
        added,
        rivals: diagnosis
            .rounds
            .iter()
            .map(|r| r.set.len())
            .max()
            .unwrap_or(0),
        generic: diagnosis.generic.is_some(),
    };
    diagnosis.verdict = verdict(&findings);
    if diagnosis.verdict == Verdict::Unresolved {
        let why = diagnosis.rounds.first().and_then(|r| r.reason.clone());
        diagnosis.reason = diagnosis.notes.last().filter(|_| !names).cloned().or(why);
    }
    diagnosis.after = Some(after);
    Ok(())
}

impl Diagnosis {
    /// Nothing but a reason.
    pub fn unresolved(reason: &str) -> Self {
        Self {
            verdict: Verdict::Unresolved,
            reason: Some(reason.to_owned()),
            effects: Vec::new(),
            rounds: Vec::new(),
            whereabouts: None,
            preflight: None,
            limits: Vec::new(),
            look_alikes: Vec::new(),
            before: None,
            after: None,
            rows: Vec::new(),
            rival: None,
            generic: None,
            assumed_noise: false,
            notes: Vec::new(),
        }
    }
}
