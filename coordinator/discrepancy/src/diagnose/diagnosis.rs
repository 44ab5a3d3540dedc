//! Result of a diagnosis with all intermediate results.
use crate::baseline::discretisation_check::Preflight;
use crate::diagnose::remainder::{Remainder, percent};
use crate::estimate::absorbed::Absorbed;
use crate::estimate::effect_size::Estimate;
use crate::estimate::experiment_design::IndistinguishablePair;
use crate::estimate::force::ForceEstimate;
use crate::estimate::limit::Limit;
use crate::estimate::neighbourhood::{Neighbourhood, NoNeighbourhood};
use crate::estimate::nuisances::NuisanceEstimate;
use crate::hypothesis::refit::Refitted;
use crate::hypothesis::round::{Round, WorkingRound};
use crate::inputs::Inputs;
use crate::laboratory::Stage;
use crate::localisation::parameter_drift::shifts::ParameterDrift;
use crate::localisation::summary::Localisation;
use crate::model::fit::{Fit, FitSummary};
use crate::validation::compare::GapRow;
use crate::validation::predictive::Prediction;
use crate::verdict::Verdict;
use nalgebra::DMatrix;
use record::noise::NoiseSource;
use serde::{Deserialize, Serialize};

/// Diagnosis with its fits and signatures, as its own steps need it.
pub(crate) type WorkingDiagnosis = Diagnosis<Fit, DMatrix<f64>>;

/// Result of a diagnosis.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Diagnosis<F = FitSummary, S = f64> {
    /// Verdict of the diagnosis.
    pub verdict: Verdict,
    /// Reason of the verdict in one sentence, where it needs one.
    pub reason: Option<String>,
    /// Share of the gap that the answer explains, and what it leaves.
    pub remainder: Remainder,
    /// Added effects, then the other members of their ambiguity sets.
    pub effects: Vec<Estimate>,
    /// Rounds of hypothesis tests.
    pub rounds: Vec<Round<F, S>>,
    /// Sizes of the candidate effects that were refitted, each from its own refit, by round.
    pub sizes: Vec<Vec<Estimate>>,
    /// Channels, orders and joints in which the residual of the recalibrated model is concentrated.
    pub localisation: Option<Localisation>,
    /// Comparison of the recalibrated model with a finer discretisation.
    pub preflight: Option<Preflight>,
    /// Comparison of the answer with a finer discretisation, or of the likeliest candidate effect that was
    /// rejected because of that comparison.
    pub preflight_after: Option<Preflight>,
    /// Detection limits of all effects.
    pub limits: Vec<Limit>,
    /// Errors of the instruments (such as gains and delays), estimated together with the answer.
    pub nuisances: Vec<NuisanceEstimate>,
    /// Effects that this record cannot reveal because the unknowns absorb them, and the data that would
    /// reveal them.
    pub absorbed: Vec<Absorbed>,
    /// Effects that this record cannot distinguish, and the data that would distinguish them.
    pub look_alikes: Vec<IndistinguishablePair>,
    /// Fit of the recalibrated model without effects.
    pub before: Option<F>,
    /// Fit of the model with the effects of the answer.
    pub after: Option<F>,
    /// Individuals about the answer, by which any quantity of the machine has an interval; `None` where the diagnosis
    /// ended before it came to an answer.
    pub neighbourhood: Option<Result<Neighbourhood, NoNeighbourhood>>,
    /// p-value of the whiteness test of the residual: of the recalibrated model, and of the answer.
    pub whiteness: Option<[f64; 2]>,
    /// Shifts of single parameters when the recalibrated model is refitted on parts of the abscissa and under
    /// other conditions.
    pub drifts: Vec<ParameterDrift>,
    /// Shifts of single parameters of the answer when refitted on parts of the abscissa and under other
    /// conditions; empty where no effect was added.
    pub drifts_after: Vec<ParameterDrift>,
    /// Misfit to each record before and after adding the effects of the answer.
    pub rows: Vec<GapRow>,
    /// Predictive scores of the answer, or of the effects withheld as suspects, by record; empty where no
    /// effect was added or no data were held out.
    pub prediction: Vec<Prediction>,
    /// Identifier of the best rejected rival effect, with its misfit to each record before and after.
    pub rival: Option<(String, Vec<GapRow>)>,
    /// Form and joint of a generic force that beats every named effect, unless the tests lack a reliable
    /// basis.
    pub generic: Option<String>,
    /// Generic force that beats every named effect, with its size, regardless of the verdict.
    pub force: Option<ForceEstimate<F>>,
    /// Source of the noise level of the fitted record: scatter of cycles, stated, or guessed.
    pub noise: NoiseSource,
    /// Stages that used up their budget of simulations.
    pub ran_out: Vec<Stage>,
    /// Further remarks for the user.
    pub notes: Vec<String>,
}

impl<F, S> Diagnosis<F, S> {
    /// Returns the effects that are no more than traces, each with its size and the reason.
    pub fn traces(&self) -> Vec<(&Estimate, &str)> {
        let mut traces: Vec<(&Estimate, &str)> = Vec::new();
        for (round, sizes) in self.rounds.iter().zip(&self.sizes) {
            let own = round.trace.as_ref().zip(round.reason.as_deref());
            let Some((id, reason)) = own else { continue };
            let size = sizes.iter().find(|size| size.id == *id && !self.holds(id));
            if let Some(size) = size.filter(|_| traces.iter().all(|(own, _)| own.id != *id)) {
                traces.push((size, reason));
            }
        }
        traces
    }

