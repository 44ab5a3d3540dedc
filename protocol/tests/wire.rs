//! Property tests of the wire encoding: every value survives encoding and decoding, and no input makes the
//! decoder panic.
#[expect(unreachable_pub, reason = "a module of the fuzz targets, too")]
#[path = "../../tests/fuzz/targets/property/wire.rs"]
mod property;

use property::{is_a_frame_or_refused, is_canonical, is_canonical_in_frame};
use proptest::{collection::vec, option, prelude::*};
use protocol::{
    case::EffectSetting,
    file::File,
    id::{AttemptId, ContentHash, JobId, RunId},
    job::{
        Answer, Column, Failure, FailureFiles, Individual, Job, Numerics, Outcome, Reply,
        SimulateSpec, TruncatedFile,
    },
    message::{Assignment, Attempt, Cost, Done, FromSlot, FromWorker, Heartbeat, ToSlot, ToWorker},
    proof::{ReferenceResult, Sample},
    wire::{self, FrameKind, WireError},
};

fn attempt() -> impl Strategy<Value = Attempt> {
    (any::<u64>(), any::<u32>()).prop_map(|(job, attempt)| Attempt {
        job: JobId(job),
        attempt: AttemptId(attempt),
    })
}

fn bytes() -> impl Strategy<Value = Vec<u8>> {
    vec(any::<u8>(), 0..200)
}

fn effect() -> impl Strategy<Value = EffectSetting> {
    (".{0,20}", vec((".{0,9}", -1e9..1e9), 0..4))
        .prop_map(|(id, parameters)| EffectSetting { id, parameters })
}

fn job() -> impl Strategy<Value = Job> {
    prop_oneof![
        (bytes(), any::<u32>(), any::<u32>()).prop_map(|(payload, reply_bytes, delay_ms)| {
            Job::Nothing {
                payload,
                reply_bytes,
                delay_ms,
            }
        }),
        (
            0..9_usize,
            vec(-1e9..1e9, 0..12),
            vec(effect(), 0..3),
            any::<bool>(),
            any::<bool>()
        )
            .prop_map(|(condition, genes, effects, with_residual, whole)| {
                let individual = Individual {
                    condition,
                    genes,
                    effects,
                };
                Job::Simulate(SimulateSpec::new(
                    individual,
                    Reply::Score {
                        with_residual,
                        whole,
                    },
                ))
            }),
        (vec(effect(), 0..3), vec(any::<u8>(), 0..9)).prop_map(|(effects, numerics)| {
            Job::Simulate(SimulateSpec {
                individual: Individual {
                    effects,
                    ..Individual::default()
                },
                numerics: Numerics(numerics),
                reply: Reply::Channels,
                columns: vec![Column::new("size")],
            })
        }),
    ]
}

fn outcome() -> impl Strategy<Value = Outcome> {
    prop_oneof![
        bytes().prop_map(|bytes| Outcome::Done(Answer::Nothing(bytes))),
        (".{0,40}", left())
            .prop_map(|(how, left)| { Outcome::Failed(Failure::Crashed { how, left }) }),
        any::<u64>().prop_map(|limit_ms| Outcome::Failed(Failure::deadline(limit_ms))),
    ]
}

fn left() -> impl Strategy<Value = FailureFiles> {
    let file = (".{0,20}", bytes(), any::<bool>()).prop_map(|(path, content, executable)| File {
        path,
        content,
        executable,
    });
    let short = (".{0,20}", any::<u64>(), any::<u64>())
        .prop_map(|(path, bytes, kept)| TruncatedFile { path, bytes, kept });
    (vec(file, 0..4), vec(short, 0..4))
        .prop_map(|(files, shortened)| FailureFiles { files, shortened })
}

