//! Server of a run's control socket.
use super::{
    messages::{ControlReply, ControlRequest},
    path::{SOCKET, short_path},
};
use std::{
    fs::{self, Permissions},
    io,
    os::unix::fs::PermissionsExt,
    path::{Path, PathBuf},
    time::Duration,
};
use tokio::{
    io::{AsyncBufReadExt, AsyncReadExt, AsyncWriteExt, BufReader},
    net::{UnixListener, UnixStream},
    sync::{Semaphore, oneshot},
    task::JoinHandle,
    time::timeout,
};

/// Maximum length of a control request (bytes).
const LONGEST: u64 = 64 << 10;
/// Time limit for a client to send its request and read the answer.
const PATIENCE: Duration = Duration::from_secs(5);
/// Maximum number of simultaneous clients of the control socket.
const MAX_CLIENTS: usize = 16;

/// Control request with the channel for its reply.
pub(in crate::runtime) type PendingRequest = (ControlRequest, oneshot::Sender<ControlReply>);

/// Open control socket, removed on drop.
#[derive(Debug)]
pub(in crate::runtime) struct Control {
    path: PathBuf,
    task: JoinHandle<()>,
}

impl Control {
    /// Opens the control socket in a run folder that this process has locked, replacing one left over from an
    /// earlier process. `ask` passes a request on; it returns `false` once the run has ended.
    pub(in crate::runtime) fn open(
        folder: &Path,
        ask: impl Fn(PendingRequest) -> bool + Clone + Send + Sync + 'static,
    ) -> io::Result<Self> {
        let path = folder.join(SOCKET);
        match fs::remove_file(&path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
            Ok(()) | Err(_) => {}
        }
        let (_open, short) = short_path(folder)?;
        let listener = UnixListener::bind(short)?;
        fs::set_permissions(&path, Permissions::from_mode(0o600))?;
        let task = tokio::spawn(serve(listener, ask));
        Ok(Self { path, task })
    }
}

impl Drop for Control {
    fn drop(&mut self) {
        self.task.abort();
        // what is left of it does no harm: the next process removes it
        drop(fs::remove_file(&self.path));
    }
}

#[expect(clippy::infinite_loop, reason = "it ends when its task is aborted")]
async fn serve(
    listener: UnixListener,
    ask: impl Fn(PendingRequest) -> bool + Clone + Send + Sync + 'static,
) {
    let places = std::sync::Arc::new(Semaphore::new(MAX_CLIENTS));
    let own = rustix::process::geteuid().as_raw();
    loop {
        let Ok((stream, _)) = listener.accept().await else {
            // out of files, most likely: others may end
            tokio::time::sleep(Duration::from_millis(100)).await;
            continue;
        };
        let theirs = stream.peer_cred().map(|of| of.uid());
        let Ok(place) = std::sync::Arc::clone(&places).try_acquire_owned() else {
            continue;
        };
        // who came before the permissions were set is turned away here
        if !theirs.is_ok_and(|uid| uid == own || uid == 0) {
            continue;
        }
        let ask = ask.clone();
        drop(tokio::spawn(async move {
            let answered = timeout(PATIENCE, answer(stream, ask)).await;
            tracing::debug!(?answered, "a control request was answered");
            drop(place);
        }));
    }
}

async fn answer(stream: UnixStream, ask: impl Fn(PendingRequest) -> bool) -> io::Result<()> {
    let mut stream = BufReader::new(stream);
    let mut line = String::new();
    (&mut stream).take(LONGEST).read_line(&mut line).await?;
    let reply = match serde_json::from_str(&line) {
        Ok(question) => {
            let (to, reply) = oneshot::channel();
            let over = || ControlReply::Error("the run has just ended".to_owned());
            if ask((question, to)) {
                reply.await.unwrap_or_else(|_| over())
            } else {
                over()
            }
        }
        Err(error) => ControlReply::Error(format!("the request is not valid: {error}")),
    };
    let mut line = serde_json::to_vec(&reply)?;
    line.push(b'\n');
    stream.write_all(&line).await
}
