//! Key expressions under which messages are published on Zenoh.
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
//! `RUN` is 16 hexadecimal digits, all zeros until the coordinator has told the worker the run. `WORKER` has
//! two parts: the name of the worker's certificate and the 16 digits of its process ([`WorkerName`]). Access
//! control grants a worker only keys that contain the name of its certificate.
//!
//! Workers subscribe to keys without wildcards and without the run; they do not know the run at first, and
//! every frame states it. The router caches the route of a key that has an exact subscription; for any other
//! key it searches the wildcard expressions of all workers at every message.
use crate::{
    id::{ContentHash, RunId},
    name::WorkerName,
};

/// Prefix of every key. The number is the version of the key layout and not the wire version: peers with
/// different wire versions must receive each other's messages to report the mismatch.
pub const ROOT: &str = "horsehead/1";

/// Channel of a message between coordinator and worker: bulk data must not delay control messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Lane {
    /// Channel for bulk data: jobs to a worker, results from a worker.
    Data,
    /// Channel for short control messages that must not wait behind bulk data: admission, acknowledgements,
    /// heartbeats.
    Control,
}

/// Returns the key on which the coordinator publishes to a worker and to which the worker subscribes.
pub fn to_worker(worker: &WorkerName, lane: Lane) -> String {
    let lane = match lane {
        Lane::Data => "job",
        Lane::Control => "ack",
    };
    format!("{ROOT}/w/{worker}/{lane}")
}

/// Returns the key on which a worker publishes to the coordinator.
pub fn from_worker(run: RunId, worker: &WorkerName, lane: Lane) -> String {
    let lane = match lane {
        Lane::Data => "res",
        Lane::Control => "hb",
    };
    format!("{ROOT}/{run}/{lane}/{worker}")
}

/// Returns the key expression that matches the keys of one channel ([`Lane`]) of all workers, in any run,
/// since new workers do not know the run.
pub fn all_from_workers(lane: Lane) -> String {
    match lane {
        Lane::Data => format!("{ROOT}/*/res/*/*"),
        Lane::Control => format!("{ROOT}/*/hb/*/*"),
    }
}

/// Returns the key under which a worker declares its presence (liveliness token) in a run.
pub fn alive(run: RunId, worker: &WorkerName) -> String {
    format!("{ROOT}/{run}/alive/{worker}")
}

/// Returns the key expression that matches the presence keys of all workers of a run.
pub fn all_alive(run: RunId) -> String {
    format!("{ROOT}/{run}/alive/*/*")
}

/// Returns the key at which a worker requests one chunk of a blob (content addressed by its hash).
pub fn blob(run: RunId, hash: ContentHash, chunk: u32) -> String {
    format!("{ROOT}/{run}/blob/{hash}/{chunk}")
}

/// Returns the key expression that matches every chunk of every blob of a run.
pub fn all_blobs(run: RunId) -> String {
    format!("{ROOT}/{run}/blob/*/*")
}

/// Parses the worker's name at the end of a key; `None` if the key does not end with one.
pub fn worker_of(key: &str) -> Option<WorkerName> {
    let (rest, process) = key.rsplit_once('/')?;
    let (_, owner) = rest.rsplit_once('/')?;
    WorkerName::parse(owner, process)
}

/// Permissions of all workers with the same certificate, as key expressions; everything else is denied.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Grant {
    /// Key expression of the keys to which the workers may subscribe.
    pub subscribe: String,
    /// Key expressions of the keys on which the workers may publish: results and heartbeats.
    pub publish: [String; 2],
    /// Key expression of the keys on which the workers may declare their presence.
    pub liveliness: String,
}

impl Grant {
    /// Returns the permissions of all workers whose certificate has the name `owner`.
    pub fn of(owner: &str) -> Self {
        Self {
            subscribe: format!("{ROOT}/w/{owner}/*/*"),
            publish: [
                format!("{ROOT}/*/res/{owner}/*"),
                format!("{ROOT}/*/hb/{owner}/*"),
            ],
            liveliness: format!("{ROOT}/*/alive/{owner}/*"),
        }
    }

    /// Returns the key expression that every worker may query: blobs of any run.
    pub fn blob_queries() -> String {
        format!("{ROOT}/*/blob/*/*")
    }
}

/// Parses the content hash and the chunk number at the end of a blob's key; `None` for any other key.
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
