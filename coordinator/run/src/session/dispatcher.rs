//! Dispatcher of a run, opened with remedies for what may prevent it.
use dispatch::runtime::{Dispatch, DispatchError, DispatchOptions};
use journal::JournalError;
use link::LinkError;
use std::sync::Arc;
use study::{ColumnDivision, EvaluatorError};
use support::Problem;

/// Opens or resumes the journal of a run and starts the local workers; simulations with derivatives are divided for
/// slots that would be idle.
///
/// # Errors
/// If the local workers cannot run the case, or the dispatcher cannot be opened.
pub(crate) async fn open(mut options: DispatchOptions) -> anyhow::Result<Dispatch> {
    options.divide = Arc::new(ColumnDivision::of(&options.case));
    let kind = case::kind::of(&options.case);
    let unready = (options.local_workers > 0).then(|| kind.readiness_problem(&options.case));
    if let Some((message, remedy)) = unready.flatten() {
        return Err(Problem { message, remedy }.into());
    }
    Dispatch::open(options).await.map_err(refuse)
}

/// Converts an error of opening a run to one with a remedy, mostly a corrected command line argument.
fn refuse(error: DispatchError) -> anyhow::Error {
    let help = match &error {
        DispatchError::NoWorkers => {
            "for example --workers 2, or --listen quic/0.0.0.0:7447 --tls DIR"
        }
        DispatchError::Listen { .. } => {
            "choose another address or port, as --listen quic/0.0.0.0:7448; port 0 takes any free one"
        }
        DispatchError::Link(LinkError::Transport { .. }) => "choose another address with --listen",
        DispatchError::Link(LinkError::NoKeys { .. } | LinkError::Keys(_)) => {
            "`horsehead keys new DIR --host NAME` makes certificates; --tls DIR uses them"
        }
        DispatchError::Link(_) => {
            "for example --listen quic/0.0.0.0:7447 --tls DIR, or --listen unix/PATH"
        }
        DispatchError::Socket(_) => "set TMPDIR to a folder that can be written",
        DispatchError::Journal(JournalError::Io { .. }) => {
            "choose a folder that can be written, with --run DIR"
        }
        DispatchError::Journal(_) => "another folder is chosen with --run DIR",
        DispatchError::Locate(_)
        | DispatchError::Case(_)
        | DispatchError::Start(_)
        | DispatchError::LocalWorkers { .. }
        | DispatchError::JobDiffers { .. }
        | DispatchError::Paused { .. }
        | DispatchError::Stopped(_)
        | DispatchError::Closed => return EvaluatorError::from(error).into(),
    };
    Problem {
        message: error.to_string(),
        remedy: help.to_owned(),
    }
    .into()
}

/// Runs a future to completion on a runtime of its own.
///
/// # Errors
/// If the runtime cannot be started; otherwise the error of the future.
pub fn block_on<T>(future: impl Future<Output = anyhow::Result<T>>) -> anyhow::Result<T> {
    tokio::runtime::Builder::new_multi_thread()
        .enable_all()
        .build()?
        .block_on(future)
}
