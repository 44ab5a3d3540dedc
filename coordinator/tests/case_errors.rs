//! Whatever is wrong with a case ends in one error that names the file, the field, and a remedy.
use coordinator::case::{self, CaseError, Overrides};
use flate2::{Compression, read::GzDecoder, write::GzEncoder};
use std::{
    fs,
    io::{Read, Write},
    path::{Path, PathBuf},
};
use tempfile::TempDir;

fn shipped() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb")
}

/// A copy of the shipped case that may be spoilt.
struct Copy {
    folder: TempDir,
}

impl Copy {
    fn new() -> Self {
        let folder = TempDir::new().unwrap();
        for part in ["measured", "back_head"] {
            fs::create_dir(folder.path().join(part)).unwrap();
        }
        for file in [
            "case.toml",
            "measured/card_5rpm.csv",
            "measured/card_4rpm.csv",
            "measured/test_5rpm.csv.gz",
            "measured/test_5rpm.toml",
            "measured/test_4rpm.csv.gz",
            "measured/test_4rpm.toml",
            "back_head/back_head.msh",
            "back_head/back_head_modes.json",
            "back_head/back_head_influence.csv",
        ] {
            fs::copy(shipped().join(file), folder.path().join(file)).unwrap();
        }
        Self { folder }
    }

    fn path(&self, file: &str) -> PathBuf {
        self.folder.path().join(file)
    }

    /// Replaces a text that must be there.
    fn replace(&self, file: &str, from: &str, to: &str) {
        let text = fs::read_to_string(self.path(file)).unwrap();
        assert!(text.contains(from), "{file} has no `{from}`");
        fs::write(self.path(file), text.replacen(from, to, 1)).unwrap();
    }

    /// Rewrites the lines of a CSV file; line 1 is the header.
    fn lines(&self, file: &str, rewrite: impl Fn(usize, &str) -> Option<String>) {
        let path = self.path(file);
        let packed = file.ends_with(".gz");
        let mut text = String::new();
        if packed {
            let bytes = fs::read(&path).unwrap();
            GzDecoder::new(bytes.as_slice())
                .read_to_string(&mut text)
                .unwrap();
        } else {
            text = fs::read_to_string(&path).unwrap();
        }
        let numbered = text.lines().enumerate();
        let mut new: String = numbered
            .filter_map(|(at, line)| rewrite(at + 1, line))
            .collect::<Vec<_>>()
            .join("\n");
        new.push('\n');
        if packed {
            let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
            encoder.write_all(new.as_bytes()).unwrap();
            fs::write(path, encoder.finish().unwrap()).unwrap();
        } else {
            fs::write(path, new).unwrap();
        }
    }

    fn error(&self) -> CaseError {
        case::load(self.folder.path(), &Overrides::default()).unwrap_err()
    }
}

/// Replaces one cell of a line.
fn cell(line: &str, column: usize, value: &str) -> String {
    let mut cells: Vec<&str> = line.split(',').collect();
    cells[column] = value;
    cells.join(",")
}

/// Scales a column of all rows but the header.
fn scaled(at: usize, line: &str, columns: &[usize], factor: f64) -> Option<String> {
    let mut text = line.to_owned();
    if at > 1 {
        for &column in columns {
            let value: f64 = line.split(',').nth(column).unwrap().parse().unwrap();
            text = cell(&text, column, &format!("{}", value * factor));
        }
    }
    Some(text)
}

const TOML: &str = "case.toml";
const CARD: &str = "measured/card_5rpm.csv";
const RECORD: &str = "measured/test_5rpm.csv.gz";
const SHEET: &str = "measured/test_5rpm.toml";
const MODES: &str = "back_head/back_head_modes.json";
const INFLUENCE: &str = "back_head/back_head_influence.csv";
const MESH: &str = "back_head/back_head.msh";

