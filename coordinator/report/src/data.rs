//! Plain data of a report, as handed over by the study, before any drawing.
//!
//! Every name of a quantity states its unit. Independent of files, clocks and workers.
use crate::assessment::MachineAssessment;
use discrepancy::identify::{Determination, UnknownEstimate};
use discrepancy::validation::gap::Gap;
use journal::account::{JobCost, Presence};
use journal::event::{Spent, WorkerAccount};
use protocol::case::{Case, Channel, ChannelRecord, WeightedCondition};
use protocol::job::{Curves, Evaluation, Verdict};

/// One parameter set of a calibration.
#[derive(Clone, Debug, PartialEq)]
pub struct Individual {
    /// Number of the individual in the evaluation log; `None` if it was not proposed by the search.
    pub id: Option<u64>,
    /// Gene values in declared units, in the case's order.
    pub genes: Vec<f64>,
}

/// Evaluation of one individual, from the evaluation log of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct HistoryPoint {
    /// Number of the individual, consecutive from 0 over the whole run.
    pub id: u64,
    /// Generation (or batch) in which the individual was proposed.
    pub generation: u32,
    /// Purpose for which the search proposed the individual, in one word.
    pub purpose: String,
    /// Gene values in declared units, in the case's order.
    pub genes: Vec<f64>,
    /// Objective of the individual, in its squared unit, if the simulation is complete; otherwise a graded
    /// value above that of every complete one.
    pub fitness: f64,
    /// Whether the simulation ran to its end.
    pub complete: bool,
    /// Reason for an early end of the simulation, in words.
    pub failure: Option<String>,
    /// Cost of the simulation; `None` if unknown.
    pub cost: Option<JobCost>,
}

/// Result of simulating one parameter set under one condition: agreement with the measured record, and
/// curves.
#[derive(Clone, Debug, PartialEq)]
pub struct ScoredCurves {
    /// Agreement with the measured record; without channels if there is no record or no complete simulation.
    pub evaluation: Evaluation,
    /// Simulated curves of the channels; they end at a failure of the simulation.
    pub curves: Curves,
}

impl ScoredCurves {
    /// Returns a view of this simulation's curves together with its case and the index of its condition.
    pub const fn shown<'a>(&'a self, case: &'a Case, condition: usize) -> SimulationView<'a> {
        SimulationView {
            case,
            condition,
            curves: &self.curves,
        }
    }

    /// Returns the gap (share of the measured variance left unexplained) of each measured channel of a
    /// condition, with the channel; a limit is not to be explained.
    pub fn gaps<'a>(&self, case: &'a Case, condition: usize) -> Vec<(&'a Channel, Gap)> {
        let shown = self.shown(case, condition);
        let gap = |(_, channel, record): (usize, &'a Channel, &ChannelRecord)| {
            let of = (record, channel.noise);
            let gap = Gap::between(of, shown.channel(channel), channel.is_absolute())?;
            Some((channel, gap))
        };
        let measured = case.measured(condition);
        let met = measured.filter(|(_, channel, _)| channel.limit.is_none());
        met.filter_map(gap).collect()
    }
}

/// Simulation to be shown, with its case and condition.
#[derive(Clone, Copy, Debug)]
pub struct SimulationView<'a> {
    /// Simulated case.
    pub case: &'a Case,
    /// Index of the condition in the case.
    pub condition: usize,
    /// Simulated curves of the channels; they end at a failure of the simulation.
    pub curves: &'a Curves,
}

impl<'a> SimulationView<'a> {
    /// Returns the simulated curve of a channel; it ends at a failure of the simulation.
    pub fn channel(&self, channel: &Channel) -> &'a [f64] {
        let mut all = self.case.channels_of(channel.condition);
        let place = all.position(|(_, other)| other.name == channel.name);
        let curve = place.and_then(|place| self.curves.channels.get(place));
        curve.map_or(&[], Vec::as_slice)
    }
}

/// Results of the recommended and the optimised parameters under one condition.
#[derive(Clone, Debug, PartialEq)]
pub struct ConditionResult {
    /// Index of the condition in the case.
    pub condition: usize,
    /// Result of simulating the recommended parameters.
    pub recommended: ScoredCurves,
    /// Result of simulating the optimised parameters.
    pub optimised: ScoredCurves,
}

/// Provenance of a result, sufficient to reproduce it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Origin {
    /// Name and version of the program that computed the result.
    pub program: String,
    /// Command line that reproduces the result.
    pub command: String,
    /// Name of the run.
    pub run: String,
    /// Content hash of the case.
    pub case_hash: String,
    /// Source of the measured records.
    pub measured_name: String,
    /// Whether the case's records were computed by a simulation instead of measured on a machine.
    pub synthetic: bool,
    /// Search preset, if there was a search.
    pub preset: Option<String>,
    /// Seed of all random choices, if there was one.
    pub seed: Option<u64>,
    /// Digest of the evaluation log in index order, or of the result's bits.
    pub digest: String,
}

