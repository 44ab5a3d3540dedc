//! Job sources of a simulated cluster: generations, or a search.
use crate::runtime::part_count;
use protocol::job::{Job, Outcome};
use search::strategy::{EvaluationResult, Proposal, Residual, Strategy};
use std::{cell::RefCell, collections::BTreeMap, rc::Rc};

/// Bit that the numbers of parts of divided jobs have and those of proposals do not.
const PART: u64 = 1 << 40;
/// Bits of a part's number that hold its index.
const PART_INDEX_BITS: u32 = 8;

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

    /// Returns the job numbers of a proposal: its own, or those of the parts into which its derivatives are
    /// divided.
    fn job_numbers(&self, proposal: &Proposal, parts: usize) -> Vec<u64> {
        let Some(derivatives) = self.derivatives_of(proposal) else {
            return vec![proposal.id];
        };
        let size = derivatives.columns.div_ceil(parts.max(1));
        let parts = derivatives.columns.div_ceil(size.max(1)).max(1);
        let numbers: Vec<u64> = if parts == 1 {
            vec![proposal.id]
        } else {
            let of = |index: u64| PART | (proposal.id << PART_INDEX_BITS) | index;
            (0..parts as u64).map(of).collect()
        };
        let share = size as f64 / derivatives.columns as f64;
        let factor = 1.0 + (derivatives.cost - 1.0) * share;
        let mut factors = derivatives.factors.borrow_mut();
        factors.extend(numbers.iter().map(|number| (*number, factor)));
        numbers
    }

    fn derivatives_of(&self, proposal: &Proposal) -> Option<&SimulatedDerivatives<'a>> {
        let wanted = |own: &&SimulatedDerivatives<'_>| {
            proposal.purpose.wants_derivatives() && own.columns > 0
        };
        self.derivatives.as_ref().filter(wanted)
    }
}

impl JobSource for SimulatedSearch<'_> {
    fn ask(&mut self, idle: usize) -> Vec<(u64, Job)> {
        let mut asked = self.strategy.ask();
        asked.retain(|proposal| proposal.id < self.limit);
        let with = asked.iter().filter_map(|own| self.derivatives_of(own));
        let (mut divisible, mut columns) = (0, 0);
        for derivatives in with {
            (divisible, columns) = (divisible + 1, derivatives.columns);
        }
        let idle = idle.saturating_sub(asked.len() - divisible);
        let parts = part_count(columns, divisible, idle);
        let mut jobs = Vec::new();
        for proposal in asked {
            let numbers = self.job_numbers(&proposal, parts);
            jobs.extend(numbers.iter().map(|number| (*number, job(*number))));
            self.open.insert(proposal.id, (proposal, numbers.len()));
        }
        jobs
    }

    fn tell(&mut self, number: u64, _outcome: &Outcome) {
        let id = if number & PART == 0 {
            number
        } else {
            (number & !PART) >> PART_INDEX_BITS
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