/// A way to spoil a case: name, what is done, and what the message must contain.
type Spoilt = (&'static str, fn(&Copy), &'static [&'static str]);

fn assert_each_is_named(table: &[Spoilt]) {
    let mut wrong = Vec::new();
    for (name, spoil, expected) in table {
        let copy = Copy::new();
        spoil(&copy);
        let message = copy.error().to_string();
        println!("--- {name}\n{message}\n");
        let help = message.lines().last().unwrap_or_default();
        if help.len() < 15 || !help.starts_with("help: ") {
            wrong.push(format!("{name}: no help in\n{message}"));
        }
        for part in *expected {
            if !message.contains(part) {
                wrong.push(format!("{name}: no `{part}` in\n{message}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

#[test]
fn every_fault_of_the_case_file_is_named() {
    assert_each_is_named(&[
        (
            "syntax",
            |c| c.replace(TOML, "[rod]", "[rod"),
            &["case.toml", "[rod", "| "],
        ),
        (
            "unknown key",
            |c| c.replace(TOML, "mass_kg = 450.0", "mas_kg = 450.0"),
            &[
                "case.toml",
                "unknown field `mas_kg`",
                "mas_kg = 450.0",
                "did you mean `mass_kg`?",
            ],
        ),
        (
            "unit missing in a key",
            |c| c.replace(TOML, "inertia_kg_m2 = 2.4e4", "inertia = 2.4e4"),
            &["case.toml", "`inertia`", "did you mean `inertia_kg_m2`?"],
        ),
        (
            "unit missing in a gene",
            |c| c.replace(TOML, "upper = 3.14e12, unit = \"N/m\"", "upper = 3.14e12"),
            &["case.toml", "missing field `unit`", "N.m/deg"],
        ),
        (
            "unit unknown",
            |c| {
                c.replace(
                    TOML,
                    "upper = 3.14e12, unit = \"N/m\"",
                    "upper = 3.14e12, unit = \"N/mm\"",
                )
            },
            &["case.toml", "unknown variant `N/mm`", "did you mean `N/m`?"],
        ),
        (
            "unit of another quantity",
            |c| {
                c.replace(
                    TOML,
                    "upper = 1.10e6,  unit = \"N.m/deg\"",
                    "upper = 1.10e6, unit = \"N/m\"",
                )
            },
            &[
                "case.toml",
                "`genes.kb4.unit` = \"N/m\"",
                "allowed: N.m/rad or N.m/deg for kb4",
            ],
        ),
        (
            "missing key",
            |c| c.replace(TOML, "speed_rpm = 5.0", ""),
            &["case.toml", "missing field `speed_rpm`", "add `speed_rpm`"],
        ),
        (
            "text for a number",
            |c| c.replace(TOML, "mass_kg = 450.0", "mass_kg = \"450\""),
            &[
                "case.toml",
                "invalid type",
                "mass_kg = \"450\"",
                "numbers without quotes",
            ],
        ),
        (
            "NaN",
            |c| c.replace(TOML, "mass_kg = 450.0", "mass_kg = nan"),
            &[
                "case.toml",
                "`rod.mass_kg` = NaN",
                "allowed: 0.001 to 1e6 kg",
                "mass_kg = nan",
                "^^^",
            ],
        ),
        (
            "infinity",
            |c| c.replace(TOML, "inertia_kg_m2 = 385.0", "inertia_kg_m2 = inf"),
            &["case.toml", "`rod.inertia_kg_m2` = inf", "allowed: "],
        ),
        (
            "infinite gene",
            |c| c.replace(TOML, "upper = 3.14e12", "upper = inf"),
            &["case.toml", "`genes.kb1.upper` = inf", "allowed: above 0"],
        ),
        (
            "negative mass",
            |c| c.replace(TOML, "mass_kg = 175.0", "mass_kg = -175.0"),
            &[
                "case.toml",
                "`suspension.mass_kg` = -175",
                "allowed: 0.001 to 1e6 kg",
            ],
        ),
        (
            "zero radius",
            |c| c.replace(TOML, "radius_m = 1.900", "radius_m = 0.0"),
            &[
                "case.toml",
                "`back_head.radius_m` = 0",
                "allowed: 0.001 to 100 m",
            ],
        ),
        (
            "bounds exclude the recommended value",
            |c| c.replace(TOML, "recommended = 3.14e8", "recommended = 3.14e13"),
            &["case.toml", "`genes.kb1.recommended`", "exclude"],
        ),
        (
            "bounds exchanged",
            |c| {
                c.replace(
                    TOML,
                    "lower = 3.14e4, upper = 3.14e12",
                    "lower = 3.14e12, upper = 3.14e4",
                )
            },
            &["case.toml", "`genes.kb1.lower`", "below upper"],
        ),
        (
            "duplicate condition",
            |c| c.replace(TOML, "name = \"4rpm\"", "name = \"5rpm\""),
            &[
                "case.toml",
                "`conditions[1].name` = \"5rpm\"",
                "duplicate condition",
            ],
        ),
        (
            "back rope too short",
            |c| c.replace(TOML, "back_cylinders = 72", "back_cylinders = 50"),
            &[
                "case.toml",
                "`ropes.back_cylinders` = 50 (2.500 m of rope)",
                "allowed: ",
            ],
        ),
        (
            "back rope all on the head",
            |c| {
                c.replace(TOML, "back_cylinders = 72", "back_cylinders = 56");
                c.replace(TOML, "length_m = 2.876", "length_m = 3.676");
            },
            &[
                "case.toml",
                "`ropes.back_cylinders` = 56",
                "shorter than the path",
            ],
        ),
        (
            "front rope too short",
            |c| c.replace(TOML, "front_cylinders = 114", "front_cylinders = 80"),
            &[
                "case.toml",
                "`ropes.front_cylinders` = 80 (4.000 m of rope)",
                "shorter than the path",
            ],
        ),
        (
            "front anchor within the swing",
            |c| c.replace(TOML, "rope_anchor_deg = 36.6", "rope_anchor_deg = 20.0"),
            &[
                "case.toml",
                "`front_head.rope_anchor_deg` = 20",
                "above 31.8 deg",
            ],
        ),
        (
            "anchor outside the arc",
            |c| {
                c.replace(TOML, "rope_anchor_deg = 125.0", "rope_anchor_deg = 110.0");
                c.replace(TOML, "length_m = 2.876", "length_m = 3.373");
            },
            &[
                "case.toml",
                "`back_head.rope_anchor_deg` = 110",
                "118 to 220 deg",
            ],
        ),
        (
            "step that does not divide 360",
            |c| c.replace(TOML, "output_step_deg = 0.5", "output_step_deg = 0.7"),
            &["case.toml", "`run.output_step_deg` = 0.7", "divides 360"],
        ),
        (
            "more modes than there are",
            |c| c.replace(TOML, "modes = 6", "modes = 13"),
            &["case.toml", "`run.modes` = 13", "0 to 12"],
        ),
        (
            "objective without condition",
            |c| c.replace(TOML, "condition = \"5rpm\"", "condition = \"5 rpm\""),
            &[
                "case.toml",
                "`objective.condition` = \"5 rpm\"",
                "did you mean `5rpm`?",
            ],
        ),
        (
            "gauge twice",
            |c| c.replace(TOML, "{ gauge = 3,", "{ gauge = 1,"),
            &["case.toml", "`objective.gauges[1].gauge` = 1", "each once"],
        ),
        (
            "empty",
            |c| fs::write(c.path(TOML), "\n").unwrap(),
            &["case.toml", "empty"],
        ),
        (
            "absent",
            |c| fs::remove_file(c.path(TOML)).unwrap(),
            &["case.toml", "no such file", "horsehead case new"],
        ),
    ]);
}

#[test]
fn every_fault_of_a_load_card_is_named() {
    assert_each_is_named(&[
        (
            "absent",
            |c| fs::remove_file(c.path(CARD)).unwrap(),
            &["card_5rpm.csv", "no such file", "`5rpm`"],
        ),
        (
            "empty",
            |c| fs::write(c.path(CARD), "").unwrap(),
            &["card_5rpm.csv", "empty"],
        ),
        (
            "header only",
            |c| c.lines(CARD, |at, line| (at == 1).then(|| line.to_owned())),
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
                })
            },
            &[
                "card_5rpm.csv",
                "`polished_rod_load_n` is missing",
                "turn_deg, load_n",
            ],
        ),
        (
            "not from 0",
            |c| c.lines(CARD, |at, line| (at != 2).then(|| line.to_owned())),
            &[
                "card_5rpm.csv",
                "row 2",
                "`turn_deg`",
                "0.5",
                "counted from bottom dead centre",
            ],
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
                })
            },
            &[
                "card_5rpm.csv",
                "row 100",
                "`turn_deg`",
                "49.1",
                "equally spaced",
            ],
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
            &["card_5rpm.csv", "row 722", "360", "remove the last row"],
        ),
        (
            "not periodic",
            |c| {
                c.lines(CARD, |at, line| {
                    let load: Option<f64> =
                        line.split(',').nth(1).and_then(|load| load.parse().ok());
                    Some(load.map_or(line.into(), |load| {
                        cell(line, 1, &format!("{}", load + 30.0 * at as f64))
                    }))
                });
            },
            &["card_5rpm.csv", "row 721", "periodic"],
        ),
        (
            "kN",
            |c| c.lines(CARD, |at, line| scaled(at, line, &[1], 1e-3)),
            &["card_5rpm.csv", "`polished_rod_load_n`", "looks like kN"],
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
                })
            },
            &[
                "card_5rpm.csv",
                "row 7",
                "`polished_rod_load_n`",
                "48 kN",
                "plain number",
            ],
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
                })
            },
            &["card_5rpm.csv", "row 9", "-5", "cannot push"],
        ),
        (
            "short row",
            |c| {
                c.lines(CARD, |at, line| {
                    Some(if at == 9 { "3.5".into() } else { line.into() })
                })
            },
            &["card_5rpm.csv", "row 9", "1 cells", "2 cells"],
        ),
    ]);
}

