//! Joins the commands to the dispatcher: the only file of the command line that names it.
use super::{
    Door, interrupt,
    json::{BenchOutput, RoundTrip, SilentOutput},
    problem::Usage,
};
use crate::{
    journal::JournalError,
    runtime::{
        self, BenchPlan, Dispatch, DispatchError, DispatchOptions, RunHeader, SilentResult,
        Snapshot,
    },
    study::{Completed, Crew, Evaluator, EvaluatorError, Stop, StudyError, WorkerStatus},
};
use anyhow::Context as _;
use link::LinkError;
use protocol::{
    case::Case,
    id::{ContentHash, JobId},
    job::Job,
    wire,
};
use serde::Serialize;
use std::path::PathBuf;

/// Name and version of this program.
pub(super) const PROGRAM: &str = concat!("horsehead ", env!("CARGO_PKG_VERSION"));

/// How to open the bus.
pub(super) struct Options {
    /// Folder of the journal.
    pub(super) run_dir: PathBuf,
    /// How other machines may join.
    pub(super) door: Door,
    /// Worker processes to start here.
    pub(super) local_workers: usize,
    /// Which command the run belongs to.
    pub(super) kind: String,
    /// Canonical JSON of everything that decides the result.
    pub(super) settings: String,
}

impl Options {
    fn for_dispatch(self, case: &Case) -> anyhow::Result<DispatchOptions> {
        Ok(DispatchOptions {
            run_dir: self.run_dir,
            listen: self.door.listen,
            insecure: self.door.insecure,
            tls: self.door.tls,
            local_workers: self.local_workers,
            case: case.clone(),
            header: RunHeader {
                kind: self.kind,
                case: content_hash(case)?,
                settings: self.settings,
            },
        })
    }
}

/// The dispatcher, as an evaluator.
pub(super) struct Bus {
    dispatch: Dispatch,
}

impl Bus {
    /// Opens or resumes the journal and starts local workers.
    pub(super) async fn open(options: Options, case: &Case) -> anyhow::Result<Self> {
        let options = options.for_dispatch(case)?;
        let dispatch = Dispatch::open(options)
            .await
            .map_err(|error| refuse(&error))?;
        Ok(Self { dispatch })
    }

    /// How many results earlier sessions left in the journal.
    pub(super) const fn recorded(&self) -> usize {
        self.dispatch.recorded()
    }

    /// Tells the workers to end and waits for the local ones.
    pub(super) async fn close(self) -> anyhow::Result<()> {
        self.dispatch
            .close()
            .await
            .map_err(|error| explain(&error))?;
        Ok(())
    }
}

impl Evaluator for Bus {
    fn submit(&mut self, id: u64, job: Job) -> Result<(), EvaluatorError> {
        self.dispatch
            .submit(JobId(id), job)
            .map_err(|error| explain(&error))
    }

    async fn next(&mut self) -> Result<Completed, EvaluatorError> {
        let completed = self
            .dispatch
            .next()
            .await
            .map_err(|error| explain(&error))?;
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
        failed: worker.failed,
        busy_s: worker.spent.useful_us as f64 / 1e6,
        present_s: worker.spent.connected_us as f64 / 1e6 / f64::from(worker.slots.max(1)),
    });
    Crew {
        workers: workers.collect(),
        queued: snapshot.queued,
        running: snapshot.running,
        spent: snapshot.spent,
    }
}

/// Why a run cannot be opened: most often because of what was typed.
fn refuse(error: &DispatchError) -> anyhow::Error {
    let help = match error {
        DispatchError::NobodyToAsk => "for example --workers 2, or --listen tcp/127.0.0.1:7447",
        DispatchError::Listen { .. } => {
            "choose another address or port, as --listen tcp/127.0.0.1:7447; port 0 takes any \
             free one"
        }
        DispatchError::Link(LinkError::Transport { .. }) => "choose another address with --listen",
        DispatchError::Link(LinkError::NoKeys { .. } | LinkError::Keys(_)) => {
            "`horsehead keys new DIR --host NAME` makes certificates; --tls DIR uses them"
        }
        DispatchError::Link(_) => "for example --listen tcp/127.0.0.1:7447",
        DispatchError::Journal(JournalError::Io { .. }) => {
            "choose a folder that can be written, with --run DIR"
        }
        DispatchError::Journal(_) => "another folder is chosen with --run DIR",
        DispatchError::Locate(_)
        | DispatchError::Case(_)
        | DispatchError::Start(_)
        | DispatchError::LocalWorkers { .. }
        | DispatchError::JobDiffers { .. }
        | DispatchError::Stopped(_)
        | DispatchError::Closed => return explain(error).into(),
    };
    Usage {
        message: without_source_places(&error.to_string()),
        help: help.to_owned(),
    }
    .into()
}

