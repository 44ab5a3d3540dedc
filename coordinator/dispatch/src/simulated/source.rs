//! Where the jobs of a simulated cluster come from: generations, or a search.
use protocol::job::{Job, Outcome};
use search::strategy::{Strategy, Told};
use std::collections::BTreeMap;

/// A job that does nothing, told from others by its number.
pub fn job(n: u64) -> Job {
    Job::Nothing {
        payload: n.to_le_bytes().to_vec(),
        reply_bytes: 1,
        delay_ms: 0,
    }
}

/// Where jobs come from.
pub trait Source {
    /// Jobs that can be done now.
    fn ask(&mut self) -> Vec<(u64, Job)>;
    /// Takes what came of one.
    fn tell(&mut self, id: u64, outcome: &Outcome);
    /// Whether nothing more is wanted.
    fn is_done(&self) -> bool;
}

/// Generations of equal size: nothing is asked before all of the last one is there.
pub struct Generations {
    size: u64,
    left: u64,
    next: u64,
    open: u64,
}

impl Generations {
    /// So many generations of so many jobs.
    pub const fn new(size: u64, count: u64) -> Self {
        Self {
            size,
            left: count,
            next: 0,
            open: 0,
        }
    }
}

impl Source for Generations {
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

/// A search, with a function for the physics.
pub struct Search<'a> {
    /// The search.
    pub strategy: Box<dyn Strategy>,
    /// The physics.
    pub tell: &'a dyn Fn(&[f64]) -> Told,
    /// Proposals from this number on are not evaluated.
    pub limit: u64,
    open: BTreeMap<u64, Vec<f64>>,
    log: blake3::Hasher,
}

impl<'a> Search<'a> {
    /// The whole of a search.
    pub fn new(strategy: Box<dyn Strategy>, tell: &'a dyn Fn(&[f64]) -> Told) -> Self {
        Self {
            strategy,
            tell,
            limit: u64::MAX,
            open: BTreeMap::new(),
            log: blake3::Hasher::new(),
        }
    }

    /// The name of everything that was evaluated, in index order.
    pub fn digest(mut self) -> String {
        for entry in self.strategy.archive().entries() {
            self.log.update(&entry.id.to_le_bytes());
            for gene in &entry.genes {
                self.log.update(&gene.to_bits().to_le_bytes());
            }
            self.log.update(&entry.told.fitness.to_bits().to_le_bytes());
        }
        self.log.finalize().to_hex().to_string()
    }
}

impl Source for Search<'_> {
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
