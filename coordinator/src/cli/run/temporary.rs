//! Jobs of a single command on local workers, in a temporary run folder.
use super::{
    bus::{self, Bus},
    interrupt,
};
use crate::cli::argument::listening::RemoteAccess;
use anyhow::Context as _;
use dispatch::runtime::PAUSE_LIMIT;
use protocol::case::Case;
use study::{self, CompareRequest, Compared, Stop, StudyError};

/// Executes `work` with a dispatcher in a temporary run folder and with `local_workers` workers on this
/// machine.
///
/// # Errors
/// If workers cannot be started, or the work fails.
pub(crate) fn with_temporary_run<T>(
    case: &Case,
    kind: &str,
    local_workers: usize,
    work: impl AsyncFnOnce(&mut Bus, &mut Stop) -> Result<T, StudyError>,
) -> anyhow::Result<T> {
    let scratch = tempfile::tempdir().context("cannot make a scratch folder")?;
    // what decides the result is not written down where nothing is resumed
    let settings = serde_json::to_string(&(kind, scratch.path()))?;
    bus::block_on(async {
        let mut stop = interrupt::listen();
        let options = bus::Options {
            run_dir: scratch.path().to_owned(),
            network: RemoteAccess::default(),
            local_workers,
            pause_limit: PAUSE_LIMIT,
            kind: kind.to_owned(),
            settings,
        };
        let mut bus = Bus::open(options, case).await?;
        let result = work(&mut bus, &mut stop).await;
        bus.close().await?;
        Ok(result?)
    })
}

/// Evaluates and simulates each of the given sets of parameter values on local workers in a temporary run
/// folder.
///
/// # Errors
/// As [`with_temporary_run`] and [`study::compare()`].
pub(crate) fn compare_once(
    kind: &str,
    case: &Case,
    wanted: &[CompareRequest],
    workers: usize,
) -> anyhow::Result<Vec<Compared>> {
    with_temporary_run(case, kind, workers, async |bus, stop| {
        study::compare(bus, case, wanted, stop).await
    })
}
