//! Jobs of a single command on local workers, in a temporary run folder.
use super::{dispatcher, interrupt};
use anyhow::Context as _;
use dispatch::runtime::{Dispatch, DispatchOptions};
use protocol::case::Case;
use study::{self, CompareRequest, Compared, EvaluatorError, Stop, StudyError};

/// Executes `work` with a dispatcher in a temporary run folder and with `local_workers` workers on this
/// machine.
///
/// # Errors
/// If workers cannot be started, or the work fails.
pub fn with_temporary_run<T>(
    case: &Case,
    kind: &str,
    local_workers: usize,
    work: impl AsyncFnOnce(&mut Dispatch, &mut Stop) -> Result<T, StudyError>,
) -> anyhow::Result<T> {
    let scratch = tempfile::tempdir().context("cannot make a scratch folder")?;
    // what decides the result is not written down where nothing is resumed
    let settings = serde_json::to_string(&(kind, scratch.path()))?;
    dispatcher::block_on(async {
        let mut stop = interrupt::listen();
        let options = DispatchOptions::local(scratch.path(), local_workers, case, kind, settings)?;
        let mut dispatch = dispatcher::open(options).await?;
        let result = work(&mut dispatch, &mut stop).await;
        dispatch.close().await.map_err(EvaluatorError::from)?;
        Ok(result?)
    })
}

/// Evaluates and simulates each of the given sets of parameter values on local workers in a temporary run
/// folder.
///
/// # Errors
/// As [`with_temporary_run`] and [`study::compare()`].
pub fn compare_once(
    kind: &str,
    case: &Case,
    wanted: &[CompareRequest],
    workers: usize,
) -> anyhow::Result<Vec<Compared>> {
    with_temporary_run(case, kind, workers, async |dispatch, stop| {
        study::compare(dispatch, case, wanted, stop).await
    })
}