fn proof() -> impl Strategy<Value = ReferenceResult> {
    let sample = (-1e9..1e9, 0.0..1e9).prop_map(|(value, scale)| Sample { value, scale });
    prop_oneof![
        Just(ReferenceResult::Failed),
        any::<[u8; 32]>().prop_map(|hash| ReferenceResult::Bits(ContentHash(hash))),
        vec(sample, 0..9).prop_map(ReferenceResult::Values),
    ]
}

fn to_worker() -> impl Strategy<Value = ToWorker> {
    prop_oneof![
        Just(ToWorker::Identify),
        Just(ToWorker::Ended),
        (any::<u32>(), any::<[u8; 32]>(), any::<u64>()).prop_map(|(epoch, case, case_bytes)| {
            ToWorker::Admitted {
                epoch,
                case: ContentHash(case),
                case_bytes,
            }
        }),
        (attempt(), any::<u64>(), job()).prop_map(|(attempt, deadline_ms, job)| {
            ToWorker::Run(Box::new(Assignment {
                attempt,
                deadline_ms,
                job,
            }))
        }),
        attempt().prop_map(ToWorker::Cancel),
        vec(attempt(), 0..20).prop_map(ToWorker::Stored),
    ]
}

fn from_worker() -> impl Strategy<Value = FromWorker> {
    prop_oneof![
        (
            any::<u64>(),
            option::of(any::<[u8; 32]>()),
            proof(),
            vec(attempt(), 0..9),
            vec(attempt(), 0..9)
        )
            .prop_map(|(number, case, proof, running, waiting)| {
                FromWorker::Beat(Heartbeat {
                    number,
                    case: case.map(ContentHash),
                    proof: Some(proof),
                    finished: running.iter().rev().copied().collect(),
                    running,
                    waiting,
                })
            }),
        (attempt(), any::<[u8; 32]>(), any::<[u64; 2]>(), outcome()).prop_map(
            |(attempt, work, [wall_us, cpu_us], outcome)| {
                FromWorker::Done(Box::new(Done {
                    attempt,
                    work: ContentHash(work),
                    cost: Cost { wall_us, cpu_us },
                    outcome,
                }))
            }
        ),
        ".{0,40}".prop_map(|reason| FromWorker::Leaving { reason }),
    ]
}

proptest! {
    #[test]
    fn every_message_survives_the_wire(run: u64, down in to_worker(), up in from_worker()) {
        let frame = wire::encode_frame(FrameKind::ToWorker, RunId(run), &down).unwrap();
        prop_assert_eq!(wire::decode_frame(FrameKind::ToWorker, &frame), Ok((RunId(run), down)));
        let frame = wire::encode_frame(FrameKind::FromWorker, RunId(run), &up).unwrap();
        prop_assert_eq!(wire::decode_frame(FrameKind::FromWorker, &frame), Ok((RunId(run), up)));
    }

    #[test]
    fn a_frame_cut_anywhere_is_refused_as_cut(message in to_worker()) {
        let frame = wire::encode_frame(FrameKind::ToWorker, RunId(3), &message).unwrap();
        for length in 0..frame.len() {
            let cut = wire::decode_frame::<ToWorker>(FrameKind::ToWorker, &frame[..length]);
            prop_assert!(matches!(cut, Err(WireError::Truncated { .. })), "{length}: {cut:?}");
        }
    }

    #[test]
    fn one_flipped_bit_in_the_body_or_its_length_is_seen(message in from_worker(), at: usize, bit in 0..8) {
        let mut frame = wire::encode_frame(FrameKind::FromWorker, RunId(3), &message).unwrap();
        let from = 12;
        let at = from + at % (frame.len() - from);
        frame[at] ^= 1_u8 << bit;
        prop_assert!(wire::decode_frame::<FromWorker>(FrameKind::FromWorker, &frame).is_err());
    }

    #[test]
    fn arbitrary_bytes_are_refused_or_written_in_one_way_only(noise in vec(any::<u8>(), 0..400)) {
        is_a_frame_or_refused(&noise);
        is_canonical_in_frame::<ToWorker>(FrameKind::ToWorker, &noise);
        is_canonical_in_frame::<FromWorker>(FrameKind::FromWorker, &noise);
        is_canonical_in_frame::<ToSlot>(FrameKind::ToSlot, &noise);
        is_canonical_in_frame::<FromSlot>(FrameKind::FromSlot, &noise);
        is_canonical::<protocol::case::Case>(&noise);
    }
}

