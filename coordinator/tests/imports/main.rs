//! Tests of `horsehead record import` on the raw files of the shipped case: records and cards come back, and
//! faults of raw files and mappings are named with line and column.
#![expect(
    clippy::unwrap_used,
    reason = "helpers of tests: a command that cannot be run or read has failed"
)]
mod faults;
mod folder;
mod formats;

use case::{Overrides, pumping_unit::read_card};
use folder::ImportFolder;
use protocol::{case::ChannelRecord, pumping_unit::Smoothing};
use std::{fs, path::Path};

/// Returns the mean curves of all gauges of a case, by condition and channel.
fn records(case: &Path) -> Vec<(String, usize, ChannelRecord)> {
    let case = case::load(case, &Overrides::default()).unwrap();
    let recorded = case.channels.iter().filter_map(|channel| {
        let record = channel.record.clone()?;
        Some((channel.title.clone(), channel.condition, record))
    });
    recorded.collect()
}

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let squares: Vec<f64> = values.map(|value| value * value).collect();
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

/// Checks that the raw files of the shipped case give its records within their noise, and its load cards
/// within a thousandth of the load.
#[test]
fn the_shipped_records_and_cards_come_back() {
    let folder = ImportFolder::new();
    let raw = folder.raw_bytes();
    for speed in ["5rpm", "4rpm"] {
        folder.import(speed);
    }
    assert_eq!(folder.raw_bytes(), raw, "a raw file was changed");
    let (imported, shipped) = (records(&folder.path("case")), records(&folder::shipped()));
    // four gauges, rod position and torque of two records
    assert_eq!(imported.len(), 12);
    for ((title, condition, new), (_, _, old)) in imported.iter().zip(&shipped) {
        let pairs = || new.mean.iter().zip(&old.mean);
        let noise = rms(old.spread.iter().copied()) / (old.cycles as f64).sqrt();
        let difference = rms(pairs().map(|(a, b)| a - b));
        assert!(
            difference < 0.5 * noise,
            "{title}, {condition}: {difference} of {noise}"
        );
        assert_eq!(new.cycles, old.cycles, "{title}, {condition}");
    }
    for speed in ["5rpm", "4rpm"] {
        let file = format!("measured/card_{speed}.csv");
        let [new, old] = [folder.path("case"), folder::shipped()]
            .map(|case| read_card(&case.join(&file), Smoothing::None, "a card").unwrap());
        let difference = rms(new.load_n.iter().zip(&old.load_n).map(|(a, b)| a - b));
        let highest = old.load_n.iter().copied().fold(0.0, f64::max);
        assert!(difference < 1e-3 * highest, "{speed}: {difference}");
    }
    let (code, said) = folder.run("case check case");
    assert_eq!(code, 0, "{said}");
    // nothing but what the shipped case itself is told
    let told: Vec<&str> = said
        .lines()
        .filter(|line| line.starts_with("note"))
        .collect();
    assert!(
        told.iter().all(|note| note.contains("samples are lost")),
        "{told:?}"
    );
}

/// Checks that the same command gives the same bytes, that a sheet's own keys stay, and that the uncertainty
/// of the angle reaches it.
#[test]
fn an_import_is_repeatable() {
    let folder = ImportFolder::new();
    folder.import("5rpm");
    let files = [
        "test_5rpm.csv.gz",
        "test_5rpm.toml",
        "test_5rpm.import.svg",
        "card_5rpm.csv",
    ];
    let read = || files.map(|file| fs::read(folder.path("case/measured").join(file)).unwrap());
    let first = read();
    let (code, said) = folder.run("record import --case case --condition 5rpm");
    assert_eq!(code, 0, "{said}");
    assert_eq!(read(), first);
    folder.replace(
        "case/measured/test_5rpm.toml",
        "# noise_rms_mpa = 0.2 ",
        "noise_rms_mpa = 0.3 ",
    );
    folder.replace(
        "case/measured/test_5rpm.import.toml",
        "uncertainty_deg = 0.06",
        "uncertainty_deg = 0.5",
    );
    folder.run("record import --case case --condition 5rpm");
    let sheet = fs::read_to_string(folder.path("case/measured/test_5rpm.toml")).unwrap();
    assert!(sheet.contains("\nnoise_rms_mpa = 0.3 "), "{sheet}");
    assert!(sheet.contains("\nindex_deg = 0.5 "), "{sheet}");
}

/// Checks that a record which was not imported is never replaced.
#[test]
fn a_record_of_other_origin_is_not_replaced() {
    let folder = ImportFolder::new();
    let record = folder.path("case/measured/test_5rpm.csv.gz");
    fs::create_dir_all(record.parent().unwrap()).unwrap();
    fs::write(&record, "by hand").unwrap();
    let (code, said) =
        folder.run("record import case/raw/strain_5rpm.csv.gz --case case --condition 5rpm");
    assert_eq!(code, 2, "{said}");
    assert!(
        said.contains("it exists, and no mapping beside it"),
        "{said}"
    );
    assert_eq!(fs::read(&record).unwrap(), b"by hand");
}
