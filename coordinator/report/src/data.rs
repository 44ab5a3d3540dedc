//! Plain data that a report is made of: what the study hands over, nothing drawn yet.
//!
//! Every value carries its unit in its name. Nothing here knows of files, clocks or workers.
use discrepancy::identify::UnknownEstimate;
use discrepancy::proof::gap::Gap;
use dispatch::account::JobCost;
use protocol::case::{Case, Channel, ChannelRecord};
use protocol::event::Spent;
use protocol::job::{Curves, Evaluation, Verdict};

/// One parameter set of a calibration.
#[derive(Clone, Debug, PartialEq)]
pub struct Individual {
    /// Its number in the evaluation log; none where it was not proposed by the search.
    pub id: Option<u64>,
    /// Gene values in declared units, in the case's order.
    pub genes: Vec<f64>,
}

/// One entry of the evaluation log.
#[derive(Clone, Debug, PartialEq)]
pub struct HistoryPoint {
    /// Number of the individual, consecutive from 0 over the whole run.
    pub id: u64,
    /// Generation (or batch) it was proposed in.
    pub generation: u32,
    /// What the search wanted it for, in one word.
    pub purpose: String,
    /// Gene values in declared units, in the case's order.
    pub genes: Vec<f64>,
    /// Objective in its squared unit if complete, a graded value above every complete one's otherwise.
    pub fitness: f64,
    /// Whether it was simulated to its end.
    pub complete: bool,
    /// What ended it early, in words.
    pub failure: Option<String>,
    /// What its simulation cost; none where nothing is known of it.
    pub cost: Option<JobCost>,
}

/// What one worker contributed.
#[derive(Clone, Debug, PartialEq)]
pub struct WorkerUse {
    /// Name of the worker, as the tables show it.
    pub name: String,
    /// Host it ran on.
    pub host: String,
    /// Simulations it ran at a time.
    pub slots: u32,
    /// Jobs whose result was accepted.
    pub done: u64,
    /// Jobs that could not be done there.
    pub failed: u64,
    /// Time its slots spent computing, summed over slots, in seconds.
    pub busy_s: f64,
    /// Time it was attached, in seconds.
    pub present_s: f64,
}

impl WorkerUse {
    /// Share of the worker's slot time that was spent computing, 0 to 1; none if it was never
    /// attached for a measurable time.
    pub fn busy_share(&self) -> Option<f64> {
        let available_s = self.present_s * f64::from(self.slots);
        (available_s > 0.0 && self.busy_s.is_finite()).then(|| self.busy_s / available_s)
    }
}

/// One parameter set under one condition: how well it agrees, and its curves.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Agreement with the record; its channels are empty if there is no record or no complete run.
    pub evaluation: Evaluation,
    /// The curves, as far as the simulation got.
    pub curves: Curves,
}

impl Run {
    /// The simulation, under a condition of its case.
    pub const fn shown<'a>(&'a self, case: &'a Case, condition: usize) -> Shown<'a> {
        Shown {
            case,
            condition,
            curves: &self.curves,
        }
    }

    /// What it leaves of the measured channels of a condition.
    pub fn gaps<'a>(&self, case: &'a Case, condition: usize) -> Vec<(&'a Channel, Gap)> {
        let shown = self.shown(case, condition);
        let gap = |(_, channel, record): (usize, &'a Channel, &ChannelRecord)| {
            let gap = Gap::between(record, shown.channel(channel), channel.is_absolute())?;
            Some((channel, gap))
        };
        case.measured(condition).filter_map(gap).collect()
    }
}

/// One simulation, to be shown.
#[derive(Clone, Copy, Debug)]
pub struct Shown<'a> {
    /// The case that was simulated.
    pub case: &'a Case,
    /// Index of the condition in the case.
    pub condition: usize,
    /// Its curves, as far as it got.
    pub curves: &'a Curves,
}

impl<'a> Shown<'a> {
    /// The curve of a channel of its condition, as far as the simulation got.
    pub fn channel(&self, channel: &Channel) -> &'a [f64] {
        let mut all = self.case.channels_of(channel.condition);
        let place = all.position(|(_, other)| other.name == channel.name);
        let curve = place.and_then(|place| self.curves.channels.get(place));
        curve.map_or(&[], Vec::as_slice)
    }
}

