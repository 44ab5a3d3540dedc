//! A diagnosis from the record to the verdict: the order of the stages and what they hand on.
use crate::bench::Fit;
use crate::conclude::conclude;
pub use crate::estimate::{Estimate, Limit};
use crate::evidence::misfit;
pub use crate::force::Force;
use crate::laboratory::Laboratory;
use crate::locate::wander::Wander;
use crate::model::Model;
use crate::record::Record;
pub use crate::rounds::Round;
use crate::rounds::rounds;
use crate::settings::Settings;
use crate::stage::establish::establish;
use crate::stage::preflight::Preflight;
use crate::stage::refit::Refitted;
use crate::stage::show::Row;
use crate::stage::whereabouts;
use crate::stage::whereabouts::Where;
pub use crate::stage::worth::LookAlikes;
use crate::verdict::Verdict;
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
    /// A calibrated point (coordinates of the space), if there is one.
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

impl Inputs {
    /// The effects of the library that nobody has put aside.
    pub(crate) fn considered(&self) -> impl Iterator<Item = &EffectDescriptor> {
        let without = &self.settings.without;
        let kept = |effect: &&EffectDescriptor| !without.contains(&effect.id);
        self.library.iter().filter(kept)
    }
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
    /// The numerical check of the recalibrated model.
    pub preflight: Option<Preflight>,
    /// That of the answer, or of the likeliest suspect that was dropped for it.
    pub preflight_after: Option<Preflight>,
    /// Detection limits of all effects.
    pub limits: Vec<Limit>,
    /// Effects that this record cannot tell apart, and what would.
    pub look_alikes: Vec<LookAlikes>,
    /// The recalibrated model without effects.
    pub before: Option<Fit>,
    /// The model of the answer.
    pub after: Option<Fit>,
    /// Tail probability that what is left is white: by the recalibrated model, and by the answer.
    pub whiteness: Option<[f64; 2]>,
    /// How the parameters of the recalibrated model would have to wander.
    pub wander: Vec<Wander>,
    /// The same of the answer; empty where nothing was added.
    pub wander_after: Vec<Wander>,
    /// The gap of the answer by record.
    pub rows: Vec<Row>,
    /// The best rejected rival and its gap by record.
    pub rival: Option<(String, Vec<Row>)>,
    /// Form and joint of a force that beats every name, where nothing speaks against saying so.
    pub generic: Option<String>,
    /// A force that beats every name, with its size, whatever the verdict says of it.
    pub force: Option<Force>,
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
    conclude(lab, inputs, &base, (after, &held), &mut diagnosis).await?;
    Ok(diagnosis)
}

/// A fit that one more step promises to lower by more than this share has not converged. What lies
/// below is taken off by the tests themselves, which look at the residual after that step.
const PROMISED: f64 = 0.1;

impl Diagnosis {
    /// The best refit that no answer holds, neither as added nor as a member of an ambiguity set, with
    /// the first round in which something was added.
    pub fn rejected(&self) -> Option<(&Round, &Refitted)> {
        let round = self.rounds.iter().find(|round| round.added.is_some())?;
        let held = |id: &String| self.rounds.iter().any(|round| round.set.contains(id));
        let rival = round.refits.iter().find(|refit| !held(&refit.id))?;
        Some((round, rival))
    }

    /// Nothing but a reason.
    pub fn unresolved(reason: &str) -> Self {
        Self {
            verdict: Verdict::Unresolved,
            reason: Some(reason.to_owned()),
            effects: Vec::new(),
            rounds: Vec::new(),
            whereabouts: None,
            preflight: None,
            preflight_after: None,
            limits: Vec::new(),
            look_alikes: Vec::new(),
            before: None,
            after: None,
            whiteness: None,
            wander: Vec::new(),
            wander_after: Vec::new(),
            rows: Vec::new(),
            rival: None,
            generic: None,
            force: None,
            assumed_noise: false,
            notes: Vec::new(),
        }
    }
}
