//! The commands of the tutorial one after the other, each with the run folder that it chooses itself.
use super::rig::Rig;
use std::fs;

/// Checks that every command finds the run that it continues, and that runs on other genes, effects and seeds have folders
/// of their own.
#[test]
fn the_steps_of_the_tutorial_follow_each_other() {
    let rig = Rig::new();
    let run_of = |words: &[&str]| {
        let object = rig.json(words);
        object["run"].as_str().unwrap().to_owned()
    };
    let first = run_of(&["calibrate", "CASE"]);
    assert_eq!(first, "runs/case-quick-seed1");
    assert_eq!(run_of(&["identify", &first]), "runs/case-identify-seed1");
    let diagnosed = run_of(&["diagnose", &first]);
    assert_eq!(diagnosed, "runs/case-diagnose-seed1");
    let case = || fs::read_to_string(rig.file("case/case.toml")).unwrap();
    assert!(!case().contains("dry_friction"));
    let genes = format!("{diagnosed}/calibrated.toml");
    // the values of a diagnosis take the effect with which they were found
    let simulate = || rig.json(&["simulate", "CASE", "--genes", &genes])["objective"].clone();
    let with_effect = simulate();
    let plain = rig.json(&[
        "simulate",
        "CASE",
        "--genes",
        &format!("{first}/calibrated.toml"),
    ]);
    let [less, more] = [&with_effect, &plain["objective"]].map(|value| value.as_f64().unwrap());
    assert!(less < 0.5 * more, "{less} against {more}");
    // the same run, which then belongs to a case that has its effect
    assert_eq!(run_of(&["diagnose", &first, "--add"]), diagnosed);
    assert!(case().contains("id = \"dry_friction\""));
    assert_eq!(run_of(&["diagnose", &first]), diagnosed);
    assert_eq!(simulate(), with_effect, "the same effect in the case");
    let after = run_of(&["calibrate", "CASE", "--genes", &genes]);
    let hash = after.strip_prefix("runs/case-quick-genes-").unwrap();
    let hash = hash.strip_suffix("-with-dry-friction-seed1").unwrap();
    assert_eq!(hash.len(), 8, "{after}");
    let journal = || {
        fs::metadata(rig.file(&after).join("journal.hhj"))
            .unwrap()
            .len()
    };
    let before = journal();
    assert_eq!(run_of(&["calibrate", "CASE", "--genes", &genes]), after);
    // a session leaves its beginning and its end
    assert!(
        journal() < before + before / 10,
        "the finished run was computed again"
    );

    let other = run_of(&[
        "calibrate",
        "CASE",
        "--preset",
        "least-squares",
        "--seed",
        "5",
    ]);
    assert_eq!(other, "runs/case-least-squares-with-dry-friction-seed5");
    let identified = run_of(&["identify", &other]);
    assert_eq!(
        identified,
        "runs/case-identify-least-squares-with-dry-friction-seed5"
    );
}
