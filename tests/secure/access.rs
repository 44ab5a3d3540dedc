//! Tests of access control for connected certificates: a raw client attempts everything that is not allowed.
use super::LIMIT;
use link::{
    Blob, CoordinatorEnd, LinkEvent,
    keys::{KeyRole, Keys},
    locator::Locator,
    zenoh::{CoordinatorOptions, ZenohCoordinator},
};
use protocol::{
    id::RunId,
    key::{self, Lane},
    name::WorkerName,
};
use std::{
    path::Path,
    sync::{Arc, Mutex},
    time::Duration,
};
use tempfile::TempDir;
use tests::{
    keys::{make, raw_session},
    process::free_quic_locator,
};
use zenoh::{Session, Wait};

const RUN: RunId = RunId(0xabc);

async fn coordinator(locator: &str, keys: &Path) -> ZenohCoordinator {
    let options = CoordinatorOptions {
        listen: vec![Locator::parse(locator).unwrap()],
        insecure: false,
        keys: Some(Keys::read(keys, KeyRole::Coordinator).unwrap()),
        run: RUN,
        blob: Blob::new(vec![7; 1000]),
    };
    ZenohCoordinator::open(options).await.unwrap()
}

/// Running coordinator, and two raw client sessions whose certificates and worker names differ.
struct Pair {
    /// Folder of the key material, kept until the test ends.
    folder: TempDir,
    end: ZenohCoordinator,
    one: Session,
    two: Session,
    mine: WorkerName,
    theirs: WorkerName,
}

async fn two_workers() -> Pair {
    let folder = tempfile::tempdir().unwrap();
    let keys = folder.path().join("keys");
    make(&keys, &[]);
    let locator = free_quic_locator();
    let end = coordinator(&locator, &keys).await;
    let session = async |name| {
        raw_session(&locator, &keys.join(name), true, 5000)
            .await
            .unwrap()
    };
    Pair {
        folder,
        end,
        one: session("worker-01").await,
        two: session("worker-02").await,
        mine: WorkerName::of("worker-01", 1).unwrap(),
        theirs: WorkerName::of("worker-02", 2).unwrap(),
    }
}

async fn put(session: &Session, key: String, payload: &str) {
    // says that all is well whether it is allowed or not
    session.put(key, payload).await.unwrap();
}

/// Publishes repeatedly until the coordinator has received a message, as messages published directly after
/// the connection may be lost.
async fn arrive(end: &mut ZenohCoordinator, session: &Session, name: &WorkerName) {
    let speak = async {
        loop {
            put(session, key::from_worker(RUN, name, Lane::Control), "here").await;
            tokio::time::sleep(Duration::from_millis(50)).await;
        }
    };
    let hear = async {
        while end.receive().await != Some(LinkEvent::Frame(name.id(), b"here".to_vec())) {}
    };
    let heard = tokio::time::timeout(LIMIT, async {
        tokio::select! {
            () = speak => {}
            () = hear => {}
        }
    });
    heard.await.unwrap();
}

