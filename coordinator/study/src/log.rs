//! Evaluation log: all individuals of a search in index order, and a digest of these.
use protocol::job::{Evaluation, Failure, Identifier, Verdict};
use search::strategy::{EvaluationResult, Proposal, Purpose};
use std::collections::BTreeMap;

/// Outcome of an evaluation.
#[derive(Clone, Debug, PartialEq)]
pub enum EvaluationOutcome {
    /// The whole revolution was simulated.
    Complete,
    /// The simulated machine failed before the end of the revolution.
    Physics(Identifier),
    /// The job could not be computed, for example because its worker was lost.
    Infrastructure(Failure),
}

impl EvaluationOutcome {
    /// Describes the failure in words; returns none for a complete simulation.
    pub fn failure(&self) -> Option<String> {
        match self {
            Self::Complete => None,
            Self::Physics(kind) => Some(kind.with_spaces()),
            Self::Infrastructure(failure) => Some(failure.to_string()),
        }
    }
}

/// Log entry of one evaluated individual.
#[derive(Clone, Debug, PartialEq)]
pub struct LogEntry {
    /// Index of the individual, consecutive from 0.
    pub id: u64,
    /// Generation of the search in which the individual was proposed.
    pub generation: u32,
    /// Purpose for which the search proposed the individual.
    pub purpose: Purpose,
    /// Values of the unknowns in declared units, in the order of the case.
    pub genes: Vec<f64>,
    /// Fitness reported to the search: the objective if complete, otherwise a graded penalty.
    pub fitness: f64,
    /// Outcome of the individual's evaluation.
    pub ending: EvaluationOutcome,
}

impl LogEntry {
    /// Creates the log entry of a proposal whose evaluation was returned.
    pub(super) fn scored(proposal: Proposal, evaluation: &Evaluation) -> Self {
        let ending = match evaluation.verdict {
            Verdict::Complete => EvaluationOutcome::Complete,
            Verdict::Failed { kind, .. } => EvaluationOutcome::Physics(kind),
        };
        Self::new(proposal, evaluation.fitness, ending)
    }

    /// Creates the entry of a proposal that could not be evaluated, with infinite fitness.
    pub(super) fn lost(proposal: Proposal, failure: Failure) -> Self {
        Self::new(
            proposal,
            f64::INFINITY,
            EvaluationOutcome::Infrastructure(failure),
        )
    }

    fn new(proposal: Proposal, fitness: f64, ending: EvaluationOutcome) -> Self {
        let Proposal {
            id,
            genes,
            generation,
            purpose,
        } = proposal;
        Self {
            id,
            generation,
            purpose,
            genes,
            fitness,
            ending,
        }
    }

    /// Returns the entry's fitness, and whether its simulation was complete, for the search strategy.
    pub(super) fn strategy_result(&self) -> EvaluationResult {
        EvaluationResult {
            fitness: self.fitness,
            complete: self.ending == EvaluationOutcome::Complete,
        }
    }
}

/// Log of all evaluated individuals of a search, by id.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EvaluationLog {
    entries: BTreeMap<u64, LogEntry>,
}

impl EvaluationLog {
    /// Returns the log entries in the order of their ids.
    pub fn entries(&self) -> impl ExactSizeIterator<Item = &LogEntry> {
        self.entries.values()
    }

    /// Returns the log entry of an individual; `None` if it was not evaluated.
    pub fn get(&self, id: u64) -> Option<&LogEntry> {
        self.entries.get(&id)
    }

    /// Returns the number of evaluated individuals in the log.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Returns whether no individual has been evaluated yet.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Returns the number of individuals whose simulation was not completed.
    pub fn failed(&self) -> usize {
        self.entries()
            .filter(|entry| entry.ending != EvaluationOutcome::Complete)
            .count()
    }

    /// Computes the BLAKE3 digest over id, values of the unknowns and fitness of every log entry in id order
    /// (little endian), as 64 hexadecimal digits. Two searches with the same digest evaluated the same
    /// individuals with the same results.
    pub fn digest(&self) -> String {
        let mut hasher = blake3::Hasher::new();
        for entry in self.entries() {
            hasher.update(&entry.id.to_le_bytes());
            for gene in &entry.genes {
                hasher.update(&gene.to_bits().to_le_bytes());
            }
            hasher.update(&entry.fitness.to_bits().to_le_bytes());
        }
        hasher.finalize().to_hex().to_string()
    }

    /// Removes the entries with ids from `count` on.
    pub(super) fn truncate(&mut self, count: u64) {
        self.entries.split_off(&count);
    }

    pub(super) fn insert(&mut self, entry: LogEntry) {
        self.entries.insert(entry.id, entry);
    }

    /// Returns the failures by frequency, for example `12 x load not lifted, 3 x budget` (a single kind
    /// without its count), and the most frequent physical failure.
    pub(super) fn failures(&self) -> (String, Option<Identifier>) {
        let mut counts: BTreeMap<String, (usize, Option<Identifier>)> = BTreeMap::new();
        for entry in self.entries() {
            let physics = match entry.ending {
                EvaluationOutcome::Complete => continue,
                EvaluationOutcome::Physics(kind) => Some(kind),
                EvaluationOutcome::Infrastructure(_) => None,
            };
            let words = entry.ending.failure().unwrap_or_default();
            counts.entry(words).or_insert((0, physics)).0 += 1;
        }
        let mut ranked: Vec<_> = counts.into_iter().collect();
        ranked.sort_by_key(|(_, (count, _))| std::cmp::Reverse(*count));
        let words: Vec<String> = match ranked.as_slice() {
            [(words, _)] => vec![words.clone()],
            several => several
                .iter()
                .map(|(words, (count, _))| format!("{count} x {words}"))
                .collect(),
        };
        (
            words.join(", "),
            ranked.iter().find_map(|(_, (_, physics))| *physics),
        )
    }
}
