//! The evaluation log: every individual of a run in index order, and its digest.
use protocol::job::{Evaluation, Failure, Verdict, Word};
use search::strategy::{Proposal, Purpose, Told};
use std::collections::BTreeMap;

/// How an evaluation ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// The whole revolution was simulated.
    Complete,
    /// The machine failed on the way.
    Physics(Word),
    /// It could not be computed.
    Infrastructure(Failure),
}

impl Ending {
    /// What went wrong, in words; none if nothing did.
    pub fn failure(&self) -> Option<String> {
        match self {
            Self::Complete => None,
            Self::Physics(kind) => Some(kind.spoken()),
            Self::Infrastructure(failure) => Some(failure.to_string()),
        }
    }
}

/// One evaluated individual.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Consecutive from 0.
    pub id: u64,
    /// Generation it was proposed in.
    pub generation: u32,
    /// What the search wanted it for.
    pub purpose: Purpose,
    /// Gene values in declared units, in the case's order.
    pub genes: Vec<f64>,
    /// What the search was told: the objective if complete, a grade otherwise.
    pub fitness: f64,
    /// How it ended.
    pub ending: Ending,
}

impl Entry {
    /// A proposal that was evaluated.
    pub(super) fn scored(proposal: Proposal, evaluation: &Evaluation) -> Self {
        let ending = match evaluation.verdict {
            Verdict::Complete => Ending::Complete,
            Verdict::Failed { kind, .. } => Ending::Physics(kind),
        };
        Self::new(proposal, evaluation.fitness, ending)
    }

    /// A proposal that could not be evaluated: worse than everything that was.
    pub(super) fn lost(proposal: Proposal, failure: Failure) -> Self {
        Self::new(proposal, f64::INFINITY, Ending::Infrastructure(failure))
    }

    fn new(proposal: Proposal, fitness: f64, ending: Ending) -> Self {
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

    /// What the search is told.
    pub(super) fn told(&self) -> Told {
        Told {
            fitness: self.fitness,
            complete: self.ending == Ending::Complete,
        }
    }
}

/// Every individual of a run, by id.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EvaluationLog {
    entries: BTreeMap<u64, Entry>,
}

impl EvaluationLog {
    /// In id order.
    pub fn entries(&self) -> impl ExactSizeIterator<Item = &Entry> {
        self.entries.values()
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// How many did not complete.
    pub fn failed(&self) -> usize {
        self.entries()
            .filter(|entry| entry.ending != Ending::Complete)
            .count()
    }

    /// BLAKE3 over id, gene bits and fitness bits of every entry in id order, all little endian;
    /// 64 hexadecimal digits. Two runs with the same digest took the same path.
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

    pub(super) fn insert(&mut self, entry: Entry) {
        self.entries.insert(entry.id, entry);
    }

    /// Failures by frequency, as `12 x load not lifted, 3 x budget`.
    pub(super) fn failures(&self) -> (String, Option<Word>) {
        let mut counts: BTreeMap<String, (usize, Option<Word>)> = BTreeMap::new();
        for entry in self.entries() {
            let physics = match entry.ending {
                Ending::Complete => continue,
                Ending::Physics(kind) => Some(kind),
                Ending::Infrastructure(_) => None,
            };
            let words = entry.ending.failure().unwrap_or_default();
            counts.entry(words).or_insert((0, physics)).0 += 1;
        }
        let mut ranked: Vec<_> = counts.into_iter().collect();
        ranked.sort_by_key(|(_, (count, _))| std::cmp::Reverse(*count));
        let words: Vec<String> = ranked
            .iter()
            .map(|(words, (count, _))| format!("{count} x {words}"))
            .collect();
        (
            words.join(", "),
            ranked.iter().find_map(|(_, (_, physics))| *physics),
        )
    }
}
