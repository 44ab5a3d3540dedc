//! The same measurement as other programs write it.
use crate::{folder::ImportFolder, records};

/// Splits the rows of the file with a crank column into cells with decimal points.
fn rows(lines: &[String]) -> Vec<Vec<String>> {
    let data = lines
        .iter()
        .skip(7)
        .filter(|line| !line.starts_with("Ende"));
    data.map(|line| line.split(';').map(|cell| cell.replace(',', ".")).collect())
        .collect()
}

/// Returns the cells of a row with gauges in another unit.
fn scaled(row: &[String], factor: f64) -> Vec<String> {
    let gauges = row[2..6].iter().map(|cell| {
        let value = cell.parse::<f64>();
        value.map_or_else(|_| cell.clone(), |value| format!("{:.6}", factor * value))
    });
    [row[0].clone(), row[1].clone()]
        .into_iter()
        .chain(gauges)
        .collect()
}

/// Imports a raw text and checks that the stress is that of the file with a crank column.
fn same_stress(name: &str, lines: &[String], answers: &[(&str, &str)]) {
    let reference = ImportFolder::new();
    reference.import("5rpm");
    let folder = ImportFolder::new();
    folder.write_raw(name, lines);
    let import = format!("record import case/raw/{name} --case case --condition 5rpm");
    folder.run(&import);
    let mapping = "case/measured/test_5rpm.import.toml";
    folder.state_zero(mapping);
    for (from, to) in answers {
        folder.replace(mapping, from, to);
    }
    let (code, said) = folder.run(&import);
    assert_eq!(code, 0, "{name}: {said}");
    // the other condition has no record here
    for one in [&reference, &folder] {
        one.replace(
            "case/case.toml",
            "record_file = \"measured/test_4rpm.csv.gz\"",
            "",
        );
        one.replace(
            "case/case.toml",
            "card_file = \"measured/card_4rpm.csv\"",
            "card_file = \"measured/card_5rpm.csv\"",
        );
    }
    std::fs::copy(
        reference.path("case/measured/card_5rpm.csv"),
        folder.path("case/measured/card_5rpm.csv"),
    )
    .unwrap();
    let (new, old) = (
        records(&folder.path("case")),
        records(&reference.path("case")),
    );
    assert_eq!(new.len(), 4, "{name}");
    for ((title, _, new), (_, _, old)) in new.iter().zip(&old) {
        let largest = new
            .mean
            .iter()
            .zip(&old.mean)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        assert!(largest < 0.02, "{name}, {title}: {largest}");
    }
}

/// Checks other delimiters, clocks, units and orders of columns; each row of the measurement is the same.
#[test]
fn other_programs_write_the_same_measurement() {
    let folder = ImportFolder::new();
    let lines = folder.raw_lines("strain_5rpm.csv.gz");
    let rows = rows(&lines);
    let written = |header: &str, row: &dyn Fn(usize, &[String]) -> String| -> Vec<String> {
        let rows = rows.iter().enumerate().map(|(at, cells)| row(at, cells));
        header.lines().map(str::to_owned).chain(rows).collect()
    };
    let stamp = |time: &str| {
        let time: f64 = time.parse().unwrap();
        (time / 60.0, time % 60.0)
    };
    // comma, psi in the header, ISO time with a zone, rows over midnight
    let psi = 0.206 / 0.006_894_757_293_168;
    let iso = written(
        "Timestamp,Crank angle (deg),SG1 (psi),SG2 (psi),SG3 (psi),SG4 (psi)",
        &|_, row| {
            let cells = scaled(row, psi);
            let (minutes, seconds) = stamp(&cells[0]);
            let clock = if minutes < 0.5 {
                format!("2025-05-14T23:59:{:06.3}+08:00", 30.0 + seconds)
            } else {
                format!("2025-05-15T00:00:{:06.3}+08:00", seconds - 30.0)
            };
            format!("{clock},{}", cells[1..].join(","))
        },
    );
    same_stress("iso.csv", &iso, &[]);
    // tabulators, quoted names, microstrain without a unit, a radian column that falls, no header of units
    let falling = written(
        "\"Time\"\t\"strain\"\t\"strain\"\t\"strain\"\t\"strain\"\t\"angle [rad]\"",
        &|_, row| {
            let angle: f64 = row[1].parse().unwrap();
            let angle = -(angle - 37.4).to_radians();
            format!("{}\t{}\t{angle:.6}", row[0], row[2..6].join("\t"))
        },
    );
    let gauge =
        |column: &str| format!("column = \"{column}\", unit = \"um/m\", young_gpa = 206.0 }}");
    let answers: Vec<(String, String)> = ["strain", "strain#2", "strain#3", "strain#4"]
        .iter()
        .zip(1..)
        .map(|(column, number)| {
            let line = format!("stress_{number}_mpa = {{ {}", gauge(column));
            (format!("# {line}"), line)
        })
        .collect();
    let mut answers: Vec<(&str, &str)> = answers.iter().map(|(a, b)| (&**a, &**b)).collect();
    answers.push((
        "bottom_dead_centre_deg = 37.4",
        "bottom_dead_centre_deg = 0.0",
    ));
    same_stress("falling.txt", &falling, &answers);
    // blanks, no header at all
    let bare = written("", &|_, row| scaled(row, 0.206).join("  "));
    let columns = ["#3", "#4", "#5", "#6"].iter().zip(1..);
    let curves: Vec<String> = columns
        .map(|(column, number)| {
            format!("stress_{number}_mpa = {{ column = \"{column}\", unit = \"MPa\" }}")
        })
        .collect();
    let curves = format!("[curves]\n{}", curves.join("\n"));
    same_stress(
        "bare.txt",
        &bare,
        &[
            (
                "# column = \"..\"                      # elapsed",
                "column = \"#1\"\nunit = \"s\" # elapsed",
            ),
            (
                "# column = \"..\"                      # an angle",
                "column = \"#2\"\nunit = \"deg\"\ndirection = \"increasing\"\nbottom_dead_centre_deg = 37.4\n\
                 uncertainty_deg = 0.06 # an angle",
            ),
            ("[curves]", &curves),
        ],
    );
}

