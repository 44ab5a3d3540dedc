//! Test of what a report says about fits of other families.
use crate::sample;
use report::{self, RivalFit, table};

#[test]
fn a_rival_fit_stands_beside_the_best_with_all_its_values() {
    let mut data = sample::calibration(40);
    let alone = report::text(&report::calibration(&data), false);
    assert!(!alone.contains("rival") && !alone.contains("Several fits"));
    let mut genes = data.optimised.genes.clone();
    genes[0] *= 12.5;
    data.rivals = vec![RivalFit {
        genes,
        objective: 0.731,
        differs: vec!["kb1".to_owned()],
    }];
    let best = data.optimised.genes[0];
    let said = report::rivals(&data).expect("a sentence");
    assert!(
        said.contains("another fit, with an objective of 0.731 MPa²"),
        "{said}"
    );
    assert!(
        said.contains("It differs from the best one in kb1;"),
        "{said}"
    );
    let all = report::text(&report::calibration(&data), false);
    assert!(all.contains(&said));
    let table = table::rivals(&data).expect("a table");
    assert_eq!(table.head, ["", "unit", "optimised", "rival 1"]);
    let [table::Row::Values(_, cells), ..] = &table.rows[..] else {
        unreachable!("{table:?}")
    };
    let shown = [best, 12.5 * best].map(report::number::significant);
    assert_eq!(cells[1..], shown);
    assert!(report::parameters(&data, false).contains("rival 1"));
}
