//! Measurement with 64 worker processes, one of which freezes; needs an otherwise idle machine.
//!
//! ```text
//! cargo test --workspace --test cluster -- --ignored --nocapture sixty_four
//! ```
use super::LIMIT;
use dispatch::runtime::Dispatch;
use journal::event::JobReason;
use protocol::{
    id::JobId,
    job::{Answer, Job, Outcome},
};
use rustix::process::Signal;
use std::time::{Duration, Instant};
use tests::{
    options,
    process::{Process, free_locator, wait_until},
};

const WORKERS: usize = 64;
/// Number of jobs that are submitted but not finished at any time: two for each worker, and some to spare.
const AHEAD: u64 = 3 * WORKERS as u64;

struct Load {
    dispatch: Dispatch,
    order_bytes: usize,
    delay_ms: u32,
    asked: u64,
    done: u64,
}

impl Load {
    /// Keeps all workers supplied with jobs for the given time; returns the rate of completed jobs \[1/s\].
    async fn rate(&mut self, time: Duration) -> f64 {
        let (begun, before) = (Instant::now(), self.done);
        while begun.elapsed() < time {
            self.ask(self.done + AHEAD);
            self.next().await;
        }
        (self.done - before) as f64 / begun.elapsed().as_secs_f64()
    }

    fn ask(&mut self, until: u64) {
        for n in self.asked..until {
            let job = Job::Nothing {
                payload: vec![1; self.order_bytes],
                reply_bytes: 10_000,
                delay_ms: self.delay_ms,
            };
            self.dispatch
                .submit(JobId(n), job, JobReason::default())
                .unwrap();
        }
        self.asked = self.asked.max(until);
    }

    async fn next(&mut self) {
        let completed = tokio::time::timeout(LIMIT, self.dispatch.next()).await;
        let outcome = completed.unwrap().unwrap().outcome;
        assert!(
            matches!(outcome, Outcome::Done(Answer::Nothing(_))),
            "{outcome:?}"
        );
        self.done += 1;
    }
}

#[tokio::test(flavor = "multi_thread")]
#[ignore = "a measurement: needs a machine of its own for a minute"]
async fn one_frozen_worker_of_sixty_four_costs_the_others_at_most_a_tenth() {
    let (share, said) = frozen(4000, 200, Duration::from_secs(10)).await;
    eprintln!("{said}");
    assert!(share >= 0.9, "{share}");
}

/// Measures the effect of one frozen worker with two jobs of 3 MB each in transit to it: more than the socket
/// buffers hold, so that its connection is blocked.
#[tokio::test(flavor = "multi_thread")]
#[ignore = "a measurement: needs a machine of its own for a minute and 2 GB of memory"]
async fn a_full_pipe_to_one_of_sixty_four_costs_the_others_at_most_a_tenth() {
    let (share, said) = frozen(3_000_000, 3000, Duration::from_secs(30)).await;
    eprintln!("{said}");
    assert!(share >= 0.9, "{share}");
}

/// Measures the job rate for the given time without and with one frozen worker of 64; returns the share of
/// their rate that the others keep \[1\], and a report sentence.
async fn frozen(order_bytes: usize, delay_ms: u32, time: Duration) -> (f64, String) {
    let folder = tempfile::tempdir().unwrap();
    let locator = free_locator();
    let dispatch = Dispatch::open(options(folder.path(), Some(&locator), 0))
        .await
        .unwrap();
    let workers: Vec<Process> = (0..WORKERS)
        .map(|_| Process::worker(&locator, &["--slots", "1"]))
        .collect();
    wait_until("all are there", LIMIT, || {
        dispatch.snapshot().workers.len() == WORKERS
    });
    let mut load = Load {
        dispatch,
        order_bytes,
        delay_ms,
        asked: 0,
        done: 0,
    };
    load.rate(time / 2).await;
    let before = load.rate(time).await;
    workers[0].signal(Signal::STOP);
    let frozen = load.rate(time).await;
    workers[0].signal(Signal::CONT);
    while load.done < load.asked {
        load.next().await;
    }
    let last = load.dispatch.close().await.unwrap().last;
    let share = (frozen / (WORKERS as f64 - 1.0)) / (before / WORKERS as f64);
    let said = format!(
        "{before:.0} jobs a second on {WORKERS} workers, {frozen:.0} with one frozen: the others do \
         {:.1} % of what they did; {} lost, {} done",
        100.0 * share,
        last.lost,
        last.done
    );
    assert_eq!((last.failed, last.done as u64), (0, load.asked));
    (share, said)
}
