//! Adapter that makes the dispatcher an evaluator: options, opening, and conversion of its errors to messages
//! with remedies.
use crate::cli::{argument::listening::RemoteAccess, output::problem::Problem};
use dispatch::runtime::{Dispatch, DispatchError, DispatchOptions, RunHeader, Snapshot};
use dispatch::scheduler::StopReason;
use journal::{JournalError, event::JobReason};
use link::LinkError;
use protocol::{
    case::Case,
    id::{ContentHash, JobId},
    job::{Job, Outcome},
    wire,
};
use serde::Serialize;
use std::{collections::BTreeMap, path::PathBuf, time::Duration};
use study::{
    Completed, Entry, Evaluator, EvaluatorError, JobNumbers, WorkerStatus, WorkersSnapshot,
};

/// Name and version of this program, as recorded in runs and exports.
pub(crate) const PROGRAM: &str = concat!("horsehead ", env!("CARGO_PKG_VERSION"));

/// Maximum number of reasons for which jobs could not be computed that a session reports.
const MOST_REASONS: usize = 3;

/// Options for opening the dispatcher.
pub(crate) struct Options {
    /// Run folder, in which the dispatcher keeps the journal.
    pub(crate) run_dir: PathBuf,
    /// Network access for workers of other machines: listening address and key material.
    pub(crate) network: RemoteAccess,
    /// Number of worker processes to start on this machine.
    pub(crate) local_workers: usize,
    /// Longest time for which the run waits while its disk is full.
    pub(crate) pause_limit: Duration,
    pub(crate) kind: String,
    /// Canonical JSON of all settings of the run that determine its result.
    pub(crate) settings: String,
}

impl Options {
    pub(crate) fn for_dispatch(self, case: &Case) -> anyhow::Result<DispatchOptions> {
        Ok(DispatchOptions {
            run_dir: self.run_dir,
            listen: self.network.listen,
            insecure: self.network.insecure,
            tls: self.network.tls,
            local_workers: self.local_workers,
            pause_limit: self.pause_limit,
            case: case.clone(),
            header: RunHeader {
                kind: self.kind,
                case: content_hash(case)?,
                settings: self.settings,
            },
        })
    }
}

/// Evaluator that runs jobs through the dispatcher.
pub(crate) struct Bus {
    dispatch: Dispatch,
    journal: PathBuf,
    /// Number of jobs that could not be computed and the first of their reasons, by the first line of the reason.
    failures: BTreeMap<String, (usize, String)>,
}

impl Bus {
    /// Opens or resumes the journal of a run and starts the local workers.
    ///
    /// # Errors
    /// If the local workers cannot run the case, or the dispatcher cannot be opened.
    pub(crate) async fn open(options: Options, case: &Case) -> anyhow::Result<Self> {
        let unready =
            (options.local_workers > 0).then(|| case::kind::of(case).readiness_problem(case));
        if let Some((message, help)) = unready.flatten() {
            return Err(Problem {
                message,
                remedy: help,
            }
            .into());
        }
        let options = options.for_dispatch(case)?;
        let journal = options.run_dir.join(journal::FILE);
        let dispatch = Dispatch::open(options)
            .await
            .map_err(|error| refuse(&error))?;
        Ok(Self {
            dispatch,
            journal,
            failures: BTreeMap::new(),
        })
    }

    /// Returns the number of results recorded in the journal by earlier sessions.
    pub(crate) const fn recorded(&self) -> usize {
        self.dispatch.recorded()
    }

    /// Returns a sentence for each of the most frequent reasons for which jobs could not be computed, and one on the
    /// others.
    pub(crate) fn failures(&self) -> Vec<String> {
        let mut all: Vec<_> = self.failures.values().collect();
        all.sort_by_key(|(count, _)| std::cmp::Reverse(*count));
        let (most, others) = all.split_at(all.len().min(MOST_REASONS));
        let sentence = |(count, reason): &&(usize, String)| match count {
            1 => format!("one simulation could not be computed: {reason}"),
            _ => format!("{count} simulations could not be computed: {reason}"),
        };
        let mut sentences: Vec<String> = most.iter().map(sentence).collect();
        let others: usize = others.iter().map(|(count, _)| count).sum();
        if others > 0 {
            sentences.push(format!(
                "{others} more could not be computed for other reasons"
            ));
        }
        sentences
    }

    /// Shuts down all workers of the run and waits for the local ones to exit.
    pub(crate) async fn close(self) -> anyhow::Result<()> {
        self.dispatch
            .close()
            .await
            .map_err(|error| explain(&error))?;
        Ok(())
    }
}

impl Evaluator for Bus {
    fn submit(&mut self, id: JobId, job: Job, reason: JobReason) -> Result<(), EvaluatorError> {
        self.dispatch
            .submit(id, job, reason)
            .map_err(|error| explain(&error))
    }

    fn enter(&mut self, entry: &Entry) -> Result<(), EvaluatorError> {
        let entry = wire::encode(entry).map_err(|error| EvaluatorError {
            message: error.to_string(),
            help: None,
        })?;
        self.dispatch.enter(entry).map_err(|error| explain(&error))
    }

    fn anticipate(&mut self, jobs: Vec<Job>) -> Result<(), EvaluatorError> {
        let sent = self.dispatch.anticipate(jobs);
        sent.map_err(|error| explain(&error))
    }

    fn computes_ahead(&self) -> bool {
        self.dispatch.has_idle_slots()
    }