/// The text without ` at /some/file.rs:12`, with which the transport tells where in its own
/// source an error was made.
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

fn explain(error: &DispatchError) -> EvaluatorError {
    EvaluatorError {
        message: without_source_places(&error.to_string()),
        help: None,
    }
}

/// The name of some content.
pub(super) fn content_hash(content: &impl Serialize) -> anyhow::Result<ContentHash> {
    Ok(ContentHash::of(&wire::encode(content)?))
}

/// The name of a case's content, in hexadecimal digits.
pub(super) fn case_hash(case: &Case) -> anyhow::Result<String> {
    Ok(content_hash(case)?.to_string())
}

/// Runs a future to its end on a runtime of its own.
pub(super) fn block_on<T>(future: impl Future<Output = anyhow::Result<T>>) -> anyhow::Result<T> {
    tokio::runtime::Builder::new_multi_thread()
        .enable_all()
        .build()?
        .block_on(future)
}

/// Works with local workers, without a run folder that outlives the command.
pub(super) fn in_scratch<T>(
    case: &Case,
    (kind, local_workers): (&str, usize),
    work: impl AsyncFnOnce(&mut Bus, &mut Stop) -> Result<T, StudyError>,
) -> anyhow::Result<T> {
    let scratch = tempfile::tempdir().context("cannot make a scratch folder")?;
    // what decides the result is not written down where nothing is resumed
    let settings = serde_json::to_string(&(kind, scratch.path()))?;
    block_on(async {
        let mut stop = interrupt::listen();
        let options = Options {
            run_dir: scratch.path().to_owned(),
            door: Door::default(),
            local_workers,
            kind: kind.to_owned(),
            settings,
        };
        let mut bus = Bus::open(options, case).await?;
        let result = work(&mut bus, &mut stop).await;
        bus.close().await?;
        Ok(result?)
    })
}

/// Measures the dispatcher with no-op jobs, in a scratch folder; with key material, over QUIC.
pub(super) async fn bench(plan: BenchPlan, tls: Option<PathBuf>) -> anyhow::Result<BenchOutput> {
    let scratch = tempfile::tempdir()?;
    let options = Options {
        run_dir: scratch.path().to_owned(),
        door: Door {
            tls,
            ..Door::default()
        },
        local_workers: 0,
        kind: "bench".to_owned(),
        settings: "{}".to_owned(),
    };
    let options = options.for_dispatch(&empty_case()?)?;
    let result = runtime::bench(options, plan)
        .await
        .map_err(|error| explain(&error))?;
    Ok(BenchOutput {
        crew: match plan.crew {
            runtime::Crew::Processes => "processes",
            runtime::Crew::Connections => "connections",
            runtime::Crew::Sessions => "sessions",
        },
        workers: result.workers,
        joined_s: result.joined_s,
        jobs: result.jobs,
        rtt_ms: RoundTrip {
            median: result.rtt_median_ms,
            p99: result.rtt_p99_ms,
        },
        jobs_per_s: result.jobs_per_s,
        coordinator_cpu_us_per_job: result.coordinator_cpu_us_per_job,
        cost_ratio: result.cost_ratio,
        coordinator_rss_mib: result.coordinator_rss_mib,
        silent: result.silent.map(silent),
    })
}

fn silent(result: SilentResult) -> SilentOutput {
    let (smallest, largest) = result.rate_ratio_range;
    SilentOutput {
        connections: result.connections,
        held: result.held,
        reopened: result.reopened,
        turns: result.turns,
        jobs_per_s_without: result.jobs_per_s_without,
        jobs_per_s_beside: result.jobs_per_s_beside,
        rate_ratio: result.rate_ratio,
        rate_ratio_range: [smallest, largest],
        cpu_ratio: result.cpu_ratio,
    }
}

/// A case in which everything is zero or empty: jobs that do nothing need no more. Its encoding
/// is a row of zeros, whose length depends on the version of the case.
fn empty_case() -> anyhow::Result<Case> {
    let zeros = [0; 4096];
    (1..zeros.len())
        .find_map(|length| wire::decode(&zeros[..length]).ok())
        .ok_or_else(|| anyhow::anyhow!("this version of the case cannot be all zeros"))
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