#[test]
fn what_does_not_belong_is_named() {
    let good = wire::encode_frame(FrameKind::ToWorker, RunId(7), &ToWorker::Identify).unwrap();
    let with = |at: usize, value: u8| {
        let mut frame = good.clone();
        frame[at] = value;
        wire::decode_frame::<ToWorker>(FrameKind::ToWorker, &frame).unwrap_err()
    };
    assert_eq!(with(0, b'X'), WireError::Magic { found: *b"XH" });
    assert_eq!(with(2, 99), WireError::Version { found: 99 });
    assert_eq!(
        with(3, 2),
        WireError::Kind {
            found: 2,
            expected: 1
        }
    );
    assert!(matches!(with(15, 0xff), WireError::TooLong { .. }));
    assert!(matches!(with(16, good[16] ^ 1), WireError::Checksum { .. }));
    let mut longer = good;
    longer.push(0);
    assert_eq!(
        wire::decode_frame::<ToWorker>(FrameKind::ToWorker, &longer).unwrap_err(),
        WireError::Leftover { bytes: 1 }
    );
    let body = wire::encode(&(ToWorker::Identify, 0_u8)).unwrap();
    assert_eq!(
        wire::decode::<ToWorker>(&body).unwrap_err(),
        WireError::Leftover { bytes: 1 }
    );
}

/// Checks that a hostile length prefix is refused before the decoder allocates memory for it.
#[test]
fn a_promise_of_more_than_there_is_is_refused() {
    let mut body = wire::encode(&ToWorker::Stored(Vec::new())).unwrap();
    let end = body.len();
    body[end - 8..].copy_from_slice(&u64::MAX.to_le_bytes());
    assert!(matches!(
        wire::decode::<ToWorker>(&body),
        Err(WireError::Malformed { .. })
    ));
}

/// Checks that what a slot can hand in can be sent on; the journal's tests check that it can be stored.
#[test]
fn what_a_slot_can_hand_in_can_be_sent_on() {
    let outcome = |bytes: usize| Outcome::Done(Answer::Nothing(vec![0; bytes]));
    let from_slot = |bytes| {
        let message = FromSlot::Done {
            outcome: Box::new(outcome(bytes)),
            cpu_us: u64::MAX,
        };
        wire::encode_frame(FrameKind::FromSlot, RunId(0), &message)
    };
    let around = from_slot(0).unwrap().len() - wire::HEADER_BYTES;
    let most = FrameKind::FromSlot.limit() - around;
    from_slot(most).unwrap();
    assert!(matches!(
        from_slot(most + 1),
        Err(WireError::TooLong { bytes, limit }) if bytes == limit + 1
    ));
    let attempt = Attempt {
        job: JobId(u64::MAX),
        attempt: AttemptId(u32::MAX),
    };
    let work = ContentHash([255; 32]);
    let cost = Cost {
        wall_us: u64::MAX,
        cpu_us: u64::MAX,
    };
    let sent = |bytes| {
        let done = Done {
            attempt,
            work,
            cost,
            outcome: outcome(bytes),
        };
        wire::encode_frame(
            FrameKind::FromWorker,
            RunId(1),
            &FromWorker::Done(Box::new(done)),
        )
    };
    // what is not of ours may be longer than any slot's, up to the limit of its kind
    let around = sent(0).unwrap().len() - wire::HEADER_BYTES;
    let longest = FrameKind::FromWorker.limit() - around;
    assert!(most <= longest && sent(longest).is_ok() && sent(longest + 1).is_err());
}
