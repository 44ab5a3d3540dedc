//! Record without a hidden effect, in which the diagnosis must detect nothing.
use crate::coarse::{Trial, run};

#[test]
#[ignore = "a second diagnosis; the acceptance of `discrepancy` has many on a stand-in machine"]
fn nothing_is_named_where_nothing_is() {
    let trial = Trial::make(&["--seed", "2", "--stratum", "zero", "--noise", "4"]);
    let said = run(&mut trial.diagnose());
    let verdict: serde_json::Value = serde_json::from_str(&said).expect("a verdict");
    assert_eq!(verdict["verdict"], "nothing_detected", "{verdict}");
    let table = trial.open(&said);
    eprintln!("{table}");
    assert!(table.contains("| zero: any claim | <= 5 % | 0/1 = 0 %"));
}
