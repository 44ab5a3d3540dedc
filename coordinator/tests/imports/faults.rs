//! Faults of raw files and mappings, each with the text that names it.
use crate::folder::ImportFolder;

/// One fault: its name, the raw file, the change of its lines, the change of the proposed mapping (from, to),
/// and texts that the output must contain.
type Fault = (
    &'static str,
    &'static str,
    fn(&mut Vec<String>),
    (&'static str, &'static str),
    &'static [&'static str],
);

/// First line of data of the file with a crank column, counted from 0.
const FIRST: usize = 7;

/// First line of data of the file with an index pulse, counted from 0.
const PULSES: usize = 16;

/// Replaces a cell of all rows from a line on.
fn cells(
    lines: &mut [String],
    first: usize,
    separator: char,
    change: impl Fn(usize, &mut Vec<String>),
) {
    let last = lines.len();
    for (row, line) in lines.iter_mut().enumerate().take(last).skip(first) {
        if line.starts_with("Ende") {
            continue;
        }
        let mut cells: Vec<String> = line.split(separator).map(str::to_owned).collect();
        change(row, &mut cells);
        *line = cells.join(&separator.to_string());
    }
}

const NOTHING: (&str, &str) = ("files = ", "files = ");

const FAULTS: &[Fault] = &[
    (
        "no pulse",
        "strain_4rpm",
        |lines| {
            cells(lines, PULSES, ',', |_, cells| {
                cells[7] = String::from("+    0.010");
            });
        },
        ("level = 0.01", "level = 2.5"),
        &[
            "row 17, column `CH5 index`",
            "with 0 pulses at the level 2.5",
            "angle.level",
        ],
    ),
    (
        "two pulses a turn",
        "strain_4rpm",
        |lines| {
            let pulses: Vec<String> = lines[PULSES..].to_vec();
            let of = |row: usize| {
                pulses[row % pulses.len()]
                    .split(',')
                    .nth(7)
                    .unwrap()
                    .to_owned()
            };
            cells(lines, PULSES, ',', |row, cells| {
                let later = of(row - PULSES + 750);
                if later
                    .trim_start_matches('+')
                    .trim()
                    .parse::<f64>()
                    .unwrap_or_default()
                    > 1.0
                {
                    cells[7] = later;
                }
            });
        },
        NOTHING,
        &[
            "2 a turn of 15.00 s by the case",
            "one pulse a turn",
            "column `CH5 index`",
        ],
    ),
    (
        "a clock that was set back",
        "strain_5rpm",
        |lines| {
            cells(lines, FIRST, ';', |row, cells| {
                if row > 3000 {
                    let time: f64 = cells[0].replace(',', ".").parse().unwrap();
                    cells[0] = format!("{:.2}", time - 3.0).replace('.', ",");
                }
            });
        },
        NOTHING,
        &[
            "row 3002, column `Zeit [s]`: 2.990 s before the row above",
            "the clock was set",
        ],
    ),
    (
        "a time that repeats",
        "strain_5rpm",
        |lines| lines.insert(2000, lines[2000].clone()),
        NOTHING,
        &["row 2002, column `Zeit [s]`: the same time as the row above"],
    ),
    (
        "a clock of whole seconds",
        "strain_5rpm",
        |lines| {
            cells(lines, FIRST, ';', |_, cells| {
                cells[0] = cells[0].split(',').next().unwrap().to_owned();
            });
        },
        NOTHING,
        &[
            "like most rows",
            "state `rate_hz` alone",
            "about 100 rows a second",
        ],
    ),
    (
        "a saturated gauge",
        "strain_5rpm",
        |lines| {
            cells(lines, FIRST, ';', |_, cells| {
                let strain: f64 = cells[4].parse().unwrap();
                cells[4] = format!("{}", strain.min(250.0));
            });
        },
        NOTHING,
        &[
            "column `DMS3 [\u{b5}m/m]`: 250, as in ",
            "the limit of its amplifier",
        ],
    ),
    (
        "a dead gauge",
        "strain_5rpm",
        |lines| cells(lines, FIRST, ';', |_, cells| cells[3] = String::from("0")),
        NOTHING,
        &[
            "row 8, column `DMS2 [\u{b5}m/m]`: 0 in every row",
            "dead or not connected",
        ],
    ),
    (
        "contradicting units",
        "strain_5rpm",
        |_| {},
        (
            "unit = \"um/m\", young_gpa = 206.0",
            "unit = \"MPa\", young_gpa = 206.0",
        ),
        &[
            "`curves.stress_1_mpa.unit` = \"MPa\"",
            "the two contradict each other",
        ],
    ),
    (
        "strain without Young's modulus",
        "strain_5rpm",
        |_| {},
        ("unit = \"um/m\", young_gpa = 206.0", "unit = \"um/m\""),
        &[
            "`curves.stress_1_mpa.unit` = \"um/m\"",
            "`young_gpa` beside a unit of strain",
        ],
    ),
    (
        "a unit of another quantity",
        "strain_5rpm",
        |_| {},
        ("unit = \"mm\"", "unit = \"kN\""),
        &[
            "`curves.polished_rod_position_m.unit` = \"kN\"",
            "a unit of length",
        ],
    ),
    (
        "a file that ends in the middle of a row",
        "strain_5rpm",
        |lines| {
            lines.truncate(4000);
            lines[3999] = lines[3999].split(';').take(3).collect::<Vec<_>>().join(";");
        },
        NOTHING,
        &[
            "row 4000",
            "a row of 3 cells",
            "cut off",
            "footer_lines = 1",
        ],
    ),
    (
        "a word among the numbers",
        "strain_5rpm",
        |lines| {
            cells(lines, FIRST, ';', |row, cells| {
                if row == 2500 {
                    cells[5] = String::from("ERR");
                }
            });
        },
        ("# no numbers: \"ERR\" (line 2501)", "# no numbers"),
        &[
            "row 2501, column `DMS4 [\u{b5}m/m]`: `ERR`",
            "table.missing",
        ],
    ),
    (
        "an angle that runs backwards",
        "strain_5rpm",
        |_| {},
        ("direction = \"increasing\"", "direction = \"decreasing\""),
        &["column `Kurbelwinkel [\u{b0}]`", "angle.direction"],
    ),
    (
        "a column that does not exist",
        "strain_5rpm",
        |_| {},
        (
            "column = \"DMS3 [\u{b5}m/m]\"",
            "column = \"DMS 3 [\u{b5}m/m]\"",
        ),
        &[
            "column `DMS 3 [\u{b5}m/m]` is missing",
            "did you mean `DMS3 [\u{b5}m/m]`?",
        ],
    ),
    (
        "another speed",
        "strain_5rpm",
        |lines| {
            cells(lines, FIRST, ';', |_, cells| {
                let time: f64 = cells[0].replace(',', ".").parse().unwrap();
                cells[0] = format!("{:.3}", time * 1.25).replace('.', ",");
            });
        },
        NOTHING,
        &["4.000 /min", "speed_rpm = 5"],
    ),
    (
        "a row that lacks a cell in the middle of the file",
        "strain_5rpm",
        |lines| lines[2000] = lines[2000].replacen(';', "", 1),
        NOTHING,
        &[
            "row 2001",
            "a row of 7 cells",
            "8 cells, as in the first row",
        ],
    ),
    (
        "a decimal comma among points",
        "strain_5rpm",
        |lines| {
            cells(lines, FIRST, ';', |_, cells| {
                cells[0] = cells[0].replace(',', ".");
                cells[1] = cells[1].replace(',', ".");
            });
        },
        ("# no numbers", "# no numbers"),
        &[
            "column `Moment Kurbel [kNm]`: `-6,03`",
            "a number with `.` as decimal sign",
            "table.decimal",
        ],
    ),
    (
        "a unit of time that is none",
        "strain_5rpm",
        |_| {},
        ("unit = \"s\"", "unit = \"sekunden\""),
        &["`time.unit` = \"sekunden\"", "a unit of time"],
    ),
    (
        "a negative modulus",
        "strain_5rpm",
        |_| {},
        ("young_gpa = 206.0", "young_gpa = -206.0"),
        &["`curves.stress_1_mpa.young_gpa` = -206", "GPa"],
    ),
    (
        "a gauge that is mostly missing",
        "strain_5rpm",
        |lines| {
            cells(lines, FIRST, ';', |row, cells| {
                if row % 3 > 0 {
                    cells[4] = String::new();
                }
            });
        },
        NOTHING,
        &[
            "column `DMS3 [\u{b5}m/m]`: a value in 1",
            "at least half of the rows",
        ],
    ),
    (
        "less than one turn",
        "strain_5rpm",
        |lines| lines.truncate(900),
        NOTHING,
        &["no whole turn of the crank by column `Kurbelwinkel [\u{b0}]` in lines 8 to 900"],
    ),
];

#[test]
fn faults_of_raw_files_are_named_with_line_and_column() {
    for (name, file, spoil, (from, to), expected) in FAULTS {
        let folder = ImportFolder::new();
        let mut lines = folder.raw_lines(&format!("{file}.csv.gz"));
        spoil(&mut lines);
        folder.write_raw(&format!("{file}.csv"), &lines);
        let speed = file.trim_start_matches("strain_");
        let import = format!("record import case/raw/{file}.csv --case case --condition {speed}");
        let (_, proposal) = folder.run(&import);
        let mapping = format!("case/measured/test_{speed}.import.toml");
        assert!(folder.path(&mapping).exists(), "{name}: {proposal}");
        folder.state_zero(&mapping);
        folder.replace(&mapping, from, to);
        let raw = folder.raw_bytes();
        let (code, said) = folder.run(&import);
        assert_eq!(code, 2, "{name}: {said}");
        for text in *expected {
            assert!(said.contains(text), "{name}: no `{text}` in\n{said}");
        }
        assert_eq!(folder.raw_bytes(), raw, "{name}: the raw file was changed");
        assert!(
            !folder
                .path(&format!("case/measured/test_{speed}.csv.gz"))
                .exists(),
            "{name}"
        );
    }
}