    /// Returns whether the verdict makes a claim that is not the whole answer: more than noise is left on some
    /// record, the fit needs instruments far beyond their tolerance, or a stage whose comparisons the verdict
    /// rests on used up its budget. Where no more than noise is left, the way into another minimum and the
    /// localisation could not add anything.
    pub fn is_in_part(&self) -> bool {
        let claims = match self.verdict {
            Verdict::Named | Verdict::Ambiguous | Verdict::Unlisted => true,
            Verdict::NothingDetected | Verdict::Unresolved => false,
        };
        let mut ran_out = self.ran_out.iter();
        let stopped = ran_out.any(|stage| !matches!(stage, Stage::Where | Stage::Basin));
        let Remainder { left, beyond, .. } = &self.remainder;
        claims && (stopped || !left.is_empty() || !beyond.is_empty())
    }

    /// Describes in words what the answer explains, what it leaves and where, and which stages used up their
    /// budget.
    pub(crate) fn completeness(&self, inputs: &Inputs) -> String {
        /// Number of records on which the remaining residual is described.
        const DESCRIBED: usize = 2;
        let explained = self.remainder.explained.iter();
        let explained = explained.map(|share| format!("explains {} of the gap", percent(*share)));
        let left = self.remainder.left.iter().take(DESCRIBED);
        let left = left.map(|left| left.words(&inputs.condition(left.condition)));
        let stages = self.ran_out.iter().filter(|stage| **stage != Stage::Where);
        let stages = stages.map(|stage| {
            format!(
                "the stage \"{}\" used up its budget of simulations",
                stage.name()
            )
        });
        let beyond = &self.remainder.beyond;
        let beyond = (!beyond.is_empty()).then(|| {
            format!(
                "the fit needs instruments far beyond their tolerance: {}",
                beyond.join(", ")
            )
        });
        let parts: Vec<String> = explained.chain(left).chain(beyond).chain(stages).collect();
        parts.join("; ")
    }

    /// Returns the best refit whose effect was neither added in any round nor is a member of an ambiguity
    /// set, with the first round in which an effect was added.
    pub fn rejected(&self) -> Option<(&Round<F, S>, &Refitted<F>)> {
        let round = self.rounds.iter().find(|round| round.added.is_some())?;
        let rival = round.refits.iter().find(|refit| !self.holds(&refit.id))?;
        Some((round, rival))
    }

    /// Returns whether an effect was added in some round, or is a member of the ambiguity set of one that was.
    pub fn holds(&self, id: &str) -> bool {
        let mut sets = self.rounds.iter().flat_map(|round| &round.set);
        sets.any(|member| member == id)
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
            remainder: Remainder::default(),
            effects: Vec::new(),
            rounds: Vec::new(),
            sizes: Vec::new(),
            localisation: None,
            preflight: None,
            preflight_after: None,
            limits: Vec::new(),
            nuisances: Vec::new(),
            absorbed: Vec::new(),
            look_alikes: Vec::new(),
            before: None,
            after: None,
            neighbourhood: None,
            whiteness: None,
            drifts: Vec::new(),
            drifts_after: Vec::new(),
            rows: Vec::new(),
            prediction: Vec::new(),
            rival: None,
            generic: None,
            force: None,
            noise: NoiseSource::Measured,
            ran_out: Vec::new(),
            notes: Vec::new(),
        }
    }
}

impl WorkingDiagnosis {
    /// Withdraws an effect from every round that added it, and records the reason.
    pub(crate) fn withdraw(&mut self, id: &str, reason: &str) {
        let rounds = self.rounds.iter_mut();
        for round in rounds.filter(|round| round.added.as_deref() == Some(id)) {
            round.withdraw(reason.to_owned());
        }
    }

    /// Returns the diagnosis as reports read it: with summaries of its fits and signatures.
    pub(crate) fn summary(self) -> Diagnosis {
        let rounds = self.rounds.into_iter().map(WorkingRound::summary);
        Diagnosis {
            before: self.before.map(|fit| fit.summary()),
            after: self.after.map(|fit| fit.summary()),
            rounds: rounds.collect(),
            force: self.force.map(ForceEstimate::summary),
            verdict: self.verdict,
            reason: self.reason,
            remainder: self.remainder,
            effects: self.effects,
            sizes: self.sizes,
            localisation: self.localisation,
            preflight: self.preflight,
            preflight_after: self.preflight_after,
            limits: self.limits,
            nuisances: self.nuisances,
            absorbed: self.absorbed,
            look_alikes: self.look_alikes,
            neighbourhood: self.neighbourhood,
            whiteness: self.whiteness,
            drifts: self.drifts,
            drifts_after: self.drifts_after,
            rows: self.rows,
            prediction: self.prediction,
            rival: self.rival,
            generic: self.generic,
            noise: self.noise,
            ran_out: self.ran_out,
            notes: self.notes,
        }
    }
}
