//! Checks that a coordinator that reads its messages late does not take a worker for silent whose messages
//! have arrived but are unread.
use dispatch::runtime::Dispatch;
use link::{CoordinatorEnd, LinkEvent};
use protocol::{
    announce::{Announcement, ModelDescriptor},
    id::{ContentHash, RunId, WorkerId},
    key::Lane,
    message::{FromWorker, Heartbeat},
    proof::ReferenceResult,
    wire::{self, FrameKind},
};
use std::{
    collections::VecDeque,
    future::pending,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread,
    time::{Duration, Instant},
};
use tests::{empty_case, options};

/// Time that the simulated busy machine takes to read one message.
const READING: Duration = Duration::from_millis(20);
/// Number of one worker's messages queued before the other worker's heartbeat: reading them takes longer than
/// a worker may be silent.
const WORDS: u64 = 240;

/// Coordinator end of a link with a backlog of messages.
struct Backlog {
    heard: VecDeque<LinkEvent>,
    read: Arc<AtomicBool>,
}

impl CoordinatorEnd for Backlog {
    fn send(&mut self, _to: WorkerId, _lane: Lane, _frame: Vec<u8>) {}

    async fn receive(&mut self) -> Option<LinkEvent> {
        let Some(heard) = self.heard.pop_front() else {
            self.read.store(true, Ordering::Relaxed);
            return pending().await;
        };
        thread::sleep(READING);
        Some(heard)
    }

    async fn close(self) {}
}

fn announcement() -> FromWorker {
    FromWorker::Announce(Box::new(Announcement {
        protocol: wire::VERSION,
        build: format!("{} test", env!("CARGO_PKG_VERSION")),
        host: "here".to_owned(),
        pid: 1,
        slots: 1,
        cores: 1,
        job_kinds: Vec::new(),
        models: vec![ModelDescriptor {
            kind: empty_case().model.kind,
            digest: "m".to_owned(),
            effects: Vec::new(),
        }],
    }))
}

fn beat(number: u64) -> FromWorker {
    FromWorker::Beat(Heartbeat {
        number,
        case: Some(ContentHash::of(&wire::encode(&empty_case()).unwrap())),
        proof: Some(ReferenceResult::Bits(ContentHash::of(b"proof"))),
        ..Heartbeat::default()
    })
}

/// Regression test from a machine with thirty times more processes than cores: messages stayed unread for
/// longer than a worker may be silent, and workers whose messages were further back in the queue were
/// declared lost.
#[tokio::test(flavor = "multi_thread")]
async fn silence_is_judged_only_after_what_has_arrived_was_read() {
    let folder = tempfile::tempdir().unwrap();
    let (talker, other) = (WorkerId(1), WorkerId(2));
    let read = Arc::new(AtomicBool::new(false));
    let made = Dispatch::over(&options(folder.path(), None, 0), |run: RunId, _| {
        let word = |from, message: FromWorker| {
            let frame = wire::encode_frame(FrameKind::FromWorker, run, &message).unwrap();
            LinkEvent::Frame(from, frame)
        };
        let mut heard: VecDeque<LinkEvent> = [talker, other]
            .into_iter()
            .flat_map(|from| [word(from, announcement()), word(from, beat(0))])
            .collect();
        heard.extend((1..WORDS).map(|number| word(talker, beat(number))));
        heard.push_back(word(other, beat(1)));
        Backlog {
            heard,
            read: Arc::clone(&read),
        }
    });
    let dispatch = made.unwrap();
    let begun = Instant::now();
    while !read.load(Ordering::Relaxed) {
        tokio::time::sleep(Duration::from_millis(20)).await;
    }
    let took = begun.elapsed();
    assert!(took > Duration::from_millis(4500), "read in {took:?}");
    // the state is shown after each look at the clocks
    tokio::time::sleep(Duration::from_millis(700)).await;
    let state = dispatch.snapshot();
    assert_eq!((state.lost, state.workers.len()), (0, 2), "{state:?}");
    dispatch.close().await.unwrap();
}
