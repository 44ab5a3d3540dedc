//! Result of a diagnosis with all intermediate results.
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

/// Result of a diagnosis.
#[derive(Clone, Debug)]
pub struct Diagnosis {
    /// Verdict.
    pub verdict: Verdict,
    /// Reason of the verdict in one sentence, where it needs one.
    pub reason: Option<String>,
    /// Added effects, then the other members of their ambiguity sets.
    pub effects: Vec<Estimate>,
    /// Rounds of hypothesis tests.
    pub rounds: Vec<Round>,
    /// Sizes of the candidate effects that were refitted, each from its own refit, by round.
    pub sizes: Vec<Vec<Estimate>>,
    /// Localisation of the residual of the recalibrated model.
    pub whereabouts: Option<Where>,
    /// The numerical check of the recalibrated model.
    pub preflight: Option<Preflight>,
    /// Numerical check of the answer, or of the likeliest candidate effect that was rejected because of that
    /// check.
    pub preflight_after: Option<Preflight>,
    /// Detection limits of all effects.
    pub limits: Vec<Limit>,
    /// Estimated errors of the instruments under the answer.
    pub nuisances: Vec<NeverExact>,
    /// Effects that this record cannot reveal because the unknowns absorb them, and the data that would
    /// reveal them.
    pub absorbed: Vec<Absorbed>,
    /// Effects that this record cannot distinguish, and the data that would distinguish them.
    pub look_alikes: Vec<LookAlikes>,
    /// The recalibrated model without effects.
    pub before: Option<Fit>,
    /// The model of the answer.
    pub after: Option<Fit>,
    /// p-value of the whiteness test of the residual: of the recalibrated model, and of the answer.
    pub whiteness: Option<[f64; 2]>,
    /// Shifts of single parameters of the recalibrated model when refitted on parts of the abscissa and under
    /// other conditions.
    pub wander: Vec<Wander>,
    /// Shifts of single parameters of the answer when refitted on parts of the abscissa and under other
    /// conditions; empty where no effect was added.
    pub wander_after: Vec<Wander>,
    /// Gap of the answer, by record.
    pub rows: Vec<Row>,
    /// Predictive scores of the answer, or of the effects withheld as suspects, by record; empty where no
    /// effect was added or no data were held out.
    pub prediction: Vec<Prediction>,
    /// The best rejected rival and its gap by record.
    pub rival: Option<(String, Vec<Row>)>,
    /// Form and joint of a generic force that beats every named effect, unless its basis is in doubt.
    pub generic: Option<String>,
    /// Generic force that beats every named effect, with its size, regardless of the verdict.
    pub force: Option<Force>,
    /// Source of the noise level.
    pub noise: Known,
    /// Stages that used up their budget of simulations.
    pub ran_out: Vec<Stage>,
    /// Further remarks for the user.
    pub notes: Vec<String>,
}

impl Diagnosis {
    /// Returns the best refit whose effect is in no answer, neither as added nor as a member of an ambiguity
    /// set, with the first round in which an effect was added.
    pub fn rejected(&self) -> Option<(&Round, &Refitted)> {
        let round = self.rounds.iter().find(|round| round.added.is_some())?;
        let held = |id: &String| self.rounds.iter().any(|round| round.set.contains(id));
        let rival = round.refits.iter().find(|refit| !held(&refit.id))?;
        Some((round, rival))
    }

    /// Returns the detection limits of the effects that the answer does not name.
    pub fn detection_limits(&self) -> impl Iterator<Item = &Limit> {
        let named = |limit: &&Limit| self.effects.iter().any(|own| own.id == limit.id);
        self.limits.iter().filter(move |limit| !named(limit))
    }

    /// Creates an unresolved diagnosis that has only a reason.
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
