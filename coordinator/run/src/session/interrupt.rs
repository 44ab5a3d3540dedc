//! Handling of Ctrl-C: the first stops the run cleanly, the second exits at once.
use crate::message;
use std::{sync::OnceLock, thread};
use study::Stop;
use tokio::sync::watch;

/// Exit code after Ctrl-C.
pub const INTERRUPTED: u8 = 130;

/// Returns a value that becomes true with the first Ctrl-C or SIGTERM that this process receives after the first
/// call; the second signal ends the process, whatever it does by then.
pub fn listen() -> Stop {
    static STOP: OnceLock<Stop> = OnceLock::new();
    let start = || {
        let (sender, stop) = watch::channel(false);
        // a thread and a runtime of its own: signals are heard until the process ends
        thread::spawn(move || {
            let mut runtime = tokio::runtime::Builder::new_current_thread();
            match runtime.enable_all().build() {
                Ok(runtime) => runtime.block_on(hear(sender)),
                Err(error) => tracing::warn!("interrupts end this program at once: {error}"),
            }
        });
        stop
    };
    STOP.get_or_init(start).clone()
}

async fn hear(sender: watch::Sender<bool>) {
    signal().await;
    message::print("stopping cleanly; press Ctrl-C again to stop at once");
    // whoever listened may be busy ending the run, which may have to wait for a full disk
    sender.send_replace(true);
    signal().await;
    leave();
}

#[expect(
    clippy::exit,
    reason = "the user asked twice: nothing is worth waiting for"
)]
fn leave() {
    std::process::exit(i32::from(INTERRUPTED));
}

#[cfg(unix)]
async fn signal() {
    use tokio::signal::unix::{SignalKind, signal};
    let Ok(mut terminate) = signal(SignalKind::terminate()) else {
        let _unheard = tokio::signal::ctrl_c().await;
        return;
    };
    tokio::select! {
        _heard = tokio::signal::ctrl_c() => {}
        _heard = terminate.recv() => {}
    }
}

#[cfg(not(unix))]
async fn signal() {
    let _unheard = tokio::signal::ctrl_c().await;
}
