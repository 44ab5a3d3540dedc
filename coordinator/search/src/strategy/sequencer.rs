//! Sequential execution of the stages (batch-wise parts) of a strategy: assigns ids, restores the order of
//! results, reuses results of identical individuals.
//!
//! The sequencer knows batches, not algorithms. Its state is a function of the longest unbroken run of
//! results from id 0; later results wait in a buffer.
use super::{
    archive::{Archive, EvaluatedIndividual, Residual, key},
    ask_tell::Strategy,
    evaluation_result::EvaluationResult,
    family::DescentEnd,
    ordered_results::Intake,
    outcome::{Best, Finish, Progress},
    proposal::Proposal,
    stage::{Batch, ProposalDraft, SearchStage},
};
use std::collections::{BTreeMap, VecDeque};

/// Strategy that executes a sequence of stages (batch-wise parts), one after another.
pub struct Sequencer {
    stages: VecDeque<Box<dyn SearchStage>>,
    /// Whether a repeated individual takes its known result instead of being evaluated again.
    reuse_clones: bool,
    intake: Intake,
    /// Proposal id of each draft in the running batch; identical individuals share an id.
    slots: Vec<u64>,
    outbox: Vec<Proposal>,
    residuals: BTreeMap<u64, Residual>,
    /// Ends of the descents of the completed stages that converged.
    descent_ends: Vec<DescentEnd>,
    next_id: u64,
    generation: u32,
    /// Number of generations of the completed stages.
    generations_done: u32,
    finish: Option<Finish>,
}

impl Sequencer {
    /// Creates a strategy that executes these stages in order. `reuse_clones` saves evaluations where stages
    /// propose an individual again; as evaluations are pure, it changes no result.
    pub fn new(stages: Vec<Box<dyn SearchStage>>, reuse_clones: bool) -> Self {
        let mut sequencer = Self {
            stages: stages.into(),
            reuse_clones,
            intake: Intake::default(),
            slots: Vec::new(),
            outbox: Vec::new(),
            residuals: BTreeMap::new(),
            descent_ends: Vec::new(),
            next_id: 0,
            generation: 0,
            generations_done: 0,
            finish: None,
        };
        sequencer.advance();
        sequencer
    }

    /// Plans batches of the stages until a batch needs an evaluation or no stage is left.
    fn advance(&mut self) {
        while self.finish.is_none() && self.intake.awaited() == 0 {
            self.close_batch();
            let Some(stage) = self.stages.front_mut() else {
                self.finish = Some(Finish::Planned);
                return;
            };
            if stage.reached_threshold() {
                self.finish = Some(Finish::Threshold);
            } else if let Some(batch) = stage.plan(self.intake.archive()) {
                self.open_batch(batch);
            } else {
                self.generations_done += stage.generations();
                self.descent_ends.extend(stage.descent_ends());
                let groups = stage.start_groups(self.intake.archive());
                self.intake.set_start_groups(groups);
                self.stages.pop_front();
            }
        }
    }

    /// Passes the results of the finished batch, if any, to the stage that planned it.
    fn close_batch(&mut self) {
        if self.slots.is_empty() {
            return;
        }
        let slots = std::mem::take(&mut self.slots);
        let results: Vec<EvaluatedIndividual> =
            slots.iter().filter_map(|id| self.result(*id)).collect();
        if let Some(stage) = self.stages.front_mut() {
            stage.absorb(&results);
        }
    }

    /// Returns the result of a proposal with its residual; `None` while it is awaited.
    fn result(&self, id: u64) -> Option<EvaluatedIndividual> {
        let residual = self.residuals.get(&id).cloned();
        let result = self.intake.result(id)?;
        Some(EvaluatedIndividual { residual, ..result })
    }

    fn open_batch(&mut self, batch: Batch) {
        self.generation = self.generations_done + batch.generation;
        let mut fresh: BTreeMap<Vec<u64>, u64> = BTreeMap::new();
        for ProposalDraft { genes, purpose } in batch.drafts {
            let known = if self.reuse_clones {
                // a result that is known without its residual is no use where that is wanted
                let serves = |id: &u64| {
                    let known = self.residuals.get(id);
                    !purpose.wants_residual()
                        || known.is_some_and(|it| {
                            !purpose.wants_derivatives() || !it.derivatives.is_empty()
                        })
                };
                let met = self.intake.archive().find(&genes).map(|entry| entry.id);
                met.filter(serves)
                    .or_else(|| fresh.get(&key(&genes)).copied())
            } else {
                None
            };
            let id = known.unwrap_or_else(|| {
                let id = self.next_id;
                self.next_id += 1;
                fresh.insert(key(&genes), id);
                self.intake.expect(id, genes.clone());
                self.outbox.push(Proposal {
                    id,
                    genes,
                    generation: self.generation,
                    purpose,
                });
                id
            });
            self.slots.push(id);
        }
    }
}

impl Strategy for Sequencer {
    fn ask(&mut self) -> Vec<Proposal> {
        std::mem::take(&mut self.outbox)
    }

    fn tell(&mut self, id: u64, result: EvaluationResult) {
        self.intake.keep(id, result);
        while self.intake.take().is_some() {
            self.advance();
        }
    }

    fn tell_residual(&mut self, id: u64, residual: Residual) {
        if self.intake.awaits(id) {
            self.residuals.entry(id).or_insert(residual);
        }
    }

    fn anticipate(&self) -> Vec<ProposalDraft> {
        let Some(stage) = self.stages.front() else {
            return Vec::new();
        };
        stage.anticipate(&|index| self.result(*self.slots.get(index)?))
    }

    fn finished(&self) -> Option<Finish> {
        self.finish
    }

    fn progress(&self) -> Progress {
        let evaluations = self.intake.archive().entries().len() as u64;
        let remaining: u64 = self.stages.iter().map(|stage| stage.remaining()).sum();
        let consumed = self.next_id - self.intake.awaited();
        let batch_done = self.slots.iter().filter(|id| **id < consumed).count() as u64;
        let ahead = match self.finish {
            Some(_) => 0,
            None => remaining
                .saturating_sub(batch_done)
                .max(self.intake.awaited()),
        };
        Progress {
            generation: self.generation,
            generations: self.generations_done
                + self
                    .stages
                    .iter()
                    .map(|stage| stage.generations())
                    .sum::<u32>(),
            evaluations,
            expected_evaluations: evaluations + ahead,
            best_fitness: self
                .intake
                .archive()
                .best()
                .filter(|best| best.result.survived())
                .map(|best| best.result.fitness),
        }
    }

    fn best(&self) -> Option<Best> {
        self.intake.archive().best().map(Best::from)
    }

    fn descent_ends(&self) -> &[DescentEnd] {
        &self.descent_ends
    }

    fn archive(&self) -> &Archive {
        self.intake.archive()
    }
}
