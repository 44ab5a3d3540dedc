//! Checks that the practice records load as measured records of the case and have matching answers.
use case::{Overrides, load};
use serde_json::Value;
use std::{collections::BTreeSet, fs, path::Path};

#[test]
fn practice_records_are_read_and_have_answers() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(root.join("practice/answers.json")).expect("answers");
    let answers: Value = serde_json::from_str(&text).expect("an object");
    let names: BTreeSet<String> = answers.as_object().expect("sets").keys().cloned().collect();
    let expected: BTreeSet<String> = (1..=6).map(|k| format!("practice_{k}")).collect();
    assert_eq!(names, expected);
    let mut hidden = Vec::new();
    for name in &names {
        let measured = Some(root.join("practice").join(name));
        let case = root.join("../../cases/cyjs10-5-37hb");
        let loaded = load(&case, &Overrides { measured });
        assert!(loaded.is_ok(), "{name}: {:?}", loaded.err());
        let effects = answers[name]["effects"].as_object().expect("effects");
        hidden.push(effects.len());
    }
    assert_eq!(hidden, [0, 1, 1, 1, 1, 2]);
}
