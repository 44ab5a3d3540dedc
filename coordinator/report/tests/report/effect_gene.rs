//! Tests of genes that are parameters of effects, in tables, figures and sentences.
use crate::sample;
use protocol::case::{EffectSetting, Scale, Unknown};
use report::document::TerminalStyle;
use report::table;

#[test]
fn a_parameter_of_an_effect_is_shown_beside_the_coefficients() {
    let mut calibration = sample::calibration(200);
    let case = &mut calibration.case;
    case.effects = vec![EffectSetting::new("load_offset", &[("force", 0.0)])];
    let bounds = [-900.0, 2100.0];
    let force = Unknown::new("load_offset.force", "N", Scale::Linear, 0.0, bounds);
    case.unknowns.push(Unknown {
        is_effect: true,
        ..force
    });
    calibration.recommended.genes.push(0.0);
    calibration.optimised.genes.push(-899.0);
    for (number, point) in (0..).zip(&mut calibration.history) {
        point.genes.push(-899.0 + f64::from(number));
    }
    let text = table::text(&table::table_3(&calibration), TerminalStyle::default());
    let after = text.split("Effects").nth(1).expect("a group of its own");
    let row = after
        .lines()
        .find(|line| line.contains("load_offset.force"));
    let row = row.expect("a row of its own");
    assert!(row.contains(" N ") && row.contains("−899 *"), "{row}");
    assert!(
        text.contains("load_offset.force at its lower bound −900\u{a0}N"),
        "{text}"
    );
    // in its panel the individuals are spread evenly
    let figure = report::genes(&calibration);
    assert!(figure.svg.contains("load_offset [N]"));
    assert!(figure.caption.contains("linear ones"), "{}", figure.caption);
    let plain = report::genes(&sample::calibration(200));
    assert!(!plain.caption.contains("linear ones"));
    let dots = |svg: &str| svg.matches("<circle").count();
    // all individuals once more, and the best
    let complete = calibration.history.iter().filter(|p| p.complete).count();
    assert_eq!(dots(&figure.svg), dots(&plain.svg) + complete + 1);
    let page = crate::page_of(&calibration);
    assert!(page.contains("load_offset.force ended at its lower bound"));
}
