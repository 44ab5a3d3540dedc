//! The answer of a diagnosis, and all that it rests on.
use crate::cause::refit::Refitted;
use crate::cause::round::Round;
use crate::ground::preflight::Preflight;
use crate::laboratory::Stage;
use crate::model::fit::Fit;
use crate::place::wander::shifts::Wander;
use crate::place::whereabouts::Where;
use crate::proof::compare::Row;
use crate::proof::predictive::Prediction;
use crate::record::noise::Known;
use crate::size::absorbed::Absorbed;
use crate::size::data_value::LookAlikes;
use crate::size::estimate::Estimate;
use crate::size::force::Force;
use crate::size::limit::Limit;
use crate::size::never_exact::NeverExact;
use crate::verdict::Verdict;

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
    /// Sizes of the suspects that were refitted, each by its own refit, round by round.
    pub sizes: Vec<Vec<Estimate>>,
    /// Where the recalibrated model and the record part.
    pub whereabouts: Option<Where>,
    /// The numerical check of the recalibrated model.
    pub preflight: Option<Preflight>,
    /// That of the answer, or of the likeliest suspect that was dropped for it.
    pub preflight_after: Option<Preflight>,
    /// Detection limits of all effects.
    pub limits: Vec<Limit>,
    /// What the instruments are off by, beside the answer.
    pub nuisances: Vec<NeverExact>,
    /// Effects that this record cannot show, and what would.
    pub absorbed: Vec<Absorbed>,
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
    /// Predictive scores of the answer, or of what is withheld as a suspect, by record; empty where nothing was added or
    /// nothing was held out.
    pub prediction: Vec<Prediction>,
    /// The best rejected rival and its gap by record.
    pub rival: Option<(String, Vec<Row>)>,
    /// Form and joint of a force that beats every name, where nothing speaks against saying so.
    pub generic: Option<String>,
    /// A force that beats every name, with its size, whatever the verdict says of it.
    pub force: Option<Force>,
    /// How the noise is known.
    pub noise: Known,
    /// Stages that used up their part of the simulations.
    pub ran_out: Vec<Stage>,
    /// What else should be known.
    pub notes: Vec<String>,
}

impl Diagnosis {
    /// The best refit that no answer holds, neither as added nor as a member of an ambiguity set, with
    /// the first round in which something was added.
    pub fn rejected(&self) -> Option<(&Round, &Refitted)> {
        let round = self.rounds.iter().find(|round| round.added.is_some())?;
        let held = |id: &String| self.rounds.iter().any(|round| round.set.contains(id));
        let rival = round.refits.iter().find(|refit| !held(&refit.id))?;
        Some((round, rival))
    }

    /// Detection limits of the effects that the answer does not name.
    pub fn detection_limits(&self) -> impl Iterator<Item = &Limit> {
        let named = |limit: &&Limit| self.effects.iter().any(|own| own.id == limit.id);
        self.limits.iter().filter(move |limit| !named(limit))
    }

    /// Nothing but a reason.
    pub fn unresolved(reason: &str) -> Self {
        Self {
            verdict: Verdict::Unresolved,
            reason: Some(reason.to_owned()),
            effects: Vec::new(),
            rounds: Vec::new(),
            sizes: Vec::new(),
            whereabouts: None,
            preflight: None,
            preflight_after: None,
            limits: Vec::new(),
            nuisances: Vec::new(),
            absorbed: Vec::new(),
            look_alikes: Vec::new(),
            before: None,
            after: None,
            whiteness: None,
            wander: Vec::new(),
            wander_after: Vec::new(),
            rows: Vec::new(),
            prediction: Vec::new(),
            rival: None,
            generic: None,
            force: None,
            noise: Known::Seen,
            ran_out: Vec::new(),
            notes: Vec::new(),
        }
    }
}
