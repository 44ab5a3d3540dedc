//! Threads that send the frames of a coordinator or worker, one for each peer: a full pipe to a peer that does not read
//! may block its thread for seconds, and no other.
use protocol::key::Lane;
use std::{collections::BTreeMap, io, sync::mpsc, thread, time::Duration};
use tokio::{sync::oneshot, time::timeout};
use zenoh::{
    Session, Wait,
    qos::{CongestionControl, Priority},
};

/// Maximum time for sending the queued frames when the link closes.
const FLUSH: Duration = Duration::from_secs(1);

type Frame = (String, Lane, Vec<u8>);

/// Sender of the frames to the peers of an end of the link.
#[derive(Debug)]
pub(super) struct Sender {
    session: Session,
    /// Threads by the numbers of the peers' ids.
    peers: BTreeMap<u64, PeerThread>,
}

#[derive(Debug)]
struct PeerThread {
    queue: mpsc::Sender<Frame>,
    ended: oneshot::Receiver<()>,
}

impl Sender {
    pub(super) const fn new(session: Session) -> Self {
        Self {
            session,
            peers: BTreeMap::new(),
        }
    }

    /// Queues a frame for the peer with the number `to`, which keeps the order of its frames. For a new peer a thread is started, and those
    /// of peers that are no longer `present` end when their frames are sent.
    pub(super) fn send(
        &mut self,
        to: u64,
        (key, lane, frame): Frame,
        present: impl Fn(u64) -> bool,
    ) {
        if !self.peers.contains_key(&to) {
            self.peers.retain(|peer, _| present(*peer));
            match PeerThread::start(self.session.clone()) {
                Ok(started) => drop(self.peers.insert(to, started)),
                Err(error) => {
                    tracing::warn!(to, %error, "a frame was not sent: no thread can be started");
                }
            }
        }
        let peer = self.peers.get(&to);
        if peer.is_some_and(|peer| peer.queue.send((key, lane, frame)).is_err()) {
            tracing::debug!(to, "a frame was not sent: the link is closed");
        }
    }

    /// Waits until all frames are sent, or until the time limit [`FLUSH`] has passed.
    pub(super) async fn finish(self) {
        let (queues, threads): (Vec<_>, Vec<_>) = self
            .peers
            .into_values()
            .map(|peer| (peer.queue, peer.ended))
            .unzip();
        drop(queues);
        let all = async {
            for ended in threads {
                // a thread that ends drops its end of the channel
                ended.await.unwrap_or_default();
            }
        };
        if timeout(FLUSH, all).await.is_err() {
            tracing::debug!("frames were still queued when the link closed");
        }
    }
}

impl PeerThread {
    fn start(session: Session) -> io::Result<Self> {
        let (queue, frames) = mpsc::channel::<Frame>();
        let (end, ended) = oneshot::channel();
        thread::Builder::new()
            .name("link-sender".to_owned())
            .spawn(move || {
                for (key, lane, frame) in frames {
                    let priority = match lane {
                        Lane::Data => Priority::Data,
                        Lane::Control => Priority::InteractiveHigh,
                    };
                    let put = session
                        .put(&key, frame)
                        .congestion_control(CongestionControl::Block)
                        .priority(priority)
                        .express(true);
                    if let Err(error) = put.wait() {
                        tracing::debug!(key, %error, "a frame was not sent");
                    }
                }
                // tells whoever waits in `finish`
                drop(end);
            })?;
        Ok(Self { queue, ended })
    }
}
