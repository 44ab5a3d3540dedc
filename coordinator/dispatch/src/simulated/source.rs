//! Job sources of a simulated cluster: generations, or a search.
use crate::runtime::{anticipated_parts, part_count};
use protocol::job::{Job, Outcome};
use search::strategy::{EvaluationResult, Proposal, Purpose, Residual, Strategy};
use std::{cell::RefCell, collections::BTreeMap, rc::Rc};

/// Bit that the numbers of anticipated jobs and of parts of divided jobs have and those of proposals do not.
const PART: u64 = 1 << 40;

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
    /// Returns jobs that can be submitted now, with their ids; `idle` slots have nothing to do without them.
    fn ask(&mut self, idle: usize) -> Vec<(u64, Job)>;
    /// Returns jobs that will probably be submitted next, likeliest first, with numbers that tell them apart;
    /// `idle` slots could compute them ahead.
    fn anticipate(&mut self, _idle: usize) -> Vec<(u64, Job)> {
        Vec::new()
    }
    /// Goes back to the beginning, because a new coordinator process asks for all jobs again; returns whether the
    /// source can do so.
    fn restart(&mut self) -> bool {
        false
    }
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
    fn ask(&mut self, _idle: usize) -> Vec<(u64, Job)> {
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

/// Derivatives of a search on a simulated cluster.
pub struct SimulatedDerivatives<'a> {
    /// Residual with its derivatives, for given genes.
    pub residual: &'a dyn Fn(&[f64]) -> Residual,
    /// Number of columns of a job with derivatives.
    pub columns: usize,
    /// Computing time of a job with all columns over that of a plain one.
    pub cost: f64,
    /// Smallest number of parts in which an anticipated job with a number of columns is worth its slots.
    pub least_parts: fn(usize) -> usize,
    /// Computing times of the jobs handed out so far that ask for derivatives, over that of a plain job.
    pub factors: Rc<RefCell<BTreeMap<u64, f64>>>,
}

/// Job source that runs a search strategy, with a function evaluated in place of the simulation.
pub struct SimulatedSearch<'a> {
    /// Search strategy that proposes the jobs.
    pub strategy: Box<dyn Strategy>,
    /// Objective evaluated in place of the simulation, for given genes.
    pub tell: &'a dyn Fn(&[f64]) -> EvaluationResult,
    /// Residuals for proposals that need them; `None` if the search is told the fitness alone.
    pub derivatives: Option<SimulatedDerivatives<'a>>,
    /// Number of proposals, from the first one on, that are evaluated; later ones are not.
    pub limit: u64,
    /// Proposals without a result, each with the number of its jobs that have none.
    open: BTreeMap<u64, (Proposal, usize)>,
    /// Proposals by the numbers of their jobs without a result.
    proposal_of: BTreeMap<u64, u64>,
    /// Numbers of the jobs of anticipated individuals, by their genes (as bits) and by whether their
    /// derivatives are computed.
    anticipated: BTreeMap<(Vec<u64>, bool), Vec<u64>>,
    /// Number of numbers with the bit [`PART`] given so far.
    part_numbers: u64,
    log: blake3::Hasher,
}

