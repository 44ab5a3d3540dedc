//! Faults of a load card that must be reported.
use super::spoilt::{CARD, Spoilt, cell, scaled};
use std::fs;

pub(super) const FAULTS: &[Spoilt] = &[
    (
        "absent",
        |c| fs::remove_file(c.path(CARD)).unwrap(),
        "Missing",
        &["card_5rpm.csv", "`5rpm`"],
    ),
    (
        "empty",
        |c| fs::write(c.path(CARD), "").unwrap(),
        "Damaged",
        &["card_5rpm.csv", "empty"],
    ),
    (
        "header only",
        |c| c.lines(CARD, |at, line| (at == 1).then(|| line.to_owned())),
        "Damaged",
        &["card_5rpm.csv", "no rows"],
    ),
    (
        "column missing",
        |c| {
            c.lines(CARD, |at, line| {
                Some(if at == 1 {
                    "turn_deg,load_n".into()
                } else {
                    line.into()
                })
            });
        },
        "Column",
        &["card_5rpm.csv", "`polished_rod_load_n`", "turn_deg, load_n"],
    ),
    (
        "not from 0",
        |c| c.lines(CARD, |at, line| (at != 2).then(|| line.to_owned())),
        "Cell",
        &["card_5rpm.csv", "row 2", "`turn_deg`", "0.5"],
    ),
    (
        "uneven",
        |c| {
            c.lines(CARD, |at, line| {
                Some(if at == 100 {
                    cell(line, 0, "49.1")
                } else {
                    line.into()
                })
            });
        },
        "Cell",
        &["card_5rpm.csv", "row 100", "`turn_deg`", "49.1"],
    ),
    (
        "closed at 360",
        |c| {
            c.lines(CARD, |at, line| {
                Some(if at == 721 {
                    format!("{line}\n360.0,48318")
                } else {
                    line.into()
                })
            });
        },
        "Cell",
        &["card_5rpm.csv", "row 722", "360"],
    ),
    (
        "not periodic",
        |c| {
            c.lines(CARD, |at, line| {
                let load: Option<f64> = line.split(',').nth(1).and_then(|load| load.parse().ok());
                Some(load.map_or(line.into(), |load| {
                    cell(line, 1, &format!("{}", load + 30.0 * at as f64))
                }))
            });
        },
        "Cell",
        &["card_5rpm.csv", "row 721", "periodic"],
    ),
    (
        "kN",
        |c| c.lines(CARD, |at, line| scaled(at, line, &[1], 1e-3)),
        "Cell",
        &["card_5rpm.csv", "`polished_rod_load_n`"],
    ),
    (
        "text",
        |c| {
            c.lines(CARD, |at, line| {
                Some(if at == 7 {
                    cell(line, 1, "48 kN")
                } else {
                    line.into()
                })
            });
        },
        "Cell",
        &["card_5rpm.csv", "row 7", "`polished_rod_load_n`", "48 kN"],
    ),
    (
        "negative",
        |c| {
            c.lines(CARD, |at, line| {
                Some(if at == 9 {
                    cell(line, 1, "-5")
                } else {
                    line.into()
                })
            });
        },
        "Cell",
        &["card_5rpm.csv", "row 9", "-5"],
    ),
    (
        "short row",
        |c| {
            c.lines(CARD, |at, line| {
                Some(if at == 9 { "3.5".into() } else { line.into() })
            });
        },
        "Cell",
        &["card_5rpm.csv", "row 9", "1 cells", "2 cells"],
    ),
];
