//! A run as tables for queries, built from its journal: SQLite, CSV or Parquet.
//!
//! [`Store`] folds the journal into rows; what was *asked* stands in no journal, so whoever repeats
//! the run's study on the recording ([`crate::study::Recorded`]) hands in the simulations one by
//! one. Rows stream: neither curves nor residuals nor tables are held in memory. The journal is the
//! truth and is never changed; an export can always be made again, with the same content.
mod book;
mod column;
mod csv;
mod parquet;
#[cfg(test)]
pub(crate) mod read_back;
mod row;
mod sqlite;
mod table;
mod target;
#[cfg(test)]
mod tests;

pub use target::{Format, Target};

use crate::{
    account::Folding,
    journal::{Damage, Entry, JournalError, Recording},
};
use book::Book;
use protocol::{
    case::Case,
    event::{Event, Finished},
    job::Job,
};
use row::{Added, Brief, Evaluated, Fact, Happened, Scored};
use std::{
    collections::BTreeMap,
    io,
    path::{Path, PathBuf},
};
use table::Tables;
use target::Draft;

/// Why a run cannot be exported.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StoreError {
    /// A file cannot be read or written.
    #[error("cannot {doing} {}: {source}", path.display())]
    Io {
        /// What was tried.
        doing: &'static str,
        /// On what.
        path: PathBuf,
        /// The system's words.
        source: io::Error,
    },
    /// A table cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Table {
        /// Its file.
        path: PathBuf,
        /// The library's words.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// Something else is where the export is to go.
    #[error("{} is there already, and is no export of a run in this form", path.display())]
    Foreign {
        /// Where.
        path: PathBuf,
    },
    /// The journal cannot be read.
    #[error(transparent)]
    Journal(#[from] JournalError),
}

impl StoreError {
    fn io(doing: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Io {
            doing,
            path,
            source,
        }
    }

    fn writing(path: &Path) -> impl FnOnce(io::Error) -> Self {
        Self::io("write", path)
    }

    fn reading(path: &Path) -> impl FnOnce(io::Error) -> Self {
        Self::io("read", path)
    }

    fn table(path: &Path, source: impl Into<Box<dyn std::error::Error + Send + Sync>>) -> Self {
        Self::Table {
            path: path.to_owned(),
            source: source.into(),
        }
    }
}

/// Why a simulation was wanted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// Generation it was proposed in, in a search.
    pub generation: Option<u32>,
    /// What it was for.
    pub purpose: String,
}

/// An export that is complete.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exported {
    /// Its files.
    pub files: Vec<PathBuf>,
    /// Rows of each table.
    pub rows: BTreeMap<&'static str, u64>,
}

/// An export that is being made.
pub struct Store<'a> {
    case: &'a Case,
    draft: Draft,
    book: Book,
    tables: Tables,
}

impl<'a> Store<'a> {
    /// Begins an export of a run over a case.
    ///
    /// # Errors
    /// [`StoreError::Foreign`] if something else is in its place, [`StoreError::Io`] or
    /// [`StoreError::Table`] if one cannot write there.
    pub fn begin(target: Target, case: &'a Case) -> Result<Self, StoreError> {
        let draft = Draft::begin(target)?;
        let mut book = Book::new(draft.sink()?);
        let tables = Tables::begin(&mut book, case)?;
        for gene in &case.genes {
            book.put(&tables.genes, gene)?;
        }
        Ok(Self {
            case,
            draft,
            book,
            tables,
        })
    }

    /// Adds something that is known of the run as a whole.
    ///
    /// # Errors
    /// [`StoreError::Io`] or [`StoreError::Table`] if it cannot be written.
    pub fn fact(&mut self, name: &str, value: &str) -> Result<(), StoreError> {
        let fact = Fact {
            name: name.to_owned(),
            value: value.to_owned(),
        };
        self.book.put(&self.tables.run, &fact)
    }

