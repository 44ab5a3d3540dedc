//! Property tests of file readers on arbitrary bytes: they return a value or an error, and never panic.
//!
//! Short form of `tests/fuzz`, which runs about a million inputs with compiler instrumentation.
#![expect(
    clippy::unwrap_used,
    clippy::format_collect,
    reason = "small inputs of a test"
)]
#[expect(
    unreachable_pub,
    dead_code,
    reason = "a module of the fuzz targets, too, and of the tests of the wire"
)]
#[path = "../../tests/fuzz/targets/property/mod.rs"]
mod property;

use case::{Overrides, load};
use journal::event::Event;
use journal::{MARK, ReadReport};
use property::{
    file::{
        are_genes_or_refused, are_samples_or_refused, is_a_card_or_refused, is_a_case_or_refused,
        is_a_mesh_or_refused, is_read_or_reported, record,
    },
    wire::is_canonical,
};
use proptest::{collection::vec, prelude::*};
use protocol::{case::Case, wire};
use std::{path::Path, sync::LazyLock};

static CASE: LazyLock<Case> = LazyLock::new(|| {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb");
    load(&shipped, &Overrides::default()).unwrap()
});

/// Segment of a journal: random bytes, random bytes as the body of a record with valid mark and checksum, or
/// a valid record.
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
        Just(Stretch::Rubbish(MARK.to_vec())),
        bytes().prop_map(Stretch::Sealed),
        sound.prop_map(Stretch::Sound),
    ]
}

proptest! {
    #[test]
    fn every_byte_of_a_journal_is_read_or_reported(stretches in vec(stretch(), 0..12)) {
        let stretch = |stretch: &Stretch| match stretch {
            Stretch::Rubbish(rubbish) => rubbish.clone(),
            Stretch::Sealed(body) => record(body),
            Stretch::Sound(event) => record(&wire::encode(event).unwrap()),
        };
        let bytes: Vec<u8> = stretches.iter().flat_map(stretch).collect();
        let folder = tempfile::tempdir().unwrap();
        let report = is_read_or_reported(folder.path(), &bytes);
        let sound = stretches.iter().filter(|one| matches!(one, Stretch::Sound(_)));
        // rubbish that looks like the beginning of a record may only swallow what it really holds
        let sound = sound.count() as u64;
        let is_all_read = |report: ReadReport| report.records >= sound || !report.damage.is_empty();
        prop_assert!(report.is_none_or(is_all_read));
    }

    #[test]
    fn a_record_of_any_bytes_is_counted_or_refused(
        bytes in vec(any::<u8>(), 0..400),
        rows in vec(("[0-9.e+-]{0,9},", 6..=6_usize), 0..8),
    ) {
        let header = "time_s,crank_deg,stress_1_mpa,stress_2_mpa,stress_3_mpa,stress_4_mpa\n";
        let rows: String = rows.iter().map(|(cell, times)| format!("{}\n", cell.repeat(*times))).collect();
        for csv in [&bytes, &[header.as_bytes(), &bytes].concat(), (header.to_owned() + &rows).as_bytes()] {
            are_samples_or_refused(csv);
        }
    }

    #[test]
    fn a_file_of_any_bytes_is_refused_in_words(
        bytes in vec(any::<u8>(), 0..400),
        numbers in vec(-2..40_i64, 0..60),
    ) {
        let folder = tempfile::tempdir().unwrap();
        let numbers: Vec<String> = numbers.iter().map(ToString::to_string).collect();
        let text = format!(
            "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n{}\n$EndNodes\n$Elements\n{}\n$EndElements\n",
            numbers.join(" "),
            numbers.join("\n"),
        );
        for content in [&bytes, text.as_bytes()] {
            is_a_mesh_or_refused(folder.path(), content);
            is_a_card_or_refused(folder.path(), content);
            is_a_case_or_refused(folder.path(), content);
            are_genes_or_refused(folder.path(), &CASE, content);
        }
    }

    #[test]
    fn an_encoded_case_of_any_bytes_is_written_in_one_way_only(bytes in vec(any::<u8>(), 0..600)) {
        is_canonical::<Case>(&bytes);
    }
}
