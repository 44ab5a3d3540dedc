//! Tests of what a report says about the uncertainty of the identified values: intervals, and fits of other families.
use crate::sample;
use discrepancy::identify::{Determination, IntervalEnd, UnknownEstimate};
use report::document::TerminalStyle;
use report::{self, RivalFit, table};

/// Checks that unknowns have intervals where the fit leaves about as much as the noise, and none where it leaves
/// a multiple of it.
#[test]
fn a_fit_that_leaves_a_multiple_of_the_noise_has_no_intervals() {
    let mut data = sample::calibration(40);
    let [first, ..] = &data.case.unknowns[..] else {
        unreachable!("unknowns")
    };
    data.identifiability = vec![UnknownEstimate {
        name: first.name.clone(),
        unit: first.unit.clone(),
        value: 7.8e8,
        interval: [Some(5.25e8), Some(9.75e8)],
        ends: [IntervalEnd::Rises; 2],
        seen: Determination::Both,
        correlated: Vec::new(),
        profile: Vec::new(),
    }];
    let case = data.case.clone();
    let gaps = data.conditions[0].optimised.gaps(&case, 0);
    let fitted = gaps
        .into_iter()
        .filter(|(channel, _)| case.objective.names(&channel.name));
    let ratios = fitted.filter_map(|(_, gap)| gap.over_noise());
    let most = ratios.fold(0.0, f64::max);
    for (times, expected) in [(1.3, true), (4.0, false)] {
        let mut data = data.clone();
        for channel in &mut data.case.channels {
            if let Some(record) = &mut channel.record {
                let noise = &mut record.spread;
                for one in noise.iter_mut() {
                    *one *= most / times;
                }
            }
        }
        let page = report::text(&report::calibration(&data), TerminalStyle::default());
        let interval = "5.25\u{a0}×\u{a0}10⁸ to 9.75\u{a0}×\u{a0}10⁸\u{a0}N/m";
        assert_eq!(page.contains(interval), expected, "{page}");
        assert_eq!(page.contains("what the record says, 95 %"), expected);
        let reason = "4.0 times the noise is left: the model lacks something, and no unknown has an interval";
        assert_eq!(page.contains(reason), !expected, "{page}");
        assert_eq!(report::words::intervals(&data).is_empty(), !expected);
    }
}

#[test]
fn a_rival_fit_stands_beside_the_best_with_all_its_values() {
    let mut data = sample::calibration(40);
    let alone = report::text(&report::calibration(&data), TerminalStyle::default());
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
    let all = report::text(&report::calibration(&data), TerminalStyle::default());
    assert!(all.contains(&said));
    let table = table::rivals(&data).expect("a table");
    assert_eq!(table.head, ["", "unit", "optimised", "rival 1"]);
    let [table::Row::Values(_, cells), ..] = &table.rows[..] else {
        unreachable!("{table:?}")
    };
    let shown = [best, 12.5 * best].map(report::number::significant);
    assert_eq!(cells[1..], shown);
    assert!(report::parameters(&data, TerminalStyle::default()).contains("rival 1"));
}