    async fn next(&mut self) -> Result<Completed, EvaluatorError> {
        let completed = self.dispatch.next().await;
        let completed = completed.map_err(|error| explain(&error))?;
        if let Outcome::Failed(failure) = &completed.outcome {
            let reason = failure.to_string();
            // what a program printed may differ from run to run
            let first = reason.lines().next().unwrap_or_default().to_owned();
            self.failures.entry(first).or_insert((0, reason)).0 += 1;
        }
        Ok(completed)
    }

    fn numbers(&self) -> Result<JobNumbers, EvaluatorError> {
        let mut numbers = JobNumbers::default();
        let read = journal::numbers(&self.journal, |job, work| numbers.note(job, work));
        read.map(|()| numbers)
            .map_err(|error| explain(&error.into()))
    }

    fn workers_status(&self) -> WorkersSnapshot {
        crew(self.dispatch.snapshot())
    }
}

fn crew(snapshot: Snapshot) -> WorkersSnapshot {
    let workers = snapshot.workers.into_iter().map(|worker| WorkerStatus {
        name: worker.id.to_string(),
        host: worker.host,
        attached: true,
        slots: worker.slots,
        busy: worker.busy,
        done: worker.done,
        failed: worker.failed,
        busy_s: worker.spent.useful_us as f64 / 1e6,
        present_s: worker.spent.connected_us as f64 / 1e6 / f64::from(worker.slots.max(1)),
    });
    WorkersSnapshot {
        workers: workers.collect(),
        queued: snapshot.queued,
        running: snapshot.running,
        spent: snapshot.spent,
        computing: snapshot.computing,
    }
}

/// Converts an error of opening a run to one with a remedy, mostly a corrected command line argument.
fn refuse(error: &DispatchError) -> anyhow::Error {
    let help = match error {
        DispatchError::NoWorkers => {
            "for example --workers 2, or --listen quic/0.0.0.0:7447 --tls DIR"
        }
        DispatchError::Listen { .. } => {
            "choose another address or port, as --listen quic/0.0.0.0:7448; port 0 takes any free one"
        }
        DispatchError::Link(LinkError::Transport { .. }) => "choose another address with --listen",
        DispatchError::Link(LinkError::NoKeys { .. } | LinkError::Keys(_)) => {
            "`horsehead keys new DIR --host NAME` makes certificates; --tls DIR uses them"
        }
        DispatchError::Link(_) => {
            "for example --listen quic/0.0.0.0:7447 --tls DIR, or --listen unix/PATH"
        }
        DispatchError::Socket(_) => "set TMPDIR to a folder that can be written",
        DispatchError::Journal(JournalError::Io { .. }) => {
            "choose a folder that can be written, with --run DIR"
        }
        DispatchError::Journal(_) => "another folder is chosen with --run DIR",
        DispatchError::Locate(_)
        | DispatchError::Case(_)
        | DispatchError::Start(_)
        | DispatchError::LocalWorkers { .. }
        | DispatchError::JobDiffers { .. }
        | DispatchError::Paused { .. }
        | DispatchError::Stopped(_)
        | DispatchError::Closed => return explain(error).into(),
    };
    Problem {
        message: without_source_places(&error.to_string()),
        remedy: help.to_owned(),
    }
    .into()
}

/// Removes source locations such as ` at /some/file.rs:12`, which the transport library adds to its error
/// messages.
fn without_source_places(text: &str) -> String {
    let mut kept = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find(" at /") {
        let (before, place) = rest.split_at(at);
        kept.push_str(before);
        let path = place.trim_start_matches(" at ");
        let end = path.find(char::is_whitespace).unwrap_or(path.len());
        let (path, after) = path.split_at(end);
        if !path.contains(".rs:") {
            kept.push_str(" at ");
            kept.push_str(path);
        }
        rest = after;
    }
    kept + rest
}

/// Converts an error of the dispatcher during a run to an evaluator error, which has no remedy.
pub(crate) fn explain(error: &DispatchError) -> EvaluatorError {
    let of_program = matches!(
        error,
        DispatchError::Stopped(StopReason::EverythingFails { last, .. }) if last.is_of_program()
    );
    EvaluatorError {
        message: without_source_places(&error.to_string()),
        help: of_program.then(|| study::PROGRAM_REMEDY.to_owned()),
    }
}

/// Computes the hash of a value's serialised content.
pub(crate) fn content_hash(content: &impl Serialize) -> anyhow::Result<ContentHash> {
    Ok(ContentHash::of(&wire::encode(content)?))
}

/// Returns the first eight hexadecimal digits of a value's content hash, for names.
pub(crate) fn short_hash(value: &impl Serialize) -> anyhow::Result<String> {
    let hash = content_hash(value)?.to_string();
    Ok(hash.get(..8).unwrap_or_default().to_owned())
}

/// Computes the content hash of a case as hexadecimal digits.
pub(crate) fn case_hash(case: &Case) -> anyhow::Result<String> {
    Ok(content_hash(case)?.to_string())
}

/// Runs a future to completion on a runtime of its own.
pub(crate) fn block_on<T>(future: impl Future<Output = anyhow::Result<T>>) -> anyhow::Result<T> {
    tokio::runtime::Builder::new_multi_thread()
        .enable_all()
        .build()?
        .block_on(future)
}

#[cfg(test)]
mod tests {
    use super::without_source_places;

    #[test]
    fn places_in_the_source_of_the_transport_are_left_out() {
        assert_eq!(
            without_source_places(
                "cannot listen: in use (os error 98) at /a/b-1.2/src/unicast.rs:362. at /c/d.rs:1"
            ),
            "cannot listen: in use (os error 98)"
        );
        let plain = "cannot write at /data/run: full";
        assert_eq!(without_source_places(plain), plain);
    }
}