#[test]
fn every_fault_of_a_record_is_named() {
    assert_each_is_named(&[
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
            "text",
            |c| {
                c.lines(RECORD, |at, line| {
                    Some(if at == 77 {
                        cell(line, 4, "overload")
                    } else {
                        line.into()
                    })
                })
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
                })
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
                })
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
                })
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
                })
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
                "row 3",
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
            &["test_5rpm.csv.gz", "3998", "samples_recorded = 5972"],
        ),
        (
            "sheet's speed contradicts the case",
            |c| {
                c.replace(
                    SHEET,
                    "strokes_per_minute = 5.0",
                    "strokes_per_minute = 4.0",
                )
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
            &["test_5rpm.csv.gz", "4.002 /min", "speed_rpm = 5"],
        ),
        (
            "less than a revolution",
            |c| {
                c.lines(RECORD, |at, line| (at < 900).then(|| line.to_owned()));
                c.replace(SHEET, "samples_recorded = 5972", "");
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
                c.replace(SHEET, "samples_recorded = 5972", "");
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
                })
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
    ]);
}

#[test]
fn every_fault_of_the_back_head_is_named() {
    assert_each_is_named(&[
        (
            "modes absent",
            |c| fs::remove_file(c.path(MODES)).unwrap(),
            &["back_head_modes.json", "no such file"],
        ),
        (
            "modes truncated",
            |c| {
                let bytes = fs::read(c.path(MODES)).unwrap();
                fs::write(c.path(MODES), &bytes[..bytes.len() / 2]).unwrap();
            },
            &["back_head_modes.json", "line 1"],
        ),
        (
            "modes ragged",
            |c| c.replace(MODES, "\"arc_deg\": [118.0, ", "\"arc_deg\": ["),
            &[
                "back_head_modes.json",
                "`radial[0]` = 103 values",
                "102 values",
                "ragged",
            ],
        ),
        (
            "mode missing",
            |c| {
                c.replace(
                    MODES,
                    "\"frequencies_hz\": [116.0122, ",
                    "\"frequencies_hz\": [",
                )
            },
            &[
                "back_head_modes.json",
                "`radial` = 12 rows",
                "11 rows",
                "ragged",
            ],
        ),
        (
            "modes not ascending",
            |c| c.replace(MODES, "[116.0122, 121.2575", "[121.2575, 116.0122"),
            &[
                "back_head_modes.json",
                "`frequencies_hz[1]` = 116.0122",
                "ascending",
            ],
        ),
        (
            "stations not ascending",
            |c| c.replace(MODES, "118.0, 119.0,", "119.0, 118.0,"),
            &["back_head_modes.json", "`arc_deg[1]` = 118", "ascending"],
        ),
        (
            "influence too short",
            |c| c.lines(INFLUENCE, |at, line| (at < 100).then(|| line.to_owned())),
            &[
                "back_head_influence.csv",
                "row 99",
                "`psi_deg`",
                "must cover the modes' arc, 118 to 220 deg",
            ],
        ),
        (
            "influence not ascending",
            |c| {
                c.lines(INFLUENCE, |at, line| {
                    Some(if at == 9 {
                        cell(line, 0, "10")
                    } else {
                        line.into()
                    })
                })
            },
            &["back_head_influence.csv", "row 9", "`psi_deg`", "ascending"],
        ),
        (
            "influence in Pa",
            |c| c.lines(INFLUENCE, |at, line| scaled(at, line, &[1, 2, 3], 1e6)),
            &[
                "back_head_influence.csv",
                "`normal_1_mpa_per_n`",
                "check the unit",
            ],
        ),
        (
            "mesh absent",
            |c| fs::remove_file(c.path(MESH)).unwrap(),
            &["back_head.msh", "no such file"],
        ),
        (
            "mesh of another format",
            |c| fs::write(c.path(MESH), "solid head\nfacet normal 0 0 1\n").unwrap(),
            &["back_head.msh", "line 1", "$MeshFormat", "MSH 4.1"],
        ),
        (
            "mesh of another version",
            |c| c.replace(MESH, "4.1 0 8", "2.2 0 8"),
            &["back_head.msh", "line 2", "`2.2 0 8`", "4.1"],
        ),
        (
            "binary mesh",
            |c| c.replace(MESH, "4.1 0 8", "4.1 1 8"),
            &["back_head.msh", "line 2", "ASCII"],
        ),
        (
            "group missing",
            |c| c.replace(MESH, "2 3 \"pin_b\"", "2 3 \"pinb\""),
            &["back_head.msh", "`pin_b` is missing", "pinb"],
        ),
        (
            "mesh cut off",
            |c| {
                let text = fs::read_to_string(c.path(MESH)).unwrap();
                fs::write(c.path(MESH), &text[..text.len() / 2]).unwrap();
            },
            &["back_head.msh", "line ", "MSH 4.1"],
        ),
        (
            "mesh with text",
            |c| c.replace(MESH, "-2.049794994", "-2.04x"),
            &["back_head.msh", "line 23436", "numbers"],
        ),
        (
            "mesh in millimetres",
            |c| c.replace(MESH, "-2.049794994", "-2049.794994"),
            &["back_head.msh", "line 23436", "not in metres"],
        ),
        (
            "element inside out",
            |c| {
                c.replace(
                    MESH,
                    "1 336 333 331 334 3105 3040 2989 3056",
                    "1 3105 3040 2989 3056 336 333 331 334",
                );
            },
            &["back_head.msh", "element 1 of group `steel`", "inside out"],
        ),
        (
            "mass contradicts the modes",
            |c| {
                c.replace(
                    TOML,
                    "density_kg_m3 = 7850.0                                 #",
                    "density_kg_m3 = 7000.0 #",
                )
            },
            &[
                "back_head.msh",
                "785",
                "mass_kg = 881.016",
                "flexible_head.density_kg_m3",
            ],
        ),
    ]);
}

