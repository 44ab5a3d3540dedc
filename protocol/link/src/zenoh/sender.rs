//! Thread that sends the frames of a coordinator or worker; only this thread is blocked by a full pipe, which
//! may take seconds.
use protocol::key::Lane;
use std::{sync::mpsc, thread, time::Duration};
use tokio::sync::oneshot;
use zenoh::{
    Session, Wait,
    qos::{CongestionControl, Priority},
};

/// Maximum time for sending the queued frames when the link closes.
const FLUSH: Duration = Duration::from_secs(1);

#[derive(Debug)]
pub(super) struct Sender {
    queue: mpsc::Sender<(String, Lane, Vec<u8>)>,
    ended: oneshot::Receiver<()>,
}

impl Sender {
    pub(super) fn start(session: Session) -> std::io::Result<Self> {
        let (queue, frames) = mpsc::channel::<(String, Lane, Vec<u8>)>();
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

    pub(super) fn send(&self, key: String, lane: Lane, frame: Vec<u8>) {
        if self.queue.send((key, lane, frame)).is_err() {
            tracing::debug!("a frame was not sent: the link is closed");
        }
    }

    /// Waits until all frames are sent, or until the time limit [`FLUSH`] has passed.
    pub(super) async fn finish(self) {
        drop(self.queue);
        if tokio::time::timeout(FLUSH, self.ended).await.is_err() {
            tracing::debug!("frames were still queued when the link closed");
        }
    }
}
