//! Joins the commands to the dispatcher: the only file of the command line that names it.
use super::json::{BenchOutput, RoundTrip};
use crate::{
    core::Snapshot,
    runtime::{self, Dispatch, DispatchError, DispatchOptions},
    study::{Completed, Crew, Evaluator, EvaluatorError, WorkerStatus},
};
use protocol::{
    case::Case,
    event::RunHeader,
    id::{ContentHash, JobId},
    job::Job,
    wire,
};
use std::path::PathBuf;

/// Name and version of this program.
pub(super) const PROGRAM: &str = concat!("horsehead ", env!("CARGO_PKG_VERSION"));

/// How to open the bus.
pub(super) struct Options {
    /// Folder of the journal.
    pub(super) run_dir: PathBuf,
    /// Where other machines may connect.
    pub(super) listen: Option<String>,
    /// Whether they may do so without certificates.
    pub(super) insecure: bool,
    /// Worker processes to start here.
    pub(super) local_workers: usize,
    /// Which command the run belongs to.
    pub(super) kind: String,
    /// Canonical JSON of everything that decides the result.
    pub(super) settings: String,
}

/// The dispatcher, as an evaluator.
pub(super) struct Bus {
    dispatch: Dispatch,
}

impl Bus {
    /// Opens or resumes the journal and starts local workers.
    pub(super) async fn open(options: Options, case: &Case) -> anyhow::Result<Self> {
        let header = RunHeader {
            kind: options.kind,
            case: content_hash(case)?,
            settings: options.settings,
        };
        let dispatch = Dispatch::open(DispatchOptions {
            run_dir: options.run_dir,
            listen: options.listen,
            insecure: options.insecure,
            local_workers: options.local_workers,
            case: case.clone(),
            header,
        })
        .await
        .map_err(|error| explain(&error))?;
        Ok(Self { dispatch })
    }

    /// Tells the workers to end and waits for the local ones.
    pub(super) async fn close(self) -> anyhow::Result<()> {
        self.dispatch.close().await.map_err(|error| explain(&error))?;
        Ok(())
    }
}

impl Evaluator for Bus {
    fn submit(&mut self, id: u64, job: Job) -> Result<(), EvaluatorError> {
        self.dispatch.submit(JobId(id), job).map_err(|error| explain(&error))
    }

    async fn next(&mut self) -> Result<Completed, EvaluatorError> {
        let completed = self.dispatch.next().await.map_err(|error| explain(&error))?;
        Ok(Completed {
            id: completed.id.0,
            outcome: completed.outcome,
            replayed: completed.replayed,
        })
    }

    fn crew(&self) -> Crew {
        crew(self.dispatch.snapshot())
    }
}

fn crew(snapshot: Snapshot) -> Crew {
    let workers = snapshot.workers.into_iter().map(|worker| WorkerStatus {
        name: worker.id.to_string(),
        host: worker.host,
        attached: true,
        slots: worker.slots,
        busy: worker.busy,
        done: worker.done,
        ..WorkerStatus::default()
    });
    Crew { workers: workers.collect(), queued: snapshot.queued, running: snapshot.running }
}

fn explain(error: &DispatchError) -> EvaluatorError {
    EvaluatorError { message: error.to_string(), help: error.remedy() }
}

fn content_hash(case: &Case) -> anyhow::Result<ContentHash> {
    Ok(ContentHash::of(&wire::encode(case)?))
}

/// The name of a case's content, in hexadecimal digits.
pub(super) fn case_hash(case: &Case) -> anyhow::Result<String> {
    Ok(content_hash(case)?.to_string())
}

/// Runs a future to its end on a runtime of its own.
pub(super) fn block_on<T>(future: impl Future<Output = anyhow::Result<T>>) -> anyhow::Result<T> {
    tokio::runtime::Builder::new_multi_thread().enable_all().build()?.block_on(future)
}

/// Measures the dispatcher with no-op jobs.
pub(super) async fn bench(workers: usize, jobs: usize) -> anyhow::Result<BenchOutput> {
    let result = runtime::bench(workers, jobs).await.map_err(|error| explain(&error))?;
    Ok(BenchOutput {
        workers,
        jobs,
        rtt_ms: RoundTrip { median: result.rtt_median_ms, p99: result.rtt_p99_ms },
        jobs_per_s: result.jobs_per_s,
        coordinator_cpu_us_per_job: result.coordinator_cpu_us_per_job,
        coordinator_rss_mib: result.coordinator_rss_mib,
    })
}