#[test]
fn another_test_of_the_same_machine_replaces_the_records() {
    let copy = Copy::new();
    let other = copy.path("other");
    fs::create_dir(&other).unwrap();
    let overrides = Overrides {
        measured: Some(other.clone()),
    };
    let load = || case::load(copy.folder.path(), &overrides);
    let message = load().unwrap_err().to_string();
    assert!(
        message.contains("other/card_5rpm.csv: no such file"),
        "{message}"
    );
    for file in [
        "card_5rpm.csv",
        "test_5rpm.csv.gz",
        "test_5rpm.toml",
        "card_4rpm.csv",
        "test_4rpm.csv.gz",
    ] {
        fs::copy(copy.path(&format!("measured/{file}")), other.join(file)).unwrap();
    }
    let message = load().unwrap_err().to_string();
    assert!(
        message.contains("other/test_4rpm.toml: no such file"),
        "{message}"
    );
    fs::copy(
        copy.path("measured/test_4rpm.toml"),
        other.join("test_4rpm.toml"),
    )
    .unwrap();
    copy.lines("other/test_5rpm.csv.gz", |at, line| {
        scaled(at, line, &[2], 2.0)
    });
    let plain = case::load(copy.folder.path(), &Overrides::default()).unwrap();
    let replaced = load().unwrap();
    let first = |case: &protocol::case::Case| {
        case.conditions[0].record.as_ref().unwrap().gauges[0].mean_mpa[7]
    };
    assert!((first(&replaced) - 2.0 * first(&plain)).abs() < 1e-9);
    assert_eq!(replaced.conditions[1], plain.conditions[1]);
}
