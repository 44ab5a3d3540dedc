//! Checks of what a journal's records hold: their layout changes only together with the version, and every result that
//! a worker can deliver fits.
//!
//! bincode is not self-describing: after an added field or a changed order a journal would be read as nonsense.
//! `form.txt` holds the layout of every record of the present version, as derived from the types.
use journal::{
    VERSION,
    event::{Event, Finished},
};
use proptest::{collection::vec, prelude::*};
use protocol::{
    announce::{Place, Role, Sign},
    id::{AttemptId, ContentHash, JobId, RunId, WorkerId},
    job::{Answer, Derivative, Failure, Outcome, Per, Reached, Verdict},
    message::{Attempt, Cost, Done, FromWorker},
    proof::ReferenceResult,
    wire::{self, FrameKind},
};
use serde_reflection::{Samples, Tracer, TracerConfig};
use std::{fs, path::Path};

/// Returns the expected content of `form.txt`: one line for each type that is part of a record.
fn form() -> String {
    let mut tracer = Tracer::new(TracerConfig::default());
    let samples = Samples::new();
    /// Traces each listed type; every enum must be listed, since only the first variant of an enum inside another type
    /// is traced.
    macro_rules! trace {
        ($($type:ty)*) => {
            $(tracer.trace_type::<$type>(&samples).expect("a form");)*
        };
    }
    trace!(Event Answer Outcome Failure Verdict Reached ReferenceResult);
    trace!(Derivative Per Place Role Sign);
    let registry = tracer.registry().expect("every variant was seen");
    let lines = registry.into_iter();
    let lines = lines.map(|(name, form)| format!("{name}: {form:?}\n"));
    let text: String = lines.collect();
    format!("journal version {VERSION}\n{text}")
}

#[test]
fn no_record_changes_without_the_version() {
    let (is, was) = (form(), include_str!("form.txt"));
    if is == was {
        return;
    }
    let kept = Path::new(env!("CARGO_TARGET_TMPDIR")).join("form.txt");
    fs::write(&kept, &is).unwrap();
    let same_version = is.lines().next() == was.lines().next();
    let remedy = if same_version {
        "the form of a record has changed: raise journal::VERSION, then take over"
    } else {
        "a new version: take over"
    };
    panic!("{remedy} {}", kept.display());
}

/// Regression test: a result that the worker could send but the journal could not hold was never stored nor
/// acknowledged, and the run did not end.
#[test]
fn what_a_worker_can_send_can_be_stored() {
    let attempt = Attempt {
        job: JobId(u64::MAX),
        attempt: AttemptId(u32::MAX),
    };
    let work = ContentHash([255; 32]);
    let cost = Cost {
        wall_us: u64::MAX,
        cpu_us: u64::MAX,
    };
    let outcome = |bytes: usize| Outcome::Done(Answer::Nothing(vec![0; bytes]));
    let sent = |bytes| {
        let done = FromWorker::Done(Box::new(Done {
            attempt,
            work,
            cost,
            outcome: outcome(bytes),
        }));
        wire::encode_frame(FrameKind::FromWorker, RunId(1), &done)
    };
    let longest = FrameKind::FromWorker.limit() - (sent(0).unwrap().len() - wire::HEADER_BYTES);
    assert!(sent(longest).is_ok() && sent(longest + 1).is_err());
    let event = Event::Finished(Box::new(Finished {
        attempt,
        work,
        worker: Some(WorkerId(u64::MAX)),
        cost,
        outcome: outcome(longest),
    }));
    journal::record(&event).unwrap();
}

proptest! {
    #[test]
    fn arbitrary_bytes_are_no_event_or_are_written_in_one_way_only(noise in vec(any::<u8>(), 0..400)) {
        if let Ok(event) = wire::decode::<Event>(&noise) {
            prop_assert_eq!(wire::encode(&event).unwrap(), noise);
        }
    }
}
