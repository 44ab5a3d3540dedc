//! Handling of Ctrl-C: the first stops the run cleanly, the second exits at once.
use crate::cli::output::{problem::INTERRUPTED, terminal};
use study::Stop;
use tokio::sync::watch;

/// Starts listening for Ctrl-C and SIGTERM; requires a running asynchronous runtime. The returned value
/// becomes true with the first signal; the second ends the process.
pub(crate) fn listen() -> Stop {
    let (sender, stop) = watch::channel(false);
    tokio::spawn(async move {
        signal().await;
        terminal::tell("stopping cleanly; press Ctrl-C again to stop at once");
        // whoever listened may be busy ending the run, which may have to wait for a full disk
        sender.send_replace(true);
        signal().await;
        leave();
    });
    stop
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