/// Finished or stopped calibration.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// Calibrated case.
    pub case: Case,
    /// Provenance of the calibration.
    pub origin: Origin,
    /// Starting point with the recommended parameters.
    pub recommended: Individual,
    /// Best individual found.
    pub optimised: Individual,
    /// The evaluation log in index order.
    pub history: Vec<HistoryPoint>,
    /// Contribution of each worker to the calibration.
    pub workers: Vec<WorkerAccount>,
    /// Presence of the workers over the working time of the run.
    pub presence: Vec<Presence>,
    /// Slot time of all workers by use, over all sessions of the run.
    pub spent: Spent,
    /// Wall time of the whole run, in seconds.
    pub wall_s: f64,
    /// Reason for which the search ended, in words.
    pub finish: String,
    /// Results per condition, conventionally the calibrated condition first.
    pub conditions: Vec<ConditionResult>,
    /// First-order estimate, for each searched unknown, of the interval that the measured record determines;
    /// empty if not computed.
    pub identifiability: Vec<UnknownEstimate>,
    /// Best fit of every other family whose objective lies near the best one, best first: the record decides
    /// only weakly between them.
    pub rivals: Vec<RivalFit>,
    /// Assessments that were made of the optimum.
    pub assessments: Vec<MachineAssessment>,
    /// Further notes and warnings, one sentence each.
    pub notes: Vec<String>,
}

/// Fit whose objective lies near the best one, with another value of an unknown that the record determines.
#[derive(Clone, Debug, PartialEq)]
pub struct RivalFit {
    /// Values of the unknowns, in the case's order.
    pub genes: Vec<f64>,
    /// Objective of the fit.
    pub objective: f64,
    /// Names of the unknowns that the record determines and in which the fit differs from the best one.
    pub differs: Vec<String>,
}

/// Returns whether the record bounds an unknown on both sides, by its first-order estimate.
pub fn is_determined(identifiability: &[UnknownEstimate], name: &str) -> bool {
    let mut said = identifiability.iter();
    said.any(|own| own.name == name && own.seen == Determination::Both)
}

impl Calibration {
    /// Returns the simulation with the optimised parameters under the calibrated condition.
    pub fn optimum(&self) -> Option<SimulationView<'_>> {
        let result = self.calibrated()?;
        Some(result.optimised.shown(&self.case, result.condition))
    }

    /// Returns views of all simulations of the calibration, condition by condition, each with the name of its
    /// parameter set (recommended or optimised).
    pub fn shown(&self) -> Vec<(&'static str, SimulationView<'_>)> {
        let both = self.conditions.iter().flat_map(|result| {
            let runs = [
                ("recommended", &result.recommended),
                ("optimised", &result.optimised),
            ];
            runs.map(|(who, run)| (who, run.shown(&self.case, result.condition)))
        });
        both.collect()
    }

    /// Returns the verdict on a parameter set's simulations under the calibrated conditions, and the
    /// objective summed over these conditions with their weights; `None` if one of them has no result.
    pub fn objective(
        &self,
        of: impl Fn(&ConditionResult) -> &ScoredCurves,
    ) -> Option<(Verdict, f64)> {
        let mut whole = (Verdict::Complete, 0.0);
        for WeightedCondition { condition, weight } in self.case.objective.weighted_conditions() {
            let mut results = self.conditions.iter();
            let result = results.find(|result| result.condition == condition)?;
            let evaluation = &of(result).evaluation;
            if evaluation.verdict != Verdict::Complete {
                return Some((evaluation.verdict, evaluation.fitness));
            }
            whole.1 += weight * evaluation.fitness;
        }
        Some(whole)
    }

    /// Returns the results under the calibrated condition, the first one if there are several.
    pub fn calibrated(&self) -> Option<&ConditionResult> {
        self.conditions
            .iter()
            .find(|result| result.condition == self.case.objective.condition)
    }
}

/// Data of a single simulation, for a report of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct SingleRun {
    /// Simulated case.
    pub case: Case,
    /// Provenance of the simulation.
    pub origin: Origin,
    /// Index of the condition in the case.
    pub condition: usize,
    /// Source of the genes: `recommended` or a file name.
    pub genes_name: String,
    /// Gene values in declared units, in the case's order.
    pub genes: Vec<f64>,
    /// Agreement of the simulation with the measured record, if evaluated.
    pub evaluation: Option<Evaluation>,
    /// Simulated curves of the channels; they end at a failure of the simulation.
    pub curves: Curves,
    /// Names of the unknowns with respect to which the curves were differentiated, in the order of the
    /// curves' derivative columns.
    pub derived: Vec<String>,
    /// Further notes and warnings, one sentence each.
    pub notes: Vec<String>,
}

impl SingleRun {
    /// Returns a view of the simulation's curves together with its case and the index of its condition.
    pub const fn shown(&self) -> SimulationView<'_> {
        SimulationView {
            case: &self.case,
            condition: self.condition,
            curves: &self.curves,
        }
    }
}