/// Returns everything that the coordinator receives up to the frame `last`, except the frames that [`arrive`]
/// repeats.
async fn heard_until(end: &mut ZenohCoordinator, last: &[u8]) -> Vec<LinkEvent> {
    let mut heard = Vec::new();
    loop {
        let next = tokio::time::timeout(LIMIT, end.receive()).await;
        let next = next.unwrap().unwrap();
        let says = |words: &[u8]| matches!(&next, LinkEvent::Frame(_, frame) if frame == words);
        if says(b"here") {
            continue;
        }
        let is_last = says(last);
        heard.push(next);
        if is_last {
            return heard;
        }
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_certificate_speaks_for_nobody_else() {
    let Pair {
        folder: _folder,
        mut end,
        one,
        two,
        mine,
        theirs,
    } = two_workers().await;
    arrive(&mut end, &one, &mine).await;
    arrive(&mut end, &two, &theirs).await;
    // the presence of the other one, shown and taken away, would be heard as its loss
    let token = one
        .liveliness()
        .declare_token(key::alive(RUN, &theirs))
        .await
        .unwrap();
    token.undeclare().await.unwrap();
    for lane in [Lane::Data, Lane::Control] {
        put(&one, key::from_worker(RUN, &theirs, lane), "forged").await;
        put(
            &one,
            key::from_worker(RUN, &WorkerName::anyone(3), lane),
            "forged",
        )
        .await;
        put(&one, key::to_worker(&theirs, lane), "forged").await;
    }
    put(&one, key::from_worker(RUN, &mine, Lane::Data), "mine").await;
    let heard = heard_until(&mut end, b"mine").await;
    assert_eq!(heard, [LinkEvent::Frame(mine.id(), b"mine".to_vec())]);
    // the same words from whom they belong to are heard
    put(&two, key::from_worker(RUN, &theirs, Lane::Data), "theirs").await;
    let heard = heard_until(&mut end, b"theirs").await;
    assert_eq!(heard, [LinkEvent::Frame(theirs.id(), b"theirs".to_vec())]);
    one.close().await.unwrap();
    two.close().await.unwrap();
    end.close().await;
}

/// Subscribes a raw session to a key pattern and collects the received payloads.
fn listen(session: &Session, pattern: String) -> Arc<Mutex<Vec<Vec<u8>>>> {
    let heard: Arc<Mutex<Vec<Vec<u8>>>> = Arc::default();
    let to = Arc::clone(&heard);
    session
        .declare_subscriber(pattern)
        .callback(move |sample| to.lock().unwrap().push(sample.payload().to_bytes().into()))
        .background()
        .wait()
        .unwrap();
    heard
}

#[tokio::test(flavor = "multi_thread")]
async fn a_certificate_overhears_nobody_else() {
    let Pair {
        folder: _folder,
        mut end,
        one,
        two,
        mine,
        theirs,
    } = two_workers().await;
    let spied: Vec<_> = [
        "horsehead/**".to_owned(),
        "**".to_owned(),
        key::to_worker(&theirs, Lane::Data),
        key::all_from_workers(Lane::Data),
    ]
    .into_iter()
    .map(|pattern| listen(&one, pattern))
    .collect();
    let own = listen(&one, key::to_worker(&mine, Lane::Data));
    let jobs = listen(&two, key::to_worker(&theirs, Lane::Data));
    // both are known once they have spoken; then jobs go out until the slower one has heard
    arrive(&mut end, &one, &mine).await;
    arrive(&mut end, &two, &theirs).await;
    let begun = std::time::Instant::now();
    while jobs.lock().unwrap().is_empty() || own.lock().unwrap().is_empty() {
        assert!(begun.elapsed() < LIMIT, "the jobs do not arrive");
        end.send(theirs.id(), Lane::Data, b"job for two".to_vec());
        end.send(mine.id(), Lane::Data, b"job for one".to_vec());
        tokio::time::sleep(Duration::from_millis(20)).await;
    }
    let own = own.lock().unwrap().clone();
    assert!(own.iter().all(|job| job == b"job for one"));
    for heard in spied {
        let heard = heard.lock().unwrap().clone();
        let permitted = [b"job for one".as_slice(), b"here"];
        assert!(
            heard
                .iter()
                .all(|words| permitted.contains(&words.as_slice())),
            "worker-01 overheard {heard:?}"
        );
    }
    // and it can answer for nobody: the case comes from the coordinator alone
    let blob = Blob::new(vec![7; 1000]);
    one.declare_queryable(key::all_blobs(RUN))
        .callback(|query| drop(query.reply(query.key_expr(), "forged case").wait()))
        .background()
        .await
        .unwrap();
    let replies = two.get(key::blob(RUN, blob.hash, 0)).await.unwrap();
    let mut pieces = Vec::new();
    while let Ok(reply) = replies.recv_async().await {
        pieces.push(
            reply
                .into_result()
                .unwrap()
                .payload()
                .to_bytes()
                .into_owned(),
        );
    }
    assert_eq!(pieces, [vec![7; 1000]]);
    one.close().await.unwrap();
    two.close().await.unwrap();
    end.close().await;
}
