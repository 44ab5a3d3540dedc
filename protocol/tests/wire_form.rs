//! Checks that the layout of all transmitted types changes only together with the wire version.
//!
//! bincode is not self-describing: after an added field or a changed order the peer decodes nonsense or,
//! worse, plausible values. `wire_form.txt` holds the layout of every message of the present version, as
//! derived from the types.
use protocol::{
    announce::{Place, Role, Sign},
    case::{Case, ChannelLimit, Offset, Reproducibility, Scale},
    id::{AttemptId, ContentHash, JobId, RunId},
    job::{Answer, Derivative, Failure, Job, Outcome, Per, Reached, Reply, Verdict},
    message::{Attempt, FromSlot, FromWorker, Heartbeat, ToSlot, ToWorker},
    proof::ReferenceResult,
    pumping_unit::{
        Discretisation, ElementKind, Integrator, Machine, ModeFamily, ReduceHeadSpec, ReducedHead,
        RopeEnds, Simulation, Smoothing, StressRecovery, TurnSense,
    },
    wire::{self, FrameKind},
};
use serde_reflection::{Samples, Tracer, TracerConfig};
use std::{fs, path::Path};

/// Returns the expected content of `wire_form.txt`: one line for each type that is part of a message or a
/// case.
fn form() -> String {
    let mut tracer = Tracer::new(TracerConfig::default());
    let samples = Samples::new();
    /// Traces each listed type; every enum must be listed, since only the first variant of an enum inside
    /// another type is traced.
    macro_rules! trace {
        ($($type:ty)*) => {
            $(tracer.trace_type::<$type>(&samples).expect("a form");)*
        };
    }
    trace!(ToWorker FromWorker ToSlot FromSlot Case Machine);
    trace!(Simulation Discretisation ReduceHeadSpec ReducedHead);
    trace!(Job Reply Answer Outcome Failure Verdict Reached Derivative Per ModeFamily ElementKind);
    trace!(Place Role Sign Scale Integrator Offset RopeEnds Smoothing StressRecovery);
    trace!(TurnSense Reproducibility ReferenceResult ChannelLimit);
    let registry = tracer.registry().expect("every variant was seen");
    let mut text = format!("wire version {}\n", wire::VERSION);
    for (name, form) in registry {
        let line = format!("{name}: {form:?}\n");
        text.push_str(&line);
    }
    text
}

#[test]
fn nothing_that_travels_changes_without_the_wire_version() {
    let (is, was) = (form(), include_str!("wire_form.txt"));
    if is == was {
        return;
    }
    let kept = Path::new(env!("CARGO_TARGET_TMPDIR")).join("wire_form.txt");
    fs::write(&kept, &is).unwrap();
    let changed: Vec<&str> = is
        .lines()
        .filter(|line| !was.lines().any(|before| before == *line))
        .collect();
    let same_version = is.lines().next() == was.lines().next();
    assert!(
        !same_version,
        "the form of what travels has changed: raise wire::VERSION, then take over {}\n{}",
        kept.display(),
        changed.join("\n")
    );
    panic!(
        "a new version: take over {} as tests/wire_form.txt",
        kept.display()
    );
}

/// Checks the layout of a frame byte by byte: the header and the encoding of numbers.
#[test]
fn a_frame_is_laid_out_as_it_was() {
    let attempt = Attempt {
        job: JobId(0x0102),
        attempt: AttemptId(0x0003_0004),
    };
    let beat = Heartbeat {
        number: 5,
        case: None,
        proof: Some(ReferenceResult::Bits(ContentHash([6; 32]))),
        running: vec![attempt],
        waiting: Vec::new(),
        finished: Vec::new(),
    };
    let message = FromWorker::Beat(beat);
    let frame = wire::encode_frame(
        FrameKind::FromWorker,
        RunId(0x1122_3344_5566_7788),
        &message,
    )
    .unwrap();
    let body: String = [
        "01000000 0500000000000000 00 01 00000000",
        &"06".repeat(32),
        "0100000000000000 0201000000000000 04000300",
        "0000000000000000 0000000000000000",
    ]
    .concat();
    let header = format!("4848 {:02x} 02 8877665544332211 56000000", wire::VERSION);
    let expected = bytes(&header);
    assert_eq!(frame[..expected.len()], expected);
    assert_eq!(frame[16..20], crc32fast::hash(&frame[20..]).to_le_bytes());
    assert_eq!(frame[20..], bytes(&body));
}

/// Parses hexadecimal digits, with spaces allowed, into bytes.
fn bytes(text: &str) -> Vec<u8> {
    let digits: Vec<u8> = text
        .chars()
        .filter_map(|digit| u8::try_from(digit.to_digit(16)?).ok())
        .collect();
    digits
        .chunks(2)
        .map(|pair| pair[0] << 4 | pair[1])
        .collect()
}
