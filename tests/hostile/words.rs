//! Tests with peers that speak the protocol but send malformed messages, old versions, wrong models, or
//! forged results.
use super::{LIMIT, MEASURING, rate};
use dispatch::runtime::{Dispatch, Snapshot};
use journal::event::JobReason;
use protocol::pumping_unit::Machine;
use protocol::{
    announce::{Announcement, ModelDescriptor},
    id::{AttemptId, ContentHash, JobId, RunId},
    job::{Answer, Outcome},
    key::{self, Lane},
    message::{Attempt, Cost, Done, FromWorker, Heartbeat, ToWorker},
    name::WorkerName,
    wire::{self, FrameKind},
};
use serde::{Serialize, Serializer, ser::SerializeTuple};
use std::{
    collections::BTreeMap,
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, AtomicU64, Ordering},
    },
    time::Duration,
};
use tests::{
    expect_results,
    keys::raw_session,
    options,
    process::{Process, free_tcp_locator, wait_until},
};
use worker::SIMULATORS;
use zenoh::{Session, Wait};

/// Peer with a real Zenoh session that ignores the rules of the protocol.
struct Peer {
    session: Session,
    name: WorkerName,
    heard: Arc<Mutex<Vec<(RunId, ToWorker)>>>,
}

impl Peer {
    async fn join(locator: &str, process: u64) -> Self {
        let nowhere = std::path::Path::new("");
        let session = raw_session(locator, nowhere, false, 5000).await.unwrap();
        let name = WorkerName::anyone(process);
        let heard: Arc<Mutex<Vec<(RunId, ToWorker)>>> = Arc::default();
        for lane in [Lane::Data, Lane::Control] {
            let to = Arc::clone(&heard);
            session
                .declare_subscriber(key::to_worker(&name, lane))
                .callback(move |sample| {
                    if let Ok(message) =
                        wire::decode_frame(FrameKind::ToWorker, &sample.payload().to_bytes())
                    {
                        to.lock().unwrap().push(message);
                    }
                })
                .background()
                .await
                .unwrap();
        }
        Self {
            session,
            name,
            heard,
        }
    }

    fn throw(&self, run: RunId, lane: Lane, bytes: Vec<u8>) {
        let key = key::from_worker(run, &self.name, lane);
        self.session.put(key, bytes).wait().unwrap();
    }

    fn say(&self, run: RunId, lane: Lane, message: &FromWorker) {
        let frame = wire::encode_frame(FrameKind::FromWorker, run, message).unwrap();
        self.throw(run, lane, frame);
    }

    /// Announces the peer repeatedly until an answer that satisfies `fits` arrives; returns the run stated in
    /// the answer's frame.
    fn announce_until(
        &self,
        announcement: &Announcement,
        fits: impl Fn(&ToWorker) -> bool,
    ) -> RunId {
        let message = FromWorker::Announce(Box::new(announcement.clone()));
        let mut run = RunId(0);
        wait_until("an answer that fits", LIMIT, || {
            self.say(RunId(0), Lane::Control, &message);
            std::thread::sleep(Duration::from_millis(20));
            let heard = self.heard.lock().unwrap();
            let found = heard.iter().find(|(_, message)| fits(message));
            if let Some((of, _)) = found {
                run = *of;
            }
            found.is_some()
        });
        run
    }
}

fn announcement(digest: &str) -> Announcement {
    Announcement {
        protocol: wire::VERSION,
        build: format!("{} test", env!("CARGO_PKG_VERSION")),
        host: "elsewhere".to_owned(),
        pid: 1,
        slots: 1,
        cores: 1,
        job_kinds: Vec::new(),
        models: vec![ModelDescriptor {
            kind: Machine::KIND.to_owned(),
            digest: digest.to_owned(),
            effects: SIMULATORS[0].effects(),
        }],
    }
}

/// Opens a coordinator with one joined, correctly behaving worker.
async fn stage(folder: &std::path::Path) -> (Dispatch, Process, String) {
    let locator = free_tcp_locator();
    let dispatch = Dispatch::open(options(folder, Some(&locator), 0))
        .await
        .unwrap();
    let honest = Process::worker(&locator, &["--slots", "2"]);
    wait_until("the honest worker joins", LIMIT, || {
        dispatch.snapshot().workers.len() == 1
    });
    (dispatch, honest, locator)
}

fn refusal_of(field: &'static str) -> impl Fn(&ToWorker) -> bool {
    move |message| matches!(message, ToWorker::Refused { reason } if reason.starts_with(field))
}

