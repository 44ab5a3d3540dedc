//! Properties of file readers: each either returns a valid value or an error with a message. Each function
//! writes its input bytes into the given folder.
use super::wire::crc32;
use case::{
    CaseEffect, Overrides,
    pumping_unit::{count_samples, mesh, read_card},
    read_genes, write_genes,
};
use journal::{JournalError, ReadReport};
use protocol::{case::Case, pumping_unit::Smoothing, wire};
use std::{
    fmt::Display,
    fs,
    path::{Path, PathBuf},
};

fn file(folder: &Path, name: &str, content: &[u8]) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, content).expect("a scratch file");
    path
}

fn names_the_file(error: &dyn Display, name: &str) {
    let words = error.to_string();
    assert!(words.contains(name), "{words}");
}

/// Encodes a journal entry: start mark, length, checksum and the given body.
pub fn record(body: &[u8]) -> Vec<u8> {
    let length = u32::try_from(body.len()).expect("inputs are short");
    let checked = [&length.to_le_bytes(), body].concat();
    let checksum = crc32(&checked).to_le_bytes();
    [&journal::MARK, &checked[..4], &checksum, body].concat()
}

/// Checks that every byte of a journal is either read or reported as damage, and that each event read encodes
/// to its original bytes; or that the journal is refused because of an intact record that cannot be read. Returns the
/// report, unless it is refused.
pub fn is_read_or_reported(folder: &Path, bytes: &[u8]) -> Option<ReadReport> {
    let path = file(folder, "journal.hhj", bytes);
    let (mut read, mut events) = (0, 0);
    let report = journal::fold(&path, |entry, event| {
        read += u64::from(entry.length) + 12;
        events += 1;
        let at = usize::try_from(entry.at).expect("short");
        let body = &bytes[at..at + entry.length as usize];
        assert_eq!(wire::encode(&event).expect("can be encoded"), body);
    });
    let report = match report {
        Ok(report) => report,
        Err(error) => {
            names_the_file(&error, "journal.hhj");
            let is_intact = matches!(
                error,
                JournalError::Version { .. } | JournalError::Undecodable { .. }
            );
            assert!(is_intact, "damage is no error: {error}");
            return None;
        }
    };
    let lost: u64 = report.damage.iter().map(|damage| damage.bytes).sum();
    assert_eq!(read + lost, bytes.len() as u64, "{report:?}");
    assert_eq!(report.records, events);
    Some(report)
}

/// Checks that the bytes of a case file are either a valid case or rejected with an error message.
pub fn is_a_case_or_refused(folder: &Path, bytes: &[u8]) {
    file(folder, "case.toml", bytes);
    if let Err(error) = case::check(folder, &Overrides::default()) {
        assert!(!error.to_string().is_empty());
    }
}

/// Checks that the bytes are either a gene file with a value for every gene, which survives writing and
/// reading bit for bit, or rejected with an error message.
pub fn are_genes_or_refused(folder: &Path, case: &Case, bytes: &[u8]) {
    let bits = |genes: &[f64]| genes.iter().map(|gene| gene.to_bits()).collect::<Vec<_>>();
    match read_genes(&file(folder, "genes.toml", bytes), case) {
        Ok(genes) => {
            let text = write_genes(case, &genes, &CaseEffect::all_of(case), "fuzzing");
            let again = read_genes(&file(folder, "again.toml", text.as_bytes()), case);
            let again = again.expect("what was written can be read");
            assert_eq!(bits(&again), bits(&genes));
        }
        Err(error) => names_the_file(&error, "genes.toml"),
    }
}

/// Checks that the bytes are either a load card with at least 24 samples, all finite, or rejected with an
/// error message.
pub fn is_a_card_or_refused(folder: &Path, bytes: &[u8]) {
    match read_card(&file(folder, "card.csv", bytes), Smoothing::None, "a card") {
        Ok(card) => {
            assert!(card.turn_deg.len() >= 24 && card.turn_deg.len() == card.load_n.len());
            assert!(card.load_n.iter().all(|load| load.is_finite()));
        }
        Err(error) => names_the_file(&error, "card.csv"),
    }
}

/// Checks that the bytes are either a mesh whose elements refer to existing nodes, or rejected with an error
/// message.
pub fn is_a_mesh_or_refused(folder: &Path, bytes: &[u8]) {
    match mesh::read(&file(folder, "head.msh", bytes)) {
        Ok(mesh) => {
            let nodes = mesh.nodes_m.len();
            let solid = mesh.volumes.values().flatten();
            let flat = mesh.surfaces.values().flatten();
            assert!(solid.chain(flat).all(|node| *node < nodes));
        }
        Err(error) => names_the_file(&error, "head.msh"),
    }
}

/// Checks that the bytes are either a gauge record with at least four samples, or rejected with an error
/// message.
pub fn are_samples_or_refused(bytes: &[u8]) {
    match count_samples(Path::new("record.csv"), bytes) {
        Ok(samples) => assert!(samples >= 4),
        Err(error) => names_the_file(&error, "record.csv"),
    }
}
