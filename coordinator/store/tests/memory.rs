//! Test that the memory of an export does not grow with the number of results, because rows are streamed.
#![expect(
    clippy::unwrap_used,
    reason = "helpers of a test: what cannot be written or read has failed"
)]
use case::{Overrides, load};
use journal::Journal;
use journal::event::{Asked, Event, Finished, JobReason, RunHeader};
use protocol::{
    id::{AttemptId, ContentHash, JobId, RunId, WorkerId},
    job::{
        Answer, ChannelScore, Counters, Evaluation, Individual, Job, Outcome, Reply, SimulateSpec,
        Verdict,
    },
    message::{Attempt, Cost},
};
use std::{env, fs, path::Path, process::Command};
use store::{Format, Store, Target};

/// Length of the residual vector of each generated test result, a tenth of the length in real runs.
const RESIDUALS: usize = 144;
/// Maximum additional memory (MiB) of an export of 50,000 evaluations compared with 5,000; these evaluations
/// take 80 MiB in the journal, and more as rows.
const MORE_MIB: u64 = 12;

fn finished(job: u64) -> Finished {
    let score = ChannelScore {
        channel: 1,
        mse: job as f64,
        mse_fixed_offset: 0.5,
        offset: 0.25,
        rmse_over_half_range: 0.1,
        relative_error: 0.1,
        peak_to_peak_error: 0.1,
    };
    Finished {
        attempt: Attempt {
            job: JobId(job),
            attempt: AttemptId::new(1, 0),
        },
        work: ContentHash::of(&job.to_le_bytes()),
        worker: Some(WorkerId(job % 64)),
        cost: Cost {
            wall_us: job,
            cpu_us: job,
        },
        outcome: Outcome::Done(Answer::Scored(Evaluation {
            verdict: Verdict::Complete,
            fitness: 1.0 / (job + 1) as f64,
            channels: vec![score; 4],
            residual: vec![0.5; RESIDUALS],
            columns: Vec::new(),
            counters: Counters::default(),
        })),
    }
}

/// Returns the peak resident memory of this process since the previous call (MiB), and resets it.
fn peak_mib() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kib = line.and_then(|line| line.split_whitespace().next()?.parse::<u64>().ok());
    fs::write("/proc/self/clear_refs", "5").unwrap();
    kib.unwrap() / 1024
}

#[test]
fn fifty_thousand_evaluations_need_the_memory_of_five_thousand() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/cyjs10-5-37hb");
    let case = load(&folder, &Overrides::default()).unwrap();
    for format in [Format::Sqlite, Format::Csv, Format::Parquet] {
        let mut peaks = Vec::new();
        for count in [5_000, 50_000] {
            let run = scratch.path().join(count.to_string());
            if !run.exists() {
                write_elsewhere(&run, count);
            }
            peak_mib();
            let target = Target {
                path: scratch.path().join(format.as_str()),
                format,
                force: false,
            };
            let mut store = Store::begin(target, &case).unwrap();
            store.journal(&run.join(journal::FILE)).unwrap();
            let rows = store.finish().unwrap().rows;
            assert_eq!((rows["evaluations"], rows["scores"]), (count, 4 * count));
            peaks.push(peak_mib());
        }
        eprintln!("{format:?}: {} MiB, then {} MiB", peaks[0], peaks[1]);
        assert!(peaks[1] <= peaks[0] + MORE_MIB, "{format:?}: {peaks:?}");
    }
}

/// Environment variable that passes the folder to the child process; [`COUNT`] passes the number of results.
const FOLDER: &str = "STORE_MEMORY_FOLDER";
const COUNT: &str = "STORE_MEMORY_COUNT";

/// Writes a journal in a child process, so that the memory needed for writing is not attributed to the
/// export.
fn write_elsewhere(folder: &Path, count: u64) {
    let status = Command::new(env::current_exe().unwrap())
        .args(["--exact", "writes_a_journal", "--ignored"])
        .env(FOLDER, folder)
        .env(COUNT, count.to_string())
        .status();
    assert!(status.unwrap().success());
}

#[test]
#[ignore = "the other test calls it, in a process of its own"]
fn writes_a_journal() {
    let folder = env::var(FOLDER).unwrap();
    write(
        Path::new(&folder),
        env::var(COUNT).unwrap().parse().unwrap(),
    );
}

fn write(folder: &Path, count: u64) {
    let header = RunHeader {
        kind: "test".to_owned(),
        case: ContentHash::of(b""),
        settings: String::new(),
    };
    let (mut journal, _) = Journal::open(folder, &header, RunId(1), 0, |_| {}).unwrap();
    let individual = Individual::new(0, vec![1.0; 10]);
    let reply = Reply::Score {
        with_residual: true,
        whole: true,
    };
    let simulated = Job::Simulate(SimulateSpec::new(individual, reply));
    let reason = JobReason {
        purpose: "initial".to_owned(),
        generation: Some(0),
    };
    for job in 0..count {
        let asked = Asked::new(JobId(job), &simulated, reason.clone());
        journal.append(Event::Asked(Box::new(asked))).unwrap();
        journal
            .append(Event::Finished(Box::new(finished(job))))
            .unwrap();
    }
    journal.close();
}