#[tokio::test(flavor = "multi_thread")]
async fn whoever_does_not_fit_is_refused_by_the_field_that_is_wrong() {
    let _others = MEASURING.read().await;
    let folder = tempfile::tempdir().unwrap();
    let (dispatch, _honest, locator) = stage(folder.path()).await;
    let peer = Peer::join(&locator, 1).await;
    let begun = std::time::Instant::now();
    peer.announce_until(
        &announcement("another model"),
        refusal_of("model digest is another model"),
    );
    let old = Announcement {
        protocol: 99,
        ..announcement("x")
    };
    peer.announce_until(&old, refusal_of("protocol is 99"));
    for slots in [0, u32::MAX] {
        let absurd = Announcement {
            slots,
            ..announcement("x")
        };
        peer.announce_until(&absurd, refusal_of("slots is"));
    }
    eprintln!("four refusals within {:?}", begun.elapsed());
    // a frame of another version is answered in ours, so that the other end can say why
    peer.heard.lock().unwrap().clear();
    let mut other = wire::encode_frame(
        FrameKind::FromWorker,
        RunId(0),
        &FromWorker::Beat(Heartbeat::default()),
    )
    .unwrap();
    other[2] = wire::VERSION + 1;
    wait_until("an answer to another version", LIMIT, || {
        peer.throw(RunId(0), Lane::Control, other.clone());
        std::thread::sleep(Duration::from_millis(20));
        let heard = peer.heard.lock().unwrap();
        heard
            .iter()
            .any(|(_, message)| *message == ToWorker::Identify)
    });
    assert_eq!(
        dispatch.snapshot().workers.len(),
        1,
        "nobody of them joined"
    );
    peer.session.close().await.unwrap();
    dispatch.close().await.unwrap();
}

/// Message body that serialises to its raw bytes, for a frame with a matching checksum.
struct Raw(Vec<u8>);

impl Serialize for Raw {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        // a tuple is nothing but its members, one after the other
        let mut tuple = to.serialize_tuple(self.0.len())?;
        for byte in &self.0 {
            tuple.serialize_element(byte)?;
        }
        tuple.end()
    }
}

/// Wraps a malformed message body in a valid frame, so that it reaches the decoder.
fn around(run: RunId, body: &[u8]) -> Vec<u8> {
    let frame = wire::encode_frame(FrameKind::FromWorker, run, &Raw(body.to_vec())).unwrap();
    assert_eq!(
        wire::parse_frame(FrameKind::FromWorker, &frame)
            .unwrap()
            .body,
        body
    );
    frame
}

/// Checks that a malformed body in a valid frame fails in the decoder and not before.
#[test]
fn damaged_bodies_reach_the_decoder() {
    let promise = around(RunId(1), &endless());
    let read = wire::decode_frame::<FromWorker>(FrameKind::FromWorker, &promise);
    assert!(
        matches!(read, Err(wire::WireError::Malformed { .. })),
        "{read:?}"
    );
}

/// Returns a heartbeat whose encoded list length exceeds the available memory.
fn endless() -> Vec<u8> {
    let mut body = wire::encode(&FromWorker::Beat(Heartbeat::default())).unwrap();
    let end = body.len();
    body[end - 8..].fill(0xff);
    body
}

/// Publishes malformed frames of every kind, about 2,000 a second, until `stop` is set; returns their number.
fn throw_rubbish(peer: &Peer, run: RunId, digest: &str, stop: &AtomicBool) -> u64 {
    let good = FromWorker::Announce(Box::new(announcement(digest)));
    let body = wire::encode(&good).unwrap();
    let good = wire::encode_frame(FrameKind::FromWorker, run, &good).unwrap();
    let mut thrown = 0_u64;
    while !stop.load(Ordering::Relaxed) {
        let at = usize::try_from(thrown).unwrap_or(0);
        let mut frame = good.clone();
        match thrown % 10 {
            // half a frame
            0 => frame.truncate(at % good.len()),
            // a length that nobody can mean
            1 => frame[12..16].copy_from_slice(&u32::MAX.to_le_bytes()),
            // a kind that there is not
            2 => frame[3] = 200,
            3 => frame[at % good.len()] ^= 0x40,
            // promises a vector of more than there is memory for
            4 => frame = around(run, &endless()),
            // a body that is cut, and one with a flipped bit, in frames that know nothing of it
            7 => frame = around(run, &body[..at % body.len()]),
            8 => {
                let mut body = body.clone();
                let at = at % body.len();
                body[at] ^= 1 << (thrown / 10 % 8);
                frame = around(run, &body);
            }
            5 => frame = vec![0xff; at % 70_000],
            6 => frame.extend_from_slice(&good),
            // sound, but of another run
            _ => {
                let beat = FromWorker::Beat(Heartbeat::default());
                frame = wire::encode_frame(FrameKind::FromWorker, RunId(thrown), &beat).unwrap();
            }
        }
        let lane = if thrown.is_multiple_of(2) {
            Lane::Data
        } else {
            Lane::Control
        };
        peer.throw(run, lane, frame);
        thrown += 1;
        // 2,000 a second: a flood, not a race for the processor that it shares with its victims
        std::thread::sleep(Duration::from_micros(500));
    }
    thrown
}

