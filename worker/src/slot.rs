//! Process of one slot: reads jobs from standard input, writes outcomes to standard output.
//!
//! It ends with its worker: when its input ends, even in the middle of a job, and by the parent-death signal
//! if the worker is killed while this process does not read.
use crate::{
    handler::{self, Prepared},
    simulator::Simulators,
    stream, test_hook,
};
use protocol::{
    case::Case,
    job::{Failure, Job, Outcome},
    message::{FromSlot, ToSlot},
    wire::{self, FrameKind},
};
use rustix::{
    process::{Resource, Rlimit, Signal, getrlimit, set_parent_process_death_signal, setrlimit},
    time::{ClockId, clock_gettime},
};
use std::{
    io::{self, BufReader},
    sync::mpsc,
    thread,
    time::Duration,
};

/// Name of the slot process's thread that reads jobs.
pub(crate) const INPUT: &str = "slot-input";

/// Serves until the input ends, within the given address space (MiB; 0 for no limit): a job that needs more
/// aborts this process only.
///
/// # Errors
/// If the limit cannot be set, standard output is closed or a message cannot be read.
pub fn serve(simulators: Simulators, memory_mib: u64) -> io::Result<()> {
    set_parent_process_death_signal(Some(Signal::KILL))?;
    if memory_mib > 0 {
        // what this process starts may be given more: the limit is for what it computes itself
        let Rlimit { maximum, .. } = getrlimit(Resource::As);
        let wanted = memory_mib.saturating_mul(1 << 20);
        let current = Some(maximum.map_or(wanted, |most| most.min(wanted)));
        setrlimit(Resource::As, Rlimit { current, maximum })?;
    }
    let (to, messages) = mpsc::channel();
    thread::Builder::new()
        .name(INPUT.to_owned())
        .spawn(move || listen(&to))?;
    let mut out = io::stdout().lock();
    stream::write(&mut out, FrameKind::FromSlot, &FromSlot::Ready)?;
    let mut prepared = None;
    for message in messages {
        match message {
            ToSlot::Case(bytes) => prepared = Some(prepare(simulators, &bytes)),
            ToSlot::Run(job) => {
                let before = processor_time();
                test_hook::before(&job);
                let outcome = evaluate(prepared.as_ref(), &job);
                let taken = processor_time().saturating_sub(before);
                answer(&mut out, outcome, taken)?;
            }
        }
    }
    Ok(())
}

/// Returns the processor time of all threads of this process so far.
fn processor_time() -> Duration {
    Duration::try_from(clock_gettime(ClockId::ProcessCPUTime)).unwrap_or_default()
}

/// Sends an outcome to the worker, or a failure if the outcome is too long to be sent.
fn answer(out: &mut impl io::Write, outcome: Outcome, taken: Duration) -> io::Result<()> {
    let cpu_us = u64::try_from(taken.as_micros()).unwrap_or(u64::MAX);
    let say = |out: &mut _, outcome| {
        let outcome = Box::new(outcome);
        stream::write(
            out,
            FrameKind::FromSlot,
            &FromSlot::Done { outcome, cpu_us },
        )
    };
    match say(out, outcome) {
        // nothing has been written of it
        Err(error) if error.kind() == io::ErrorKind::InvalidData => {
            let how = format!("its result cannot be sent to the worker: {error}");
            say(out, Outcome::Failed(Failure::crashed(how)))
        }
        said => said,
    }
}

#[expect(
    clippy::exit,
    reason = "the end of the input must end a computation that goes on"
)]
fn listen(to: &mpsc::Sender<ToSlot>) {
    let mut input = BufReader::new(io::stdin().lock());
    loop {
        match stream::read(&mut input, FrameKind::ToSlot) {
            Ok(Some(message)) => drop(to.send(message)),
            Ok(None) => std::process::exit(0),
            Err(error) => {
                tracing::error!(%error, "the slot cannot read its jobs");
                std::process::exit(1);
            }
        }
    }
}

fn prepare(simulators: Simulators, bytes: &[u8]) -> Result<Prepared, Failure> {
    let case: Case =
        wire::decode(bytes).map_err(|error| Failure::misconfigured("case", error.to_string()))?;
    Prepared::new(simulators, &case)
}

fn evaluate(prepared: Option<&Result<Prepared, Failure>>, job: &Job) -> Outcome {
    match (job, prepared) {
        (Job::Nothing { .. }, _) | (_, None) => handler::no_op(job),
        (_, Some(Ok(prepared))) => prepared.evaluate(job),
        (_, Some(Err(failure))) => Outcome::Failed(failure.clone()),
    }
}
