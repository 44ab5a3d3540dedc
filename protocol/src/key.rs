//! The names under which messages travel, and nothing else.
//!
//! ```text
//! horsehead/1/w/WORKER/job         coordinator -> worker: jobs, cancellations
//! horsehead/1/w/WORKER/ack         coordinator -> worker: admission, stored results, the end
//! horsehead/1/RUN/res/WORKER       worker -> coordinator: results
//! horsehead/1/RUN/hb/WORKER        worker -> coordinator: announcements, heartbeats
//! horsehead/1/RUN/alive/WORKER     presence
//! horsehead/1/RUN/blob/HASH/CHUNK  worker asks coordinator: content, piece by piece
//! ```
//!
//! `RUN` is 16 hexadecimal digits, all zeros until a coordinator has told the worker. `WORKER` is
//! two parts: the name of its certificate and the 16 digits of its process ([`WorkerName`]).
//! Access control grants a worker only keys with the name of its certificate in them.
//!
//! Workers listen to keys without patterns, and without the run, which they do not know at first and
//! which every frame says: the router remembers the way of a key that somebody listens to as it is,
//! and looks through the patterns of all workers for any other, at every message.
use crate::{
    id::{ContentHash, RunId},
    name::WorkerName,
};

/// What every key begins with. The number is that of this layout and not the wire version: ends of
/// different wire versions must hear each other to say so.
pub const ROOT: &str = "horsehead/1";

/// Which of a coordinator's lanes a message takes: a long job must not hold up an end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Lane {
    /// Jobs and results.
    Data,
    /// Everything that is short and must not wait.
    Control,
}

/// Where the coordinator puts a message for a worker, and the worker listens.
pub fn to_worker(worker: &WorkerName, lane: Lane) -> String {
    let lane = match lane {
        Lane::Data => "job",
        Lane::Control => "ack",
    };
    format!("{ROOT}/w/{worker}/{lane}")
}

/// Where a worker puts a message for the coordinator.
pub fn from_worker(run: RunId, worker: &WorkerName, lane: Lane) -> String {
    let lane = match lane {
        Lane::Data => "res",
        Lane::Control => "hb",
    };
    format!("{ROOT}/{run}/{lane}/{worker}")
}

/// Everything from any worker in one lane, of any run: newcomers do not know the run.
pub fn all_from_workers(lane: Lane) -> String {
    match lane {
        Lane::Data => format!("{ROOT}/*/res/*/*"),
        Lane::Control => format!("{ROOT}/*/hb/*/*"),
    }
}

/// Presence of a worker in a run.
pub fn alive(run: RunId, worker: &WorkerName) -> String {
    format!("{ROOT}/{run}/alive/{worker}")
}

/// Presence of any worker in a run.
pub fn all_alive(run: RunId) -> String {
    format!("{ROOT}/{run}/alive/*/*")
}

/// One piece of some content.
pub fn blob(run: RunId, hash: ContentHash, chunk: u32) -> String {
    format!("{ROOT}/{run}/blob/{hash}/{chunk}")
}

/// Any piece of any content of a run.
pub fn all_blobs(run: RunId) -> String {
    format!("{ROOT}/{run}/blob/*/*")
}

/// The worker that a key ends with, if it does.
pub fn worker_of(key: &str) -> Option<WorkerName> {
    let (rest, process) = key.rsplit_once('/')?;
    let (_, owner) = rest.rsplit_once('/')?;
    WorkerName::parse(owner, process)
}

/// What the workers of one certificate may do, as patterns of keys; nothing else.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Grant {
    /// Where they may listen, and receive.
    pub hear: String,
    /// Where they may speak.
    pub speak: [String; 2],
    /// Where they may show presence.
    pub appear: String,
}

impl Grant {
    /// What `owner`'s workers may do.
    pub fn of(owner: &str) -> Self {
        Self {
            hear: format!("{ROOT}/w/{owner}/*/*"),
            speak: [
                format!("{ROOT}/*/res/{owner}/*"),
                format!("{ROOT}/*/hb/{owner}/*"),
            ],
            appear: format!("{ROOT}/*/alive/{owner}/*"),
        }
    }

    /// What every worker may fetch.
    pub fn fetch() -> String {
        format!("{ROOT}/*/blob/*/*")
    }
}

/// The content and piece that a key asks for, if it does.
pub fn blob_of(key: &str) -> Option<(ContentHash, u32)> {
    let (rest, chunk) = key.rsplit_once('/')?;
    let (_, hash) = rest.rsplit_once('/')?;
    let digits: Vec<u8> = hash
        .chars()
        .map(|digit| {
            digit
                .to_digit(16)
                .and_then(|value| u8::try_from(value).ok())
        })
        .collect::<Option<_>>()?;
    (digits.len() == 64).then_some(())?;
    let mut bytes = [0; 32];
    for (byte, pair) in bytes.iter_mut().zip(digits.chunks_exact(2)) {
        *byte = pair[0] << 4 | pair[1];
    }
    Some((ContentHash(bytes), chunk.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_key_names_can_be_read_back() {
        let run = RunId(0x1f);
        let worker = WorkerName::of("worker-01", 0xfeed_0000_1234_5678).unwrap();
        let hash = ContentHash::of(b"case");
        for lane in [Lane::Data, Lane::Control] {
            let key = from_worker(run, &worker, lane);
            assert_eq!(worker_of(&key), Some(worker.clone()));
        }
        assert_eq!(worker_of(&alive(run, &worker)), Some(worker));
        assert_eq!(blob_of(&blob(run, hash, 7)), Some((hash, 7)));
    }

    #[test]
    fn foreign_keys_name_nothing() {
        for key in [
            "",
            "horsehead/1/x/res/worker-01/12",
            "horsehead/1/0/hb/worker-01/zzzzzzzzzzzzzzzz",
            "horsehead/1/0/hb/Nobody!/0000000000000001",
        ] {
            assert_eq!(worker_of(key), None, "{key}");
            assert_eq!(blob_of(key), None, "{key}");
        }
        assert_eq!(blob_of("horsehead/1/0/blob/abcd/0"), None);
    }
}
