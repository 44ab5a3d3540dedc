//! Where the jobs of a simulated cluster come from: generations, or a search.
use super::*;
use search::strategy::{Strategy, Told};

/// Where jobs come from.
pub(in crate::core::tests) trait Source {
    fn ask(&mut self) -> Vec<(u64, Job)>;
    fn tell(&mut self, id: u64, outcome: &Outcome);
    fn is_done(&self) -> bool;
}

/// Generations of equal size: nothing is asked before all of the last one is there.
pub(in crate::core::tests) struct Generations {
    size: u64,
    left: u64,
    next: u64,
    open: u64,
}

impl Generations {
    pub(in crate::core::tests) const fn new(size: u64, count: u64) -> Self {
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
pub(in crate::core::tests) struct Search<'a> {
    pub(in crate::core::tests) strategy: Box<dyn Strategy>,
    pub(in crate::core::tests) tell: &'a dyn Fn(&[f64]) -> Told,
    open: BTreeMap<u64, Vec<f64>>,
    log: blake3::Hasher,
}

impl<'a> Search<'a> {
    pub(in crate::core::tests) fn new(
        strategy: Box<dyn Strategy>,
        tell: &'a dyn Fn(&[f64]) -> Told,
    ) -> Self {
        Self {
            strategy,
            tell,
            open: BTreeMap::new(),
            log: blake3::Hasher::new(),
        }
    }

    /// The name of everything that was evaluated, in index order.
    pub(in crate::core::tests) fn digest(mut self) -> String {
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
        let proposals = self.strategy.ask();
        let jobs = proposals.into_iter().map(|proposal| {
            self.open.insert(proposal.id, proposal.genes);
            (proposal.id, job(proposal.id))
        });
        jobs.collect()
    }

    fn tell(&mut self, id: u64, _outcome: &Outcome) {
        let genes = self.open.remove(&id).expect("asked for");
        self.strategy.tell(id, (self.tell)(&genes));
    }

    fn is_done(&self) -> bool {
        self.strategy.finished().is_some()
    }
}
