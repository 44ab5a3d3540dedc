//! Interruption of a study by the user.
use super::error::StudyError;
use tokio::sync::watch;

/// Cancellation signal: becomes true when the user wants to stop.
pub type Stop = watch::Receiver<bool>;

/// Awaits a future unless the user stops the study first.
///
/// # Errors
/// [`StudyError::Interrupted`] if the user stops.
pub async fn or_stop<T>(future: impl Future<Output = T>, stop: &mut Stop) -> Result<T, StudyError> {
    let stopped = async {
        // a sender that is gone can no longer stop anything
        if stop.wait_for(|stopped| *stopped).await.is_err() {
            std::future::pending::<()>().await;
        }
    };
    tokio::select! {
        biased;
        () = stopped => Err(StudyError::Interrupted),
        result = future => Ok(result),
    }
}