    /// Reads the journal and adds everything that it says by itself.
    ///
    /// # Errors
    /// [`StoreError::Journal`] if it cannot be read, others if something cannot be written.
    pub fn journal(&mut self, path: &Path) -> Result<Recording, StoreError> {
        let mut folding = Folding::default();
        let mut process = None;
        let mut failed = None;
        let recording = Recording::read(path, |entry, event| {
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
        let account = folding.finish(recording.report().damage.clone());
        for worker in &account.workers {
            self.book.put(&self.tables.workers, worker)?;
        }
        for damage in &account.damage {
            self.book.put::<Damage>(&self.tables.damage, damage)?;
        }
        self.fact("processes", &account.processes.to_string())?;
        self.fact("results", &recording.len().to_string())?;
        self.fact("failed_attempts", &account.failed.to_string())?;
        self.fact("accounted_wall_s", &account.wall_s.to_string())?;
        let lost: u64 = account.damage.iter().map(|damage| damage.bytes).sum();
        self.fact("journal_records", &recording.report().records.to_string())?;
        self.fact("journal_bytes_lost", &lost.to_string())?;
        Ok(recording)
    }

    fn event(
        &mut self,
        entry: Entry,
        process: Option<u32>,
        event: Event,
    ) -> Result<(), StoreError> {
        let happened = Happened {
            at_byte: entry.at,
            process,
            ..Happened::default()
        };
        let happened = match event {
            Event::Finished(finished) => return self.result(&finished),
            // repeated at each opening, and told by the account
            Event::Begun { .. } | Event::Accounted(_) => return Ok(()),
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
        self.book.put(&self.tables.events, &happened)
    }

    fn result(&mut self, finished: &Finished) -> Result<(), StoreError> {
        let brief = Brief::of(finished);
        for score in &brief.scores {
            let scored = Scored {
                job: brief.job,
                score: *score,
            };
            self.book.put(&self.tables.scores, &scored)?;
        }
        self.book.put(&self.tables.results, &brief)
    }

    /// Adds a job that the run asked for, with its result; one that simulates nothing is no row.
    ///
    /// # Errors
    /// [`StoreError::Io`] or [`StoreError::Table`] if it cannot be written.
    pub fn evaluation(
        &mut self,
        label: Label,
        job: &Job,
        finished: &Finished,
    ) -> Result<(), StoreError> {
        let (condition, genes, effects) = match job {
            Job::Score(spec) => (spec.condition, &spec.genes, &spec.effects),
            Job::Simulate(spec) => (spec.condition, &spec.genes, &spec.effects),
            Job::Observe(spec) => (spec.condition, &spec.genes, &spec.effects),
            Job::ReduceHead(_) | Job::Describe | Job::Nothing { .. } => return Ok(()),
        };
        for effect in effects {
            let mut parameters = effect.parameters.iter().cloned().map(Some).collect();
            if effect.parameters.is_empty() {
                parameters = vec![None];
            }
            for parameter in parameters {
                let added = Added {
                    job: finished.job(),
                    effect: effect.id.clone(),
                    parameter,
                };
                self.book.put(&self.tables.effects, &added)?;
            }
        }
        let condition = self.case.conditions.get(condition);
        let evaluated = Evaluated {
            generation: label.generation,
            purpose: label.purpose,
            condition: condition.map_or_else(String::new, |one| one.name.clone()),
            genes: genes.clone(),
            effects: effects.len(),
            result: Brief::of(finished),
        };
        self.book.put(&self.tables.evaluations, &evaluated)
    }

    /// Completes the export and puts it into its place.
    ///
    /// # Errors
    /// [`StoreError::Io`] or [`StoreError::Table`] if something cannot be written.
    pub fn finish(mut self) -> Result<Exported, StoreError> {
        for shape in self.book.shapes() {
            for column in shape.columns {
                let row = (shape.name.to_owned(), column);
                self.book.put(&self.tables.dictionary, &row)?;
            }
        }
        let rows = self.book.finish()?;
        Ok(Exported {
            files: self.draft.publish()?,
            rows,
        })
    }
}
