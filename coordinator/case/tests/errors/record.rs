//! Faults of a gauge record and its data sheet that must be reported.
use super::spoilt::{RECORD, SHEET, Spoilt, TOML, cell, scaled};
use std::fs;

pub(super) const FAULTS: &[Spoilt] = &[
    (
        "absent",
        |c| fs::remove_file(c.path(RECORD)).unwrap(),
        "Missing",
        &["test_5rpm.csv.gz"],
    ),
    (
        "sheet absent",
        |c| fs::remove_file(c.path(SHEET)).unwrap(),
        "Missing",
        &["test_5rpm.toml"],
    ),
    (
        "empty",
        |c| fs::write(c.path(RECORD), "").unwrap(),
        "Damaged",
        &["test_5rpm.csv.gz", "empty"],
    ),
    (
        "truncated",
        |c| {
            let bytes = fs::read(c.path(RECORD)).unwrap();
            fs::write(c.path(RECORD), &bytes[..bytes.len() / 2]).unwrap();
        },
        "Damaged",
        &["test_5rpm.csv.gz", "truncated", "gzip -t"],
    ),
    (
        "not gzip",
        |c| fs::write(c.path(RECORD), "time_s,crank_deg\n").unwrap(),
        "Damaged",
        &["test_5rpm.csv.gz"],
    ),
    (
        "flipped bit",
        |c| {
            let mut bytes = fs::read(c.path(RECORD)).unwrap();
            let middle = bytes.len() - 6;
            bytes[middle] ^= 4;
            fs::write(c.path(RECORD), bytes).unwrap();
        },
        "Damaged",
        &["test_5rpm.csv.gz", "damaged"],
    ),
    (
        "crank turning the other way",
        |c| {
            c.replace(
                SHEET,
                "sense = \"clockwise\"",
                "sense = \"counter_clockwise\"",
            );
        },
        "Contradiction",
        &[
            "test_5rpm.toml",
            "`crank.sense` is counter_clockwise",
            "crank.sense = \"clockwise\"",
        ],
    ),
    (
        "sense in prose",
        |c| {
            c.replace(
                SHEET,
                "sense = \"clockwise\"",
                "sense = \"the crank turns clockwise\"",
            );
        },
        "Field",
        &[
            "test_5rpm.toml",
            "`crank.sense` = \"the crank turns clockwise\"",
            "counter_clockwise",
        ],
    ),
    (
        "sense of the crank in capitals",
        |c| {
            c.replace(
                SHEET,
                "sense = \"clockwise\"",
                "sense = \"Counter-Clockwise\"",
            );
        },
        "Field",
        &[
            "test_5rpm.toml",
            "`crank.sense` = \"Counter-Clockwise\"",
            "counter_clockwise",
        ],
    ),
    (
        "tolerance misspelt",
        |c| c.replace(SHEET, "gauge_factor = 0.005", "gauge_factr = 0.005"),
        "Toml",
        &[
            "test_5rpm.toml",
            "`gauge_factr`",
            "gauge_factr = 0.005",
            "`gauge_factor`",
        ],
    ),
    (
        "tolerance of an instrument that there is not",
        |c| {
            c.replace(SHEET, "gauge_factor = 0.005", "thermometer_kelvin = 0.005");
        },
        "Toml",
        &[
            "test_5rpm.toml",
            "`thermometer_kelvin`",
            "gauge_factor",
            "index_deg",
        ],
    ),
    (
        "negative tolerance",
        |c| c.replace(SHEET, "load_cell = 0.003", "load_cell = -0.003"),
        "Field",
        &[
            "test_5rpm.toml",
            "`tolerance.load_cell` = -0.003",
            "a standard deviation: a finite number, 0 or greater",
        ],
    ),
    (
        "infinite tolerance",
        |c| c.replace(SHEET, "balance_nm = 200 ", "balance_nm = inf "),
        "Field",
        &["test_5rpm.toml", "`tolerance.balance_nm` = inf", "finite"],
    ),
    (
        "tolerance in words",
        |c| c.replace(SHEET, "torque = 0.005", "torque = \"good\""),
        "Toml",
        &["test_5rpm.toml", "torque = \"good\"", "expected a number"],
    ),
    (
        "column missing",
        |c| {
            c.lines(RECORD, |at, line| {
                Some(if at == 1 {
                    line.replace("stress_3_mpa", "stress3_mpa")
                } else {
                    line.into()
                })
            });
        },
        "Column",
        &["test_5rpm.csv.gz", "`stress_3_mpa`", "stress3_mpa"],
    ),
    (
        "column of the objective called otherwise",
        |c| {
            c.lines(RECORD, |at, line| {
                Some(if at == 1 {
                    line.replace("stress_1_mpa", "sigma_a")
                } else {
                    line.into()
                })
            });
        },
        "Field",
        &[
            "case.toml: `objective.gauges[0].gauge` = 1",
            "gauge_2",
            "gauge_3",
            "gauge_4",
            "stress_1_mpa",
            "sigma_a",
            "optional = true",
        ],
    ),
    (
        "torque of the objective not recorded",
        |c| {
            c.replace(
                TOML,
                "offset = \"free\"",
                "torque_weight_mpa2_per_kn2_m2 = 0.5\noffset = \"free\"",
            );
            c.lines(RECORD, |at, line| {
                Some(if at == 1 {
                    line.replace("crank_torque_nm", "moment")
                } else {
                    line.into()
                })
            });
        },
        "Field",
        &[
            "case.toml: `objective.torque_weight_mpa2_per_kn2_m2` = 0.5",
            "gauge_1",
            "gauge_2",
            "gauge_3",
            "gauge_4",
            "crank_torque_nm",
        ],
    ),
    (
        "weight of the position below zero",
        |c| {
            c.replace(
                TOML,
                "offset = \"free\"",
                "position_weight_mpa2_per_m2 = -1.0\noffset = \"free\"",
            );
        },
        "Field",
        &[
            "case.toml: `objective.position_weight_mpa2_per_m2` = -1",
            "above 0",
        ],
    ),
    (
        "decimal commas between commas",
        |c| {
            c.lines(RECORD, |at, line| {
                Some(if at == 9 {
                    line.replacen('.', ",", 2)
                } else {
                    line.into()
                })
            });
        },
        "Cell",
        &["test_5rpm.csv.gz", "row 9"],
    ),
    (
        "text",
        |c| {
            c.lines(RECORD, |at, line| {
                Some(if at == 77 {
                    cell(line, 4, "overload")
                } else {
                    line.into()
                })
            });
        },
        "Cell",
        &["test_5rpm.csv.gz", "row 77", "`stress_3_mpa`", "overload"],
    ),
    (
        "NaN",
        |c| {
            c.lines(RECORD, |at, line| {
                Some(if at == 78 {
                    cell(line, 2, "NaN")
                } else {
                    line.into()
                })
            });
        },
        "Cell",
        &["test_5rpm.csv.gz", "row 78", "`stress_1_mpa`", "NaN"],
    ),
    (
        "empty cell",
        |c| {
            c.lines(RECORD, |at, line| {
                Some(if at == 78 {
                    cell(line, 2, "")
                } else {
                    line.into()
                })
            });
        },
        "Cell",
        &["test_5rpm.csv.gz", "row 78", "`stress_1_mpa`"],
    ),
    (
        "duplicated time",
        |c| {
            c.lines(RECORD, |at, line| {
                Some(if at == 500 {
                    format!("{line}\n{line}")
                } else {
                    line.into()
                })
            });
        },
        "Cell",
        &["test_5rpm.csv.gz", "row 501", "`time_s`"],
    ),
    (
        "time backwards",
        |c| {
            c.lines(RECORD, |at, line| {
                Some(if at == 501 {
                    cell(line, 0, "1.00")
                } else {
                    line.into()
                })
            });
        },
        "Cell",
        &["test_5rpm.csv.gz", "row 501", "`time_s`", "backwards"],
    ),
    (
        "time in milliseconds",
        |c| c.lines(RECORD, |at, line| scaled(at, line, &[0], 1e3)),
        "Contradiction",
        &["test_5rpm.csv.gz", "speed"],
    ),
    (
        "crank reversed",
        |c| {
            c.lines(RECORD, |at, line| {
                let angle: Option<f64> =
                    line.split(',').nth(1).and_then(|angle| angle.parse().ok());
                Some(angle.filter(|_| at > 1).map_or(line.into(), |angle| {
                    cell(line, 1, &format!("{:.1}", 360.0 - angle))
                }))
            });
        },
        "Cell",
        &["test_5rpm.csv.gz", "row 4", "`crank_deg`"],
    ),
    (
        "crank in radians",
        |c| c.lines(RECORD, |at, line| scaled(at, line, &[1], 0.0174533)),
        "Cell",
        &["test_5rpm.csv.gz", "`crank_deg`"],
    ),
    (
        "sampling contradicts the sheet",
        |c| c.replace(SHEET, "sample_rate_hz = 100.0", "sample_rate_hz = 200.0"),
        "Contradiction",
        &[
            "test_5rpm.csv.gz",
            "100.00 Hz",
            "test_5rpm.toml: sample_rate_hz = 200",
            "time_s",
        ],
    ),
    (
        "rows contradict the sheet",
        |c| c.lines(RECORD, |at, line| (at < 4000).then(|| line.to_owned())),
        "Contradiction",
        &["test_5rpm.csv.gz", "3998", "samples_recorded = 5970"],
    ),
    (
        "sheet's speed contradicts the case",
        |c| {
            c.replace(
                SHEET,
                "strokes_per_minute = 5.0",
                "strokes_per_minute = 4.0",
            );
        },
        "Contradiction",
        &[
            "test_5rpm.toml",
            "`strokes_per_minute`",
            "4",
            "speed_rpm = 5",
        ],
    ),
    (
        "record's speed contradicts the case",
        |c| {
            fs::copy(c.path("measured/test_4rpm.csv.gz"), c.path(RECORD)).unwrap();
        },
        "Contradiction",
        &["test_5rpm.csv.gz", "4.001 /min", "speed_rpm = 5"],
    ),
    (
        "less than a revolution",
        |c| {
            c.lines(RECORD, |at, line| (at < 900).then(|| line.to_owned()));
            c.replace(SHEET, "samples_recorded = 5970", "");
        },
        "Damaged",
        &["test_5rpm.csv.gz"],
    ),
    (
        "gap on every cycle",
        |c| {
            c.lines(RECORD, |_, line| {
                let angle: Option<f64> =
                    line.split(',').nth(1).and_then(|angle| angle.parse().ok());
                angle
                    .is_none_or(|angle| !(100.0..106.0).contains(&angle))
                    .then(|| line.to_owned())
            });
            c.replace(SHEET, "samples_recorded = 5970", "");
        },
        "Damaged",
        &["test_5rpm.csv.gz", "`crank_deg`", "near 100"],
    ),
    (
        "Pa",
        |c| c.lines(RECORD, |at, line| scaled(at, line, &[2, 3, 4, 5], 1e6)),
        "Cell",
        &["test_5rpm.csv.gz", "`stress_1_mpa`", "2000 MPa"],
    ),
    (
        "GPa",
        |c| c.lines(RECORD, |at, line| scaled(at, line, &[2, 3, 4, 5], 1e-3)),
        "Cell",
        &["test_5rpm.csv.gz", "`stress_1_mpa`"],
    ),
    (
        "spike",
        |c| {
            c.lines(RECORD, |at, line| {
                Some(if at == 60 {
                    cell(line, 3, "99999")
                } else {
                    line.into()
                })
            });
        },
        "Cell",
        &["test_5rpm.csv.gz", "row 60", "`stress_2_mpa`", "spike"],
    ),
    (
        "dead gauge",
        |c| c.lines(RECORD, |at, line| scaled(at, line, &[5], 0.0)),
        "Cell",
        &["test_5rpm.csv.gz", "`stress_4_mpa`", "dead"],
    ),
    (
        "sheet's unit",
        |c| c.replace(SHEET, "unit = \"MPa\"", "unit = \"Pa\""),
        "Field",
        &["test_5rpm.toml", "`gauges.unit` = \"Pa\"", "\"MPa\""],
    ),
    (
        "sheet malformed",
        |c| c.replace(SHEET, "sample_rate_hz = 100.0", "sample_rate_hz = fast"),
        "Toml",
        &["test_5rpm.toml", "sample_rate_hz = fast"],
    ),
];
