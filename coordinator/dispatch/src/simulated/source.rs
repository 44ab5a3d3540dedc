//! Job sources of a simulated cluster: generations, or a search.
use protocol::job::{Job, Outcome};
use search::strategy::{EvaluationResult, Strategy};
use std::collections::BTreeMap;

/// Builds a job of kind `Nothing`, identified by its number.
pub fn job(n: u64) -> Job {
    Job::Nothing {
        payload: n.to_le_bytes().to_vec(),
        reply_bytes: 1,
        delay_ms: 0,
    }
}

/// Source of jobs for a simulated cluster.
pub trait JobSource {
    /// Returns jobs that can be submitted now, with their ids.
    fn ask(&mut self) -> Vec<(u64, Job)>;
    /// Passes the outcome of a job to the source.
    fn tell(&mut self, id: u64, outcome: &Outcome);
    /// Returns whether the source needs no more results.
    fn is_done(&self) -> bool;
}

/// Source of generations of equal size; the next generation starts only when the previous one is complete.
pub struct Generations {
    size: u64,
    left: u64,
    next: u64,
    open: u64,
}

impl Generations {
    /// Creates a source of `count` generations of `size` jobs.
    pub const fn new(size: u64, count: u64) -> Self {
        Self {
            size,
            left: count,
            next: 0,
            open: 0,
        }
    }
}

impl JobSource for Generations {
    fn ask(&mut self) -> Vec<(u64, Job)> {
        if self.open > 0 || self.left == 0 {
            return Vec::new();
        }
        self.left -= 1;
        self.open = self.size;
        let from = self.next;
        self.next += self.size;
        (from..self.next).map(|id| (id, job(id))).collect()
    }

    fn tell(&mut self, _id: u64, _outcome: &Outcome) {
        self.open -= 1;
    }

    fn is_done(&self) -> bool {
        self.left == 0 && self.open == 0
    }
}

/// Job source that runs a search strategy, with a function evaluated in place of the simulation.
pub struct SimulatedSearch<'a> {
    /// Search strategy that proposes the jobs.
    pub strategy: Box<dyn Strategy>,
    /// Objective evaluated in place of the simulation, for given genes.
    pub tell: &'a dyn Fn(&[f64]) -> EvaluationResult,
    /// Number of proposals, from the first one on, that are evaluated; later ones are not.
    pub limit: u64,
    open: BTreeMap<u64, Vec<f64>>,
    log: blake3::Hasher,
}

impl<'a> SimulatedSearch<'a> {
    /// Creates a source that runs the search to its end.
    pub fn new(strategy: Box<dyn Strategy>, tell: &'a dyn Fn(&[f64]) -> EvaluationResult) -> Self {
        Self {
            strategy,
            tell,
            limit: u64::MAX,
            open: BTreeMap::new(),
            log: blake3::Hasher::new(),
        }
    }

    /// Returns a hash of all evaluations, in index order.
    pub fn digest(mut self) -> String {
        for entry in self.strategy.archive().entries() {
            self.log.update(&entry.id.to_le_bytes());
            for gene in &entry.genes {
                self.log.update(&gene.to_bits().to_le_bytes());
            }
            self.log
                .update(&entry.result.fitness.to_bits().to_le_bytes());
        }
        self.log.finalize().to_hex().to_string()
    }
}

impl JobSource for SimulatedSearch<'_> {
    fn ask(&mut self) -> Vec<(u64, Job)> {
        let asked = self.strategy.ask().into_iter();
        let wanted = asked.filter(|proposal| proposal.id < self.limit);
        let jobs = wanted.map(|proposal| {
            self.open.insert(proposal.id, proposal.genes);
            (proposal.id, job(proposal.id))
        });
        jobs.collect()
    }

    fn tell(&mut self, id: u64, _outcome: &Outcome) {
        if let Some(genes) = self.open.remove(&id) {
            self.strategy.tell(id, (self.tell)(&genes));
        }
    }

    fn is_done(&self) -> bool {
        let evaluated = self.strategy.archive().entries().len() as u64;
        self.strategy.finished().is_some() || evaluated >= self.limit
    }
}
