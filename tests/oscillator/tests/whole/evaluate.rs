//! Tests of `evaluate`, with which another program requests individuals: every line is answered, invalid
//! lines name their error, and repeated requests are answered from the journal.
use crate::rig::{Rig, number};
use serde_json::{Value, json};

/// Returns a request line for `evaluate` with values for the unknowns of the case.
fn line(id: &Value, mass: f64, more: &Value) -> String {
    let mut line = json!({"id": id, "genes": {
        "mass": mass, "left": 5.6, "damping": 26.0, "lead": 1.7}});
    for (key, value) in more.as_object().into_iter().flatten() {
        line[key] = value.clone();
    }
    line.to_string()
}

fn of<'a>(lines: &'a [Value], id: &Value) -> &'a Value {
    let found: Vec<&Value> = lines.iter().filter(|line| line["id"] == *id).collect();
    assert_eq!(found.len(), 1, "{id}: {lines:?}");
    found[0]
}

#[test]
fn lines_are_scored_and_asked_again_they_come_from_the_journal() {
    let rig = Rig::new();
    let searched = rig.json(&["case", "check", "CASE"]);
    let run = rig.path("run");
    let words = ["evaluate", "CASE", "--run", &run];
    let good = [
        line(&json!(1), 2.1, &json!({"residual": true})),
        line(&json!("two"), 2.2, &json!({})),
        line(&json!(3), 2.1, &json!({"residual": true})),
    ];
    let (lines, code) = rig.run_with_input(&words, &good.join("\n"));
    assert_eq!(code, Some(0), "{searched}");
    assert_eq!(lines.len(), 3);
    let first = of(&lines, &json!(1));
    assert_eq!(
        (&first["complete"], &first["verdict"]),
        (&json!(true), &json!("complete"))
    );
    let residual = first["residual"].as_array().unwrap();
    let squares: f64 = residual.iter().map(|r| number(r) * number(r)).sum();
    let objective = number(&first["objective"]);
    assert!(
        (squares / objective - 1.0).abs() < 1e-9,
        "{squares} {objective}"
    );
    assert_eq!(of(&lines, &json!(3))["objective"], first["objective"]);
    let second = of(&lines, &json!("two"));
    assert!(second.get("residual").is_none() && second["objective"] != first["objective"]);
    // in another order, with a new one: the journal grows by that one alone
    let journal = || {
        std::fs::metadata(rig.file("run/journal.hhj"))
            .unwrap()
            .len()
    };
    let before = journal();
    let more = [
        good[1].clone(),
        good[0].clone(),
        line(&json!(9), 2.3, &json!({})),
    ];
    let (again, code) = rig.run_with_input(&words, &more.join("\n"));
    assert_eq!(code, Some(0));
    assert_eq!(of(&again, &json!(1)), first);
    assert_eq!(of(&again, &json!("two")), second);
    assert!(of(&again, &json!(9))["complete"] == true);
    assert!(journal() > before);
}

#[test]
fn a_line_that_cannot_be_taken_is_answered_and_the_others_go_on() {
    let rig = Rig::new();
    let run = rig.path("run");
    let lines = [
        "nonsense".to_owned(),
        line(&json!(1), 1e9, &json!({})),
        line(&json!(2), 2.1, &json!({"gene": 1})),
        line(&json!(3), 2.1, &json!({})),
    ];
    let (said, code) = rig.run_with_input(&["evaluate", "CASE", "--run", &run], &lines.join("\n"));
    assert_eq!(code, Some(2), "{said:?}");
    assert_eq!(said.len(), 4);
    assert_eq!(of(&said, &Value::Null)["line"], 1);
    let outside = of(&said, &json!(1));
    assert!(
        outside["error"]
            .as_str()
            .unwrap()
            .contains("mass = 1e9 lies outside")
    );
    assert!(outside["help"].as_str().unwrap().contains("kg"));
    assert!(
        of(&said, &json!(2))["error"]
            .as_str()
            .unwrap()
            .contains("gene")
    );
    assert_eq!(of(&said, &json!(3))["complete"], true);
}