#[tokio::test(flavor = "multi_thread")]
async fn rubbish_costs_little_and_no_result() {
    let _alone = MEASURING.write().await;
    let folder = tempfile::tempdir().unwrap();
    let (mut dispatch, _honest, locator) = stage(folder.path()).await;
    let peer = Arc::new(Peer::join(&locator, 1).await);
    let mut results = BTreeMap::new();
    let time = Duration::from_secs(2);
    let before = rate(&mut dispatch, &mut results, time).await;
    let (stop, thrown) = (
        Arc::new(AtomicBool::new(false)),
        Arc::new(AtomicU64::new(0)),
    );
    let thrower = {
        let (peer, stop, thrown) = (Arc::clone(&peer), Arc::clone(&stop), Arc::clone(&thrown));
        std::thread::spawn(move || {
            thrown.store(
                throw_rubbish(&peer, RunId(0), "x", &stop),
                Ordering::Relaxed,
            );
        })
    };
    let meanwhile = rate(&mut dispatch, &mut results, time).await;
    stop.store(true, Ordering::Relaxed);
    thrower.join().unwrap();
    let after = rate(&mut dispatch, &mut results, time).await;
    let thrown = thrown.load(Ordering::Relaxed);
    eprintln!(
        "jobs a second: {before:.0} before, {meanwhile:.0} under {thrown} frames of rubbish, \
         {after:.0} after"
    );
    let jobs = results.len() as u64;
    expect_results(&results, jobs);
    let last: Snapshot = dispatch.close().await.unwrap().last;
    assert_eq!((last.lost, last.failed, last.done as u64), (0, 0, jobs));
    assert!(thrown > 300, "{thrown}");
}

/// Checks that results forged by an admitted peer for jobs of other workers are not accepted.
#[tokio::test(flavor = "multi_thread")]
async fn forged_and_repeated_results_are_not_believed() {
    let _others = MEASURING.read().await;
    let folder = tempfile::tempdir().unwrap();
    let (mut dispatch, _honest, locator) = stage(folder.path()).await;
    let peer = Peer::join(&locator, 1).await;
    // the name of the model is no secret: it stands in every refusal
    peer.announce_until(&announcement("?"), refusal_of("model digest"));
    let digest = {
        let heard = peer.heard.lock().unwrap();
        let reason = heard.iter().find_map(|(_, message)| {
            if let ToWorker::Refused { reason } = message {
                Some(reason.clone())
            } else {
                None
            }
        });
        let reason = reason.unwrap();
        let (_, rest) = reason.split_once("this run's is ").unwrap();
        rest.split(':').next().unwrap().to_owned()
    };
    let admitted = |message: &ToWorker| matches!(message, ToWorker::Admitted { .. });
    let run = peer.announce_until(&announcement(&digest), admitted);
    for n in 0..200 {
        dispatch
            .submit(JobId(n), tests::job(n, 5), JobReason::default())
            .unwrap();
    }
    for round in 0..20_u64 {
        for n in 0..200 {
            let done = Done {
                attempt: Attempt {
                    job: JobId(n),
                    attempt: AttemptId(1 << 16),
                },
                // which job it is about cannot be known without having been given it
                work: ContentHash::of(&round.to_le_bytes()),
                cost: Cost::default(),
                outcome: Outcome::Done(Answer::Nothing(b"forged".to_vec())),
            };
            peer.say(run, Lane::Data, &FromWorker::Done(Box::new(done)));
        }
        let beat = Heartbeat {
            number: round,
            ..Heartbeat::default()
        };
        peer.say(run, Lane::Control, &FromWorker::Beat(beat));
    }
    let mut results = BTreeMap::new();
    while results.len() < 200 {
        let completed = tokio::time::timeout(LIMIT, dispatch.next()).await;
        let completed = completed.unwrap().unwrap();
        assert_eq!(results.insert(completed.id, completed.outcome), None);
    }
    expect_results(&results, 200);
    let heard = peer.heard.lock().unwrap().clone();
    assert!(
        !heard
            .iter()
            .any(|(_, message)| matches!(message, ToWorker::Run(_))),
        "a worker without the case was given a job"
    );
    let beat = FromWorker::Beat(Heartbeat {
        case: Some(ContentHash::of(b"another case")),
        ..Heartbeat::default()
    });
    wait_until("another case is refused", LIMIT, || {
        peer.say(run, Lane::Control, &beat);
        std::thread::sleep(Duration::from_millis(20));
        let heard = peer.heard.lock().unwrap();
        heard.iter().any(|(_, it)| refusal_of("case is")(it))
    });
    peer.session.close().await.unwrap();
    dispatch.close().await.unwrap();
}
