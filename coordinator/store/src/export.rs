//! Export in progress: converts the journal's events into table rows.
use super::{
    error::StoreError,
    row::{Brief, EffectRow, Evaluated, Fact, Happened, Scored},
    table::Tables,
    target::{Draft, Target},
    writer::TableWriter,
};
use journal::account::AccountBuilder;
use journal::event::{Asked, Event, Finished};
use journal::{Answers, Damage, JournalEntry, fold};
use protocol::{case::Case, job::Individual};
use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

/// What a journal holds, as far as an export concerns it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Contents {
    /// Stretches of the journal that cannot be read.
    pub damage: Vec<Damage>,
    /// Number of requested jobs that have no result.
    pub unanswered: usize,
    /// Number of results whose request cannot be read, so that their simulations are unknown.
    pub unknown: usize,
}

/// Result of a completed export.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exported {
    /// Paths of the files that the export consists of.
    pub files: Vec<PathBuf>,
    /// Number of exported rows by table name.
    pub rows: BTreeMap<&'static str, u64>,
}

/// Export in progress: receives a run's journal, and writes it as table rows.
pub struct Store<'a> {
    case: &'a Case,
    draft: Draft,
    book: TableWriter,
    tables: Tables,
    answers: Answers,
}

impl<'a> Store<'a> {
    /// Begins an export of a run of the given case.
    ///
    /// # Errors
    /// [`StoreError::Foreign`] if the target exists and is not an export, [`StoreError::Io`] or
    /// [`StoreError::Table`] if the target cannot be written.
    pub fn begin(target: Target, case: &'a Case) -> Result<Self, StoreError> {
        let draft = Draft::begin(target)?;
        let mut book = TableWriter::new(draft.sink()?);
        let tables = Tables::begin(&mut book, case)?;
        for gene in &case.unknowns {
            book.add_row(&tables.genes, gene)?;
        }
        Ok(Self {
            case,
            draft,
            book,
            tables,
            answers: Answers::default(),
        })
    }

    /// Adds a property of the whole run to the table `run`.
    ///
    /// # Errors
    /// [`StoreError::Io`] or [`StoreError::Table`] if it cannot be written.
    pub fn fact(&mut self, name: &str, value: &str) -> Result<(), StoreError> {
        let fact = Fact {
            name: name.to_owned(),
            value: value.to_owned(),
        };
        self.book.add_row(&self.tables.run, &fact)
    }

    /// Reads the run's journal, exports its rows, and returns what it holds.
    ///
    /// # Errors
    /// [`StoreError::Journal`] if the journal cannot be read, other errors if a table cannot be written.
    pub fn journal(&mut self, path: &Path) -> Result<Contents, StoreError> {
        let mut folding = AccountBuilder::default();
        let mut process = None;
        let mut failed = None;
        let report = fold(path, |entry, event| {
            folding.apply(&event);
            if let Event::Opened { epoch, .. } = event {
                process = Some(epoch);
            }
            if failed.is_none() {
                failed = self.event(entry, process, event).err();
            }
        })?;
        if let Some(error) = failed {
            return Err(error);
        }
        let account = folding.finish(report.damage.clone());
        for worker in &account.workers {
            self.book.add_row(&self.tables.workers, worker)?;
        }
        for damage in &account.damage {
            self.book.add_row::<Damage>(&self.tables.damage, damage)?;
        }
        self.fact("processes", &account.processes.to_string())?;
        self.fact("results", &self.answers.results().to_string())?;
        self.fact("failed_attempts", &account.failed.to_string())?;
        self.fact("accounted_wall_s", &account.wall_s.to_string())?;
        let lost: u64 = account.damage.iter().map(|damage| damage.bytes).sum();
        self.fact("journal_records", &report.records.to_string())?;
        self.fact("journal_bytes_lost", &lost.to_string())?;
        Ok(Contents {
            damage: report.damage,
            unanswered: self.answers.unanswered(),
            unknown: self.answers.unknown(),
        })
    }

    fn event(
        &mut self,
        entry: JournalEntry,
        process: Option<u32>,
        event: Event,
    ) -> Result<(), StoreError> {
        let happened = Happened {
            at_byte: entry.at,
            process,
            ..Happened::default()
        };
        let happened = match event {
            Event::Finished(finished) => {
                self.result(&finished)?;
                return self.answer(Event::Finished(finished));
            }
            asked @ Event::Asked(_) => return self.answer(asked),
            // repeated at each opening, told by the account, or found by the study alone
            Event::Begun { .. } | Event::Accounted(_) | Event::Found { .. } => return Ok(()),
            Event::Opened { at_unix_ms, .. } => Happened {
                event: "opened",
                at_unix_ms: Some(at_unix_ms),
                ..happened
            },
            Event::Joined {
                worker,
                host,
                slots,
                model_digest,
            } => Happened {
                event: "joined",
                worker: Some(worker),
                host: Some(host),
                slots: Some(slots),
                detail: Some(model_digest),
                ..happened
            },
            Event::Left { worker, reason } => Happened {
                event: "left",
                worker: Some(worker),
                detail: Some(reason),
                ..happened
            },
            Event::Proved { proof } => Happened {
                event: "proved",
                detail: Some(proof.to_string()),
                ..happened
            },
            Event::Closed => Happened {
                event: "closed",
                ..happened
            },
        };
        self.book.add_row(&self.tables.events, &happened)
    }

    fn result(&mut self, finished: &Finished) -> Result<(), StoreError> {
        let brief = Brief::of(finished);
        for score in &brief.scores {
            let scored = Scored {
                job: brief.job,
                score: *score,
            };
            self.book.add_row(&self.tables.scores, &scored)?;
        }
        self.book.add_row(&self.tables.results, &brief)
    }

    /// Adds a request or a result, and the row of the pair that it completes.
    fn answer(&mut self, event: Event) -> Result<(), StoreError> {
        match self.answers.pair(event) {
            Some((asked, finished)) => self.evaluation(asked, Brief::of(&finished)),
            None => Ok(()),
        }
    }

    /// Adds a requested job with its result; a job that simulates nothing is left out.
    fn evaluation(&mut self, asked: Asked, result: Brief) -> Result<(), StoreError> {
        let Some(Individual {
            condition,
            genes,
            effects,
        }) = asked.individual
        else {
            return Ok(());
        };
        let count = effects.len();
        for effect in effects {
            let mut parameters: Vec<_> = effect.parameters.into_iter().map(Some).collect();
            if parameters.is_empty() {
                parameters = vec![None];
            }
            for parameter in parameters {
                let added = EffectRow {
                    job: result.job,
                    effect: effect.id.clone(),
                    parameter,
                };
                self.book.add_row(&self.tables.effects, &added)?;
            }
        }
        let condition = self.case.conditions.get(condition);
        let evaluated = Evaluated {
            generation: asked.reason.generation,
            purpose: asked.reason.purpose,
            condition: condition.map_or_else(String::new, |one| one.name.clone()),
            genes,
            effects: count,
            columns: asked.columns,
            result,
        };
        self.book.add_row(&self.tables.evaluations, &evaluated)
    }

    /// Completes the export and moves it to its target.
    ///
    /// # Errors
    /// [`StoreError::Io`] or [`StoreError::Table`] if a file cannot be written.
    pub fn finish(mut self) -> Result<Exported, StoreError> {
        for shape in self.book.schemas() {
            for column in shape.columns {
                let row = (shape.name.to_owned(), column);
                self.book.add_row(&self.tables.dictionary, &row)?;
            }
        }
        let rows = self.book.finish()?;
        Ok(Exported {
            files: self.draft.publish()?,
            rows,
        })
    }
}
