//! Runs pieces one after the other: gives ids, restores the order of results, reuses clones.
//!
//! It knows batches, not algorithms. The state is a function of the longest unbroken run of
//! results from id 0; later ones wait in a buffer.
use super::{
    archive::{Archive, Evaluated, Residual, key},
    ask_tell::Strategy,
    outcome::{Best, Finish, Progress},
    piece::{Batch, Draft, Piece},
    proposal::Proposal,
    told::Told,
};
use std::collections::{BTreeMap, VecDeque};

/// A sequence of pieces, as a strategy.
pub struct Conductor {
    pieces: VecDeque<Box<dyn Piece>>,
    /// Whether an individual met before takes its known result instead of being evaluated again.
    reuse_clones: bool,
    archive: Archive,
    /// One id per draft of the running batch; clones share an id.
    slots: Vec<u64>,
    /// Genes of the proposals that have not been consumed, by id.
    open: BTreeMap<u64, Vec<f64>>,
    outbox: Vec<Proposal>,
    early: BTreeMap<u64, Told>,
    /// Residual vectors of proposals that wanted one.
    residuals: BTreeMap<u64, Residual>,
    next_id: u64,
    generation: u32,
    /// Generations of the pieces that are done.
    generations_done: u32,
    finish: Option<Finish>,
}

impl Conductor {
    /// A strategy of these pieces. `reuse_clones` saves evaluations where pieces propose an
    /// individual again; as evaluations are pure, it changes no result.
    pub fn new(pieces: Vec<Box<dyn Piece>>, reuse_clones: bool) -> Self {
        let mut conductor = Self {
            pieces: pieces.into(),
            reuse_clones,
            archive: Archive::default(),
            slots: Vec::new(),
            open: BTreeMap::new(),
            outbox: Vec::new(),
            early: BTreeMap::new(),
            residuals: BTreeMap::new(),
            next_id: 0,
            generation: 0,
            generations_done: 0,
            finish: None,
        };
        conductor.advance();
        conductor
    }

    /// Plans batches until one needs an evaluation or nothing is left.
    fn advance(&mut self) {
        while self.finish.is_none() && self.open.is_empty() {
            self.close_batch();
            let Some(piece) = self.pieces.front_mut() else {
                self.finish = Some(Finish::Planned);
                return;
            };
            if piece.reached_threshold() {
                self.finish = Some(Finish::Threshold);
            } else if let Some(batch) = piece.plan(&self.archive) {
                self.open_batch(batch);
            } else {
                self.generations_done += piece.generations();
                self.pieces.pop_front();
            }
        }
    }

    /// Hands the finished batch to its piece, if there is one.
    fn close_batch(&mut self) {
        if self.slots.is_empty() {
            return;
        }
        let entries = self.archive.entries();
        let results: Vec<Evaluated> = std::mem::take(&mut self.slots)
            .into_iter()
            .filter_map(|id| {
                let entry = entries.get(usize::try_from(id).ok()?)?;
                Some(Evaluated {
                    residual: self.residuals.get(&id).cloned(),
                    ..entry.clone()
                })
            })
            .collect();
        if let Some(piece) = self.pieces.front_mut() {
            piece.absorb(&results);
        }
    }

    fn open_batch(&mut self, batch: Batch) {
        self.generation = self.generations_done + batch.generation;
        let mut fresh: BTreeMap<Vec<u64>, u64> = BTreeMap::new();
        for Draft { genes, purpose } in batch.drafts {
            let known = if self.reuse_clones {
                // a result that is known without its residual is no use where that is wanted
                let serves = |id: &u64| {
                    let known = self.residuals.get(id);
                    !purpose.wants_residual()
                        || known.is_some_and(|it| !purpose.wants_derivatives() || !it.by.is_empty())
                };
                let met = self.archive.find(&genes).map(|entry| entry.id);
                met.filter(serves)
                    .or_else(|| fresh.get(&key(&genes)).copied())
            } else {
                None
            };
            let id = known.unwrap_or_else(|| {
                let id = self.next_id;
                self.next_id += 1;
                fresh.insert(key(&genes), id);
                self.open.insert(id, genes.clone());
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

impl Strategy for Conductor {
    fn ask(&mut self) -> Vec<Proposal> {
        std::mem::take(&mut self.outbox)
    }

    fn tell(&mut self, id: u64, result: Told) {
        if self.open.contains_key(&id) {
            self.early.entry(id).or_insert(result);
        }
        while let Some((first, told)) = self.early.first_key_value().map(|(id, told)| (*id, *told))
        {
            if first != self.archive.entries().len() as u64 {
                break;
            }
            self.early.pop_first();
            if let Some(genes) = self.open.remove(&first) {
                self.archive.push(Evaluated {
                    id: first,
                    genes,
                    told,
                    residual: None,
                });
            }
            self.advance();
        }
    }

    fn tell_residual(&mut self, id: u64, residual: Residual) {
        if self.open.contains_key(&id) {
            self.residuals.entry(id).or_insert(residual);
        }
    }

    fn finished(&self) -> Option<Finish> {
        self.finish
    }

    fn progress(&self) -> Progress {
        let evaluations = self.archive.entries().len() as u64;
        let remaining: u64 = self.pieces.iter().map(|piece| piece.remaining()).sum();
        let consumed = self.next_id - self.open.len() as u64;
        let batch_done = self.slots.iter().filter(|id| **id < consumed).count() as u64;
        let ahead = match self.finish {
            Some(_) => 0,
            None => remaining
                .saturating_sub(batch_done)
                .max(self.open.len() as u64),
        };
        Progress {
            generation: self.generation,
            generations: self.generations_done
                + self
                    .pieces
                    .iter()
                    .map(|piece| piece.generations())
                    .sum::<u32>(),
            evaluations,
            expected_evaluations: evaluations + ahead,
            best_fitness: self
                .archive
                .best()
                .filter(|best| best.told.survived())
                .map(|best| best.told.fitness),
        }
    }

    fn best(&self) -> Option<Best> {
        self.archive.best().map(Best::from)
    }

    fn archive(&self) -> &Archive {
        &self.archive
    }
}
