//! Any bytes against the readers of files: an answer or an error in words, never a panic.
//!
//! The short form of `tests/fuzz`, which does the same a million times with a compiler's help.
#![expect(
    clippy::unwrap_used,
    clippy::format_collect,
    reason = "small inputs of a test"
)]
use coordinator::{case, journal};
use proptest::{collection::vec, prelude::*};
use protocol::{
    event::Event,
    wire::{self, HEADER_BYTES},
};
use std::{fs, path::Path};

/// A stretch of a journal: rubbish, or the body of a record whose mark and checksum are in order.
#[derive(Clone, Debug)]
enum Stretch {
    Rubbish(Vec<u8>),
    Sealed(Vec<u8>),
    Sound(Event),
}

fn stretch() -> impl Strategy<Value = Stretch> {
    let bytes = || vec(any::<u8>(), 0..200);
    let sound = prop_oneof![
        Just(Event::Closed),
        (any::<u32>(), any::<u64>())
            .prop_map(|(epoch, at_unix_ms)| Event::Opened { epoch, at_unix_ms }),
    ];
    prop_oneof![
        bytes().prop_map(Stretch::Rubbish),
        Just(Stretch::Rubbish(journal::MARK.to_vec())),
        bytes().prop_map(Stretch::Sealed),
        sound.prop_map(Stretch::Sound),
    ]
}

fn sealed(body: &[u8]) -> Vec<u8> {
    let length = u32::try_from(body.len()).unwrap().to_le_bytes();
    let mut checksum = crc32fast::Hasher::new();
    checksum.update(&length);
    checksum.update(body);
    let checksum = checksum.finalize().to_le_bytes();
    [journal::MARK.as_slice(), &length, &checksum, body].concat()
}

proptest! {
    #[test]
    fn every_byte_of_a_journal_is_read_or_reported(stretches in vec(stretch(), 0..12)) {
        let mut bytes = Vec::new();
        for stretch in &stretches {
            match stretch {
                Stretch::Rubbish(rubbish) => bytes.extend_from_slice(rubbish),
                Stretch::Sealed(body) => bytes.extend(sealed(body)),
                Stretch::Sound(event) => bytes.extend(sealed(&wire::encode(event).unwrap())),
            }
        }
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("journal");
        fs::write(&path, &bytes).unwrap();
        let (mut read, mut events) = (0, 0);
        let report = journal::fold(&path, |entry, _| {
            read += u64::from(entry.length) + 12;
            events += 1;
        })
        .unwrap();
        let lost: u64 = report.damage.iter().map(|damage| damage.bytes).sum();
        prop_assert_eq!(read + lost, bytes.len() as u64);
        prop_assert_eq!(report.records, events);
        let sound = stretches.iter().filter(|one| matches!(one, Stretch::Sound(_)));
        // rubbish that looks like the beginning of a record may only swallow what it really holds
        prop_assert!(events >= sound.count() as u64 || !report.damage.is_empty());
    }

    #[test]
    fn a_record_of_any_bytes_is_counted_or_refused(
        bytes in vec(any::<u8>(), 0..400),
        rows in vec(("[0-9.e+-]{0,9},", 6..=6_usize), 0..8),
    ) {
        let path = Path::new("record.csv");
        let header = "time_s,crank_deg,stress_1_mpa,stress_2_mpa,stress_3_mpa,stress_4_mpa\n";
        let rows: String = rows.iter().map(|(cell, times)| format!("{}\n", cell.repeat(*times))).collect();
        for csv in [bytes.clone(), [header.as_bytes(), &bytes].concat(), [header, &rows].concat().into_bytes()] {
            match case::count_samples(path, &csv) {
                Ok(samples) => prop_assert!(samples >= 4),
                Err(error) => prop_assert!(error.to_string().contains("record.csv")),
            }
        }
    }

    #[test]
    fn a_mesh_of_any_bytes_is_refused_in_words(
        bytes in vec(any::<u8>(), 0..400),
        numbers in vec(-2..40_i64, 0..60),
    ) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("head.msh");
        let numbers: Vec<String> = numbers.iter().map(ToString::to_string).collect();
        let text = format!(
            "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n{}\n$EndNodes\n$Elements\n{}\n$EndElements\n",
            numbers.join(" "),
            numbers.join("\n"),
        );
        for content in [bytes, text.into_bytes()] {
            fs::write(&path, content).unwrap();
            let refused = case::mesh::read(&path).unwrap_err().to_string();
            prop_assert!(refused.contains("head.msh"), "{}", refused);
        }
    }

    #[test]
    fn an_encoded_case_of_any_bytes_is_written_in_one_way_only(bytes in vec(any::<u8>(), 0..600)) {
        if let Ok(case) = wire::decode::<protocol::case::Case>(&bytes) {
            prop_assert_eq!(wire::encode(&case).unwrap(), bytes.as_slice());
        }
        prop_assert!(wire::open(wire::Kind::FromWorker, &bytes).is_err() || bytes.len() >= HEADER_BYTES);
    }
}
