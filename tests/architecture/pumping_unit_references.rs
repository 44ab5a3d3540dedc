//! Checks that only listed files refer to the pumping unit: it is one model among others, and all other code
//! must work for any model.
use crate::banned_words::sources;
use std::{fs, path::Path};

/// Source folders of the product that are searched for the pumping unit.
const HOUSE: [&str; 16] = [
    "protocol/src",
    "protocol/link/src",
    "worker/src",
    "coordinator/src",
    "coordinator/search/src",
    "coordinator/discrepancy/src",
    "coordinator/case/src",
    "coordinator/dashboard/src",
    "coordinator/run/src",
    "coordinator/dispatch/src",
    "coordinator/fatigue/src",
    "coordinator/launch/src",
    "coordinator/report/src",
    "coordinator/store/src",
    "coordinator/study/src",
    "tests/oscillator",
];

/// Folders and files that may refer to the pumping unit: its own, and those that register it.
const KNOW_IT: [&str; 17] = [
    "protocol/src/pumping_unit",
    "worker/src/pumping_unit",
    "coordinator/src/cli/command/head",
    "coordinator/src/cli/command/balance",
    "coordinator/src/cli/command/life",
    "coordinator/src/cli/command/record.rs",
    "coordinator/src/cli/output/model",
    "coordinator/case/src/pumping_unit",
    "coordinator/report/src/pumping_unit",
    // an evaluator for tests, which takes the shipped case for an example
    "coordinator/study/src/test_evaluator.rs",
    // the folders' names
    "protocol/src/lib.rs",
    "worker/src/lib.rs",
    "coordinator/case/src/lib.rs",
    "coordinator/report/src/lib.rs",
    // the list of kinds, the words of its failures, the template that `case new` writes
    "coordinator/case/src/kind.rs",
    "coordinator/report/src/failure.rs",
    "coordinator/src/cli/command/case.rs",
];

#[test]
fn only_its_own_folders_know_the_pumping_unit() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let (mut said, mut known) = (Vec::new(), 0);
    for file in HOUSE.iter().flat_map(|part| sources(&root.join(part))) {
        let place = file.strip_prefix(&root).expect("inside");
        let text = fs::read_to_string(&file).expect("a source");
        // tests of the general parts take the shipped case for an example
        let product = text.split("#[cfg(test)]").next().unwrap_or_default();
        let name = place.file_name().unwrap_or_default().to_string_lossy();
        let is_test = name.ends_with("tests.rs");
        if is_test || !product.contains("pumping_unit") {
            continue;
        }
        known += 1;
        if !KNOW_IT.iter().any(|part| place.starts_with(part)) {
            said.push(place.display().to_string());
        }
    }
    assert!(known > 50, "only {known} files name it");
    assert!(said.is_empty(), "{}", said.join("\n"));
}
