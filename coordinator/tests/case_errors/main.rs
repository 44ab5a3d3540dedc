//! Whatever is wrong with a case ends in one error that names the file, the field, and a remedy.
#![expect(
    clippy::unwrap_used,
    reason = "a test that cannot prepare its case has failed"
)]
mod back_head;
mod card;
mod case_file;
mod record;
mod spoilt;

use coordinator::case::{self, Overrides};
use spoilt::{Copy, assert_each_is_named, scaled};
use std::fs;

#[test]
fn every_fault_of_the_case_file_is_named() {
    assert_each_is_named(case_file::FAULTS);
}

#[test]
fn every_fault_of_a_load_card_is_named() {
    assert_each_is_named(card::FAULTS);
}

#[test]
fn every_fault_of_a_record_is_named() {
    assert_each_is_named(record::FAULTS);
}

#[test]
fn every_fault_of_the_back_head_is_named() {
    assert_each_is_named(back_head::FAULTS);
}

#[test]
fn another_test_of_the_same_machine_replaces_the_records() {
    let copy = Copy::new();
    let other = copy.path("other");
    fs::create_dir(&other).unwrap();
    let overrides = Overrides {
        measured: Some(other.clone()),
    };
    let load = || case::load(copy.folder.path(), &overrides);
    let message = load().unwrap_err().to_string();
    assert!(
        message.contains("other/card_5rpm.csv: no such file"),
        "{message}"
    );
    for file in [
        "card_5rpm.csv",
        "test_5rpm.csv.gz",
        "test_5rpm.toml",
        "card_4rpm.csv",
        "test_4rpm.csv.gz",
    ] {
        fs::copy(copy.path(&format!("measured/{file}")), other.join(file)).unwrap();
    }
    let message = load().unwrap_err().to_string();
    assert!(
        message.contains("other/test_4rpm.toml: no such file"),
        "{message}"
    );
    fs::copy(
        copy.path("measured/test_4rpm.toml"),
        other.join("test_4rpm.toml"),
    )
    .unwrap();
    copy.lines("other/test_5rpm.csv.gz", |at, line| {
        scaled(at, line, &[2], 2.0)
    });
    let plain = case::load(copy.folder.path(), &Overrides::default()).unwrap();
    let replaced = load().unwrap();
    let first = |case: &protocol::case::Case| {
        case.conditions[0].record.as_ref().unwrap().gauges[0].mean_mpa[7]
    };
    assert!((first(&replaced) - 2.0 * first(&plain)).abs() < 1e-9);
    assert_eq!(replaced.conditions[1], plain.conditions[1]);
}