impl<'a> SimulatedSearch<'a> {
    /// Creates a source that runs the search to its end.
    pub fn new(strategy: Box<dyn Strategy>, tell: &'a dyn Fn(&[f64]) -> EvaluationResult) -> Self {
        Self {
            strategy,
            tell,
            derivatives: None,
            limit: u64::MAX,
            open: BTreeMap::new(),
            proposal_of: BTreeMap::new(),
            anticipated: BTreeMap::new(),
            part_numbers: 0,
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

    /// Returns the job numbers of a proposal: those under which it was anticipated, its own, or those of the
    /// parts into which its derivatives are divided.
    fn job_numbers(&mut self, proposal: &Proposal, parts: usize) -> Vec<u64> {
        let key = self.key(&proposal.genes, proposal.purpose);
        if let Some(numbers) = self.anticipated.remove(&key) {
            return numbers;
        }
        if parts > 1 && self.columns(proposal.purpose) > 1 {
            return self.new_numbers(proposal.purpose, parts);
        }
        self.set_factors(&[proposal.id], proposal.purpose, 1);
        vec![proposal.id]
    }

    /// Returns new numbers for the parts of an individual's evaluation.
    fn new_numbers(&mut self, purpose: Purpose, parts: usize) -> Vec<u64> {
        let columns = self.columns(purpose).max(1);
        let count = columns.div_ceil(columns.div_ceil(parts.max(1))) as u64;
        let first = PART | self.part_numbers;
        self.part_numbers += count;
        let numbers: Vec<u64> = (first..first + count).collect();
        self.set_factors(&numbers, purpose, parts);
        numbers
    }

    /// Records the computing time of jobs that divide an evaluation into about `parts` parts, over that of a
    /// plain job.
    fn set_factors(&self, numbers: &[u64], purpose: Purpose, parts: usize) {
        let columns = self.columns(purpose);
        if let Some(derivatives) = self.derivatives.as_ref().filter(|_| columns > 0) {
            let share = columns.div_ceil(parts.max(1)) as f64 / columns as f64;
            let factor = 1.0 + (derivatives.cost - 1.0) * share;
            let mut factors = derivatives.factors.borrow_mut();
            factors.extend(numbers.iter().map(|number| (*number, factor)));
        }
    }

    /// Returns the number of columns of the derivatives that a proposal with a purpose needs; 0 if none.
    fn columns(&self, purpose: Purpose) -> usize {
        let derivatives = self.derivatives.as_ref();
        let wanted = derivatives.filter(|_| purpose.wants_derivatives());
        wanted.map_or(0, |own| own.columns)
    }

    fn key(&self, genes: &[f64], purpose: Purpose) -> (Vec<u64>, bool) {
        let genes = genes.iter().map(|gene| gene.to_bits());
        (genes.collect(), self.columns(purpose) > 0)
    }
}

impl JobSource for SimulatedSearch<'_> {
    fn ask(&mut self, idle: usize) -> Vec<(u64, Job)> {
        let mut asked = self.strategy.ask();
        asked.retain(|proposal| proposal.id < self.limit);
        let columns = asked.iter().map(|proposal| self.columns(proposal.purpose));
        let divisible: Vec<usize> = columns.filter(|columns| *columns > 0).collect();
        let idle = idle.saturating_sub(asked.len() - divisible.len());
        let columns = divisible.first().copied().unwrap_or(0);
        let parts = part_count(columns, divisible.len(), idle);
        let mut jobs = Vec::new();
        for proposal in asked {
            let numbers = self.job_numbers(&proposal, parts);
            jobs.extend(numbers.iter().map(|number| (*number, job(*number))));
            let whole = numbers.iter().map(|number| (*number, proposal.id));
            self.proposal_of.extend(whole);
            self.open.insert(proposal.id, (proposal, numbers.len()));
        }
        jobs
    }

    fn anticipate(&mut self, idle: usize) -> Vec<(u64, Job)> {
        let drafts = self.strategy.anticipate();
        let columns: Vec<usize> = drafts
            .iter()
            .map(|draft| self.columns(draft.purpose))
            .collect();
        let mut jobs = Vec::new();
        let least = |columns| {
            let derivatives = self.derivatives.as_ref();
            derivatives.map_or(1, |own| (own.least_parts)(columns))
        };
        let counts = anticipated_parts(&columns, idle, least);
        for (draft, parts) in drafts.iter().zip(counts) {
            let key = self.key(&draft.genes, draft.purpose);
            let numbers = match self.anticipated.get(&key) {
                Some(numbers) => numbers.clone(),
                None => self.new_numbers(draft.purpose, parts),
            };
            jobs.extend(numbers.iter().map(|number| (*number, job(*number))));
            self.anticipated.insert(key, numbers);
        }
        jobs
    }

    fn tell(&mut self, number: u64, _outcome: &Outcome) {
        let Some(id) = self.proposal_of.remove(&number) else {
            return;
        };
        let Some((_, left)) = self.open.get_mut(&id) else {
            return;
        };
        *left -= 1;
        if *left > 0 {
            return;
        }
        let Some((proposal, _)) = self.open.remove(&id) else {
            return;
        };
        let derivatives = self.derivatives.as_ref();
        if let Some(own) = derivatives.filter(|_| proposal.purpose.wants_residual()) {
            let mut residual = (own.residual)(&proposal.genes);
            if !proposal.purpose.wants_derivatives() {
                residual.derivatives.clear();
            }
            self.strategy.tell_residual(id, residual);
        }
        self.strategy.tell(id, (self.tell)(&proposal.genes));
    }

    fn is_done(&self) -> bool {
        let evaluated = self.strategy.archive().entries().len() as u64;
        self.strategy.finished().is_some() || evaluated >= self.limit
    }
}