/// Both parameter sets under one condition.
#[derive(Clone, Debug, PartialEq)]
pub struct ConditionResult {
    /// Index of the condition in the case.
    pub condition: usize,
    /// With the recommended parameters.
    pub recommended: Run,
    /// With the optimised parameters.
    pub optimised: Run,
}

/// Everything that identifies how a result was made.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Origin {
    /// Program and version.
    pub program: String,
    /// Command line that makes it again.
    pub command: String,
    /// Name of the run.
    pub run: String,
    /// Content hash of the case.
    pub case_hash: String,
    /// Where the measured records came from.
    pub measured_name: String,
    /// Whether those records were computed, not measured on a machine.
    pub synthetic: bool,
    /// Search preset, where there was a search.
    pub preset: Option<String>,
    /// Seed of every random choice, where there was one.
    pub seed: Option<u64>,
    /// Digest of the evaluation log in index order, or of the result's bits.
    pub digest: String,
}

/// A finished (or stopped) calibration.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// The case that was calibrated.
    pub case: Case,
    /// How it was made.
    pub origin: Origin,
    /// The starting point.
    pub recommended: Individual,
    /// The best individual that was found.
    pub optimised: Individual,
    /// The evaluation log in index order.
    pub history: Vec<HistoryPoint>,
    /// Who computed.
    pub workers: Vec<WorkerUse>,
    /// How all slots spent their time, in all sessions of the run.
    pub spent: Spent,
    /// Wall time of the whole run, in seconds.
    pub wall_s: f64,
    /// Why the search ended, in words.
    pub finish: String,
    /// Results per condition; the calibrated one first by custom.
    pub conditions: Vec<ConditionResult>,
    /// What the record says of the unknowns that were searched, to first order; empty where nobody looked.
    pub seen: Vec<UnknownEstimate>,
    /// Further notes and warnings, one sentence each.
    pub notes: Vec<String>,
}

impl Calibration {
    /// What the optimised parameters give under the calibrated condition.
    pub fn optimum(&self) -> Option<Shown<'_>> {
        let result = self.calibrated()?;
        Some(result.optimised.shown(&self.case, result.condition))
    }

    /// What was simulated, condition by condition, with the name of the parameters.
    pub fn shown(&self) -> Vec<(&'static str, Shown<'_>)> {
        let both = self.conditions.iter().flat_map(|result| {
            let runs = [
                ("recommended", &result.recommended),
                ("optimised", &result.optimised),
            ];
            runs.map(|(who, run)| (who, run.shown(&self.case, result.condition)))
        });
        both.collect()
    }

    /// How a parameter set ended under the conditions that were calibrated, and the sum of what it came to there;
    /// none where one of them has no result.
    pub fn objective(&self, of: impl Fn(&ConditionResult) -> &Run) -> Option<(Verdict, f64)> {
        let mut whole = (Verdict::Complete, 0.0);
        for condition in self.case.objective.conditions() {
            let mut results = self.conditions.iter();
            let result = results.find(|result| result.condition == condition)?;
            let evaluation = &of(result).evaluation;
            if evaluation.verdict != Verdict::Complete {
                return Some((evaluation.verdict, evaluation.fitness));
            }
            whole.1 += evaluation.fitness;
        }
        Some(whole)
    }

    /// The result under the condition that was calibrated, the first one of several.
    pub fn calibrated(&self) -> Option<&ConditionResult> {
        self.conditions
            .iter()
            .find(|result| result.condition == self.case.objective.condition)
    }
}

/// One simulation, to be shown by itself.
#[derive(Clone, Debug, PartialEq)]
pub struct SingleRun {
    /// The case that was simulated.
    pub case: Case,
    /// How it was made.
    pub origin: Origin,
    /// Index of the condition in the case.
    pub condition: usize,
    /// Where the genes came from, as `recommended` or a file name.
    pub genes_name: String,
    /// Gene values in declared units, in the case's order.
    pub genes: Vec<f64>,
    /// Agreement with the record, where it was scored.
    pub evaluation: Option<Evaluation>,
    /// The curves.
    pub curves: Curves,
    /// What they were differentiated by, in the order of their columns.
    pub derived: Vec<String>,
    /// Further notes and warnings, one sentence each.
    pub notes: Vec<String>,
}

impl SingleRun {
    /// What was simulated.
    pub const fn shown(&self) -> Shown<'_> {
        Shown {
            case: &self.case,
            condition: self.condition,
            curves: &self.curves,
        }
    }
}
