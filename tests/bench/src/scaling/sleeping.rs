//! Searches on sessions that sleep for as long as simulations take, on more slots than there are processors.
use super::{
    project::{Overheads, SyntheticObjective},
    row::{SlotRow, empty_run},
};
use crate::dispatch::sessions::open_with_connections;
use anyhow::ensure;
use dispatch::{
    bench::processor_time,
    simulated::{JobSource as _, SimulatedDerivatives, SimulatedSearch},
};
use journal::event::JobReason;
use protocol::{id::JobId, job::Job};
use search::{space::Space, strategy::Strategy};
use std::{
    cell::RefCell,
    collections::BTreeMap,
    rc::Rc,
    time::{Duration, Instant},
};
use study::{least_parts, scaling::Shares};
use tokio::time::sleep;

/// Time limit for sessions to join.
const JOINING: Duration = Duration::from_mins(3);

/// Runs a search of at most a number of evaluations on one-slot sessions over a Unix socket; each job sleeps `sleep_s` in
/// the mean, distributed as the simulations of `overheads`.
///
/// # Errors
/// If sessions cannot be started, or not all of them join.
pub(super) async fn sleep_through(
    (name, strategy, limit): (&str, Box<dyn Strategy>, u64),
    (count, sleep_s): (u64, f64),
    space: &Space,
    overheads: &Overheads,
) -> anyhow::Result<SlotRow> {
    let factors = Rc::new(RefCell::new(BTreeMap::new()));
    let takes = |id: u64| {
        let uneven = overheads.sample_duration_s(id) / overheads.simulation_s;
        let factor = factors.borrow().get(&id).copied().unwrap_or(1.0);
        Duration::try_from_secs_f64(sleep_s * uneven * factor).unwrap_or_default()
    };
    let stand = SyntheticObjective(space);
    let tell = |genes: &[f64]| stand.evaluate(genes);
    let residual = |genes: &[f64]| stand.residual(genes);
    let mut source = SimulatedSearch::new(strategy, &tell);
    source.derivatives = Some(SimulatedDerivatives {
        residual: &residual,
        columns: space.dimension(),
        cost: overheads.derivatives_over_plain,
        least_parts,
        factors: Rc::clone(&factors),
    });
    source.limit = limit;
    let slots = usize::try_from(count)?;
    let scratch = tempfile::tempdir()?;
    let opened = open_with_connections(empty_run(scratch.path())?, slots).await?;
    let (mut dispatch, sessions, _folder) = opened;
    let opened = Instant::now();
    while dispatch.snapshot().workers.len() < slots && opened.elapsed() < JOINING {
        sleep(Duration::from_millis(5)).await;
    }
    let joined = dispatch.snapshot().workers.len();
    ensure!(
        joined == slots,
        "only {joined} of {slots} sessions joined: ask for fewer, or raise the limit that `ulimit -n` shows"
    );
    let (begun, processor, before) = (Instant::now(), processor_time(), dispatch.snapshot());
    let mut open = 0_usize;
    let sleeping = |(number, job): (u64, Job)| {
        let delay = takes(number).as_millis();
        delayed(job, u32::try_from(delay).unwrap_or(u32::MAX))
    };
    while !source.is_done() {
        for (id, job) in source.ask(slots.saturating_sub(open)) {
            open += 1;
            dispatch.submit(JobId(id), sleeping((id, job)), JobReason::default())?;
        }
        let anticipated = source.anticipate(slots.saturating_sub(open));
        dispatch.anticipate(anticipated.into_iter().map(sleeping).collect())?;
        let done = dispatch.next().await?;
        open -= 1;
        source.tell(done.id.0, &done.outcome);
    }
    let (wall, after) = (begun.elapsed(), dispatch.snapshot().spent);
    let processor = processor_time().saturating_sub(processor);
    dispatch.close().await?;
    drop(sessions);
    Ok(SlotRow {
        how: "slept",
        preset: name.to_owned(),
        slots: count,
        evaluations: source.strategy.archive().entries().len() as u64,
        wall_s: wall.as_secs_f64(),
        shares: Shares::between(&before.spent, &after),
        coordinator_share: processor.as_secs_f64() / wall.as_secs_f64(),
    })
}

fn delayed(job: Job, delay: u32) -> Job {
    match job {
        Job::Nothing {
            payload,
            reply_bytes,
            delay_ms: _,
        } => Job::Nothing {
            payload,
            reply_bytes,
            delay_ms: delay,
        },
        other @ (Job::Simulate(_) | Job::Own { .. } | Job::Describe) => other,
    }
}
