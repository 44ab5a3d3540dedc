//! Faults of a gauge record and its data sheet that must be reported.
use super::spoilt::{RECORD, SHEET, Spoilt, TOML, cell, scaled};
use std::fs;

pub(super) const FAULTS: &[Spoilt] = &[
    (
        "absent",
        |c| fs::remove_file(c.path(RECORD)).unwrap(),
        &["test_5rpm.csv.gz", "no such file"],
    ),
    (
        "sheet absent",
        |c| fs::remove_file(c.path(SHEET)).unwrap(),
        &["test_5rpm.toml", "data sheet"],
    ),
    (
        "empty",
        |c| fs::write(c.path(RECORD), "").unwrap(),
        &["test_5rpm.csv.gz", "empty"],
    ),
    (
        "truncated",
        |c| {
            let bytes = fs::read(c.path(RECORD)).unwrap();
            fs::write(c.path(RECORD), &bytes[..bytes.len() / 2]).unwrap();
        },
        &["test_5rpm.csv.gz", "truncated", "gzip -t"],
    ),
    (
        "not gzip",
        |c| fs::write(c.path(RECORD), "time_s,crank_deg\n").unwrap(),
        &["test_5rpm.csv.gz", "not gzip", "name it .csv"],
    ),
    (
        "flipped bit",
        |c| {
            let mut bytes = fs::read(c.path(RECORD)).unwrap();
            let middle = bytes.len() - 6;
            bytes[middle] ^= 4;
            fs::write(c.path(RECORD), bytes).unwrap();
        },
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
        &[
            "test_5rpm.toml",
            "`crank.sense` = \"the crank turns clockwise\"",
            "\"clockwise\" or \"counter_clockwise\"",
            "seen with the well on the right",
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
        &[
            "test_5rpm.toml",
            "`crank.sense` = \"Counter-Clockwise\"",
            "\"clockwise\" or \"counter_clockwise\"",
        ],
    ),
    (
        "tolerance misspelt",
        |c| c.replace(SHEET, "gauge_factor = 0.005", "gauge_factr = 0.005"),
        &[
            "test_5rpm.toml",
            "unknown field `gauge_factr`",
            "gauge_factr = 0.005",
            "did you mean `gauge_factor`?",
        ],
    ),
    (
        "tolerance of an instrument that there is not",
        |c| {
            c.replace(SHEET, "gauge_factor = 0.005", "thermometer_kelvin = 0.005");
        },
        &[
            "test_5rpm.toml",
            "unknown field `thermometer_kelvin`",
            "remove it; known here: gauge_factor, index_deg",
        ],
    ),
    (
        "negative tolerance",
        |c| c.replace(SHEET, "load_cell = 0.003", "load_cell = -0.003"),
        &[
            "test_5rpm.toml",
            "`tolerance.load_cell` = -0.003",
            "a standard deviation: a finite number, 0 or greater",
        ],
    ),
    (
        "infinite tolerance",
        |c| c.replace(SHEET, "balance_nm = 200 ", "balance_nm = inf "),
        &["test_5rpm.toml", "`tolerance.balance_nm` = inf", "finite"],
    ),
    (
        "tolerance in words",
        |c| c.replace(SHEET, "torque = 0.005", "torque = \"good\""),
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
        &[
            "test_5rpm.csv.gz",
            "`stress_3_mpa` is missing",
            "stress3_mpa",
        ],
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
        &[
            "case.toml: `objective.gauges[0].gauge` = 1",
            "a channel that the record has: gauge_2, gauge_3, gauge_4",
            "name its column stress_1_mpa (not used there: sigma_a)",
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
        &[
            "case.toml: `objective.torque_weight_mpa2_per_kn2_m2` = 0.5",
            "a channel that the record has: gauge_1, gauge_2, gauge_3, gauge_4, position",
            "name its column crank_torque_nm",
            "or remove the key",
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
        &[
            "test_5rpm.csv.gz",
            "row 9",
            "a decimal comma cuts a cell in two",
        ],
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
        &[
            "test_5rpm.csv.gz",
            "row 78",
            "`stress_1_mpa`",
            "NaN",
            "lost samples are allowed",
        ],
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
        &[
            "test_5rpm.csv.gz",
            "row 78",
            "`stress_1_mpa`",
            "empty cells",
        ],
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
        &["test_5rpm.csv.gz", "row 501", "`time_s`", "same time again"],
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
        &["test_5rpm.csv.gz", "row 501", "`time_s`", "backwards"],
    ),
    (
        "time in milliseconds",
        |c| c.lines(RECORD, |at, line| scaled(at, line, &[0], 1e3)),
        &["test_5rpm.csv.gz", "speed", "5"],
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
        &[
            "test_5rpm.csv.gz",
            "row 4",
            "`crank_deg`",
            "reverse its sense",
        ],
    ),
    (
        "crank in radians",
        |c| c.lines(RECORD, |at, line| scaled(at, line, &[1], 0.0174533)),
        &["test_5rpm.csv.gz", "`crank_deg`"],
    ),
    (
        "sampling contradicts the sheet",
        |c| c.replace(SHEET, "sample_rate_hz = 100.0", "sample_rate_hz = 200.0"),
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
        &["test_5rpm.csv.gz", "4.001 /min", "speed_rpm = 5"],
    ),
    (
        "less than a revolution",
        |c| {
            c.lines(RECORD, |at, line| (at < 900).then(|| line.to_owned()));
            c.replace(SHEET, "samples_recorded = 5970", "");
        },
        &["test_5rpm.csv.gz", "no whole revolution", "index pulse"],
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
        &[
            "test_5rpm.csv.gz",
            "`crank_deg`",
            "near 100",
            "on every cycle",
        ],
    ),
    (
        "Pa",
        |c| c.lines(RECORD, |at, line| scaled(at, line, &[2, 3, 4, 5], 1e6)),
        &[
            "test_5rpm.csv.gz",
            "`stress_1_mpa`",
            "looks like Pa",
            "2000 MPa",
        ],
    ),
    (
        "GPa",
        |c| c.lines(RECORD, |at, line| scaled(at, line, &[2, 3, 4, 5], 1e-3)),
        &["test_5rpm.csv.gz", "`stress_1_mpa`", "looks like GPa"],
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
        &["test_5rpm.csv.gz", "row 60", "`stress_2_mpa`", "spike"],
    ),
    (
        "dead gauge",
        |c| c.lines(RECORD, |at, line| scaled(at, line, &[5], 0.0)),
        &["test_5rpm.csv.gz", "`stress_4_mpa`", "dead"],
    ),
    (
        "sheet's unit",
        |c| c.replace(SHEET, "unit = \"MPa\"", "unit = \"Pa\""),
        &["test_5rpm.toml", "`gauges.unit` = \"Pa\"", "\"MPa\""],
    ),
    (
        "sheet malformed",
        |c| c.replace(SHEET, "sample_rate_hz = 100.0", "sample_rate_hz = fast"),
        &["test_5rpm.toml", "sample_rate_hz = fast"],
    ),
];