/// Checks that a recording in two files is one record, and that two recordings lose the turns at their ends.
#[test]
fn a_recording_in_two_files_is_one_record() {
    let folder = ImportFolder::new();
    let lines = folder.raw_lines("strain_5rpm.csv.gz");
    let (header, data) = (&lines[..7], &lines[7..lines.len() - 1]);
    let (first, second) = data.split_at(3000);
    folder.write_raw("a.csv", &[header, first].concat());
    folder.write_raw("b.csv", &[header, second].concat());
    let import = "record import case/raw/a.csv case/raw/b.csv --case case --condition 5rpm";
    folder.run(import);
    folder.state_zero("case/measured/test_5rpm.import.toml");
    let (code, said) = folder.run(import);
    assert_eq!(code, 0, "{said}");
    assert!(said.contains("5 whole turns"), "{said}");
    // a second recording, whose clock begins again
    let again = second.iter().map(|line| {
        let (time, rest) = line.split_once(';').unwrap();
        let time: f64 = time.replace(',', ".").parse().unwrap();
        format!("{:.2};{rest}", time - 30.0).replace('.', ",")
    });
    folder.write_raw("b.csv", &[header, &again.collect::<Vec<_>>()].concat());
    let (code, said) = folder.run(import);
    assert_eq!(code, 0, "{said}");
    assert!(said.contains("4 whole turns"), "{said}");
    // the file of a fault is named
    let mut spoilt = [header, second].concat();
    spoilt[500] = spoilt[500].replacen(';', ";x", 1);
    folder.write_raw("b.csv", &spoilt);
    let (code, said) = folder.run(import);
    assert_eq!(code, 2, "{said}");
    assert!(
        said.contains("case/raw/b.csv: row 501, column `Kurbelwinkel"),
        "{said}"
    );
}

/// Imports changed lines of a raw file of a condition and returns what the command says.
fn imported(file: &str, change: impl Fn(&mut Vec<String>)) -> String {
    let folder = ImportFolder::new();
    let mut lines = folder.raw_lines(&format!("{file}.csv.gz"));
    change(&mut lines);
    folder.write_raw(&format!("{file}.csv"), &lines);
    let speed = file.trim_start_matches("strain_");
    let import = format!("record import case/raw/{file}.csv --case case --condition {speed}");
    folder.run(&import);
    folder.state_zero(&format!("case/measured/test_{speed}.import.toml"));
    let (code, said) = folder.run(&import);
    assert_eq!(code, 0, "{said}");
    said
}

/// Checks that turns with a lost pulse or a jump of the clock are left out and said, and the others kept.
#[test]
fn disturbed_turns_are_left_out() {
    let lost = imported("strain_4rpm", |lines| {
        for line in &mut lines[4500..5000] {
            let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
            cells[7] = "+    0.000".to_owned();
            *line = cells.join(",");
        }
    });
    assert!(lost.contains("left out: the turn from line 3"), "{lost}");
    assert!(lost.contains("took 29.99 s, others 15.00 s"), "{lost}");
    assert!(lost.contains("3 whole turns at 3.999 /min"), "{lost}");
    let jump = imported("strain_5rpm", |lines| {
        let end = lines.len() - 1;
        for line in &mut lines[3000..end] {
            let (time, rest) = line.split_once(';').unwrap();
            let time: f64 = time.replace(',', ".").parse().unwrap();
            *line = format!("{:.2};{rest}", time + 3600.0).replace('.', ",");
        }
    });
    // the turn that the jump cuts in two
    assert!(jump.contains("4 whole turns at 5.000 /min"), "{jump}");
}

/// Checks that samples denser than the record needs are averaged, and that a number that stands for a missing
/// value is recognised.
#[test]
fn dense_samples_are_averaged() {
    let said = imported("strain_5rpm", |lines| {
        let data: Vec<Vec<f64>> = rows(lines)
            .iter()
            .filter_map(|row| row.iter().map(|cell| cell.parse().ok()).collect())
            .collect();
        lines.truncate(7);
        for pair in data.windows(2) {
            let turn = if pair[1][1] < pair[0][1] { 360.0 } else { 0.0 };
            for tenth in 0..10_u32 {
                let share = f64::from(tenth) / 10.0;
                let cells = (0..8).map(|column| {
                    let ahead = pair[1][column] + if column == 1 { turn } else { 0.0 };
                    let value = pair[0][column] + share * (ahead - pair[0][column]);
                    let value = if column == 1 { value % 360.0 } else { value };
                    let missing = tenth == 5 && column == 3 && lines.len() % 1000 == 0;
                    if missing {
                        "-9999".to_owned()
                    } else {
                        format!("{value:.4}").replace('.', ",")
                    }
                });
                let cells: Vec<String> = cells.collect();
                lines.push(cells.join(";"));
            }
        }
    });
    assert!(
        said.contains("every 4 samples are averaged to one"),
        "{said}"
    );
    assert!(said.contains("5 whole turns at 5.000 /min"), "{said}");
}
