//! The same measurement as other programs write it.
use crate::{folder::ImportFolder, records};
use std::collections::HashMap;

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
            ("# column = \"..\"\n# unit", "column = \"#2\"\n# unit"),
            ("# unit = \"deg\"", "unit = \"deg\""),
            ("# direction", "direction"),
            ("pulse_deg = 0.0 ", "# pulse_deg = 0.0 "),
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

/// Changes one cell of the rows from `from` to `to` of a raw file.
fn change(
    lines: &mut [String],
    (from, to): (usize, usize),
    (separator, place): (char, usize),
    cell: impl Fn(&str) -> String,
) {
    for line in &mut lines[from..to] {
        let mut cells: Vec<String> = line.split(separator).map(str::to_owned).collect();
        cells[place] = cell(&cells[place]);
        *line = cells.join(&separator.to_string());
    }
}

/// Checks that a standstill, a lost pulse away from bottom dead centre, rows lost over a pulse and a long dropout
/// of a gauge make no cycle, and that the others stay.
#[test]
fn only_regular_turns_become_cycles() {
    // 30 s of standstill before the crank turns
    let still = imported("strain_5rpm", |lines| {
        let first = lines[300].clone();
        let rest: Vec<String> = lines[300..].to_vec();
        let time = |line: &str| {
            line.split(';')
                .next()
                .unwrap()
                .replace(',', ".")
                .parse::<f64>()
        };
        let start = time(&first).unwrap();
        lines.truncate(7);
        for step in 0..3000_u32 {
            let cells = first.split_once(';').unwrap().1;
            lines.push(format!("{:.2};{cells}", 0.01 * f64::from(step)).replace('.', ","));
        }
        for line in rest {
            lines.push(time(&line).map_or(line.clone(), |at| {
                format!(
                    "{:.2};{}",
                    at - start + 30.0,
                    line.split_once(';').unwrap().1
                )
                .replace('.', ",")
            }));
        }
    });
    assert!(still.contains("4 whole turns at 5.0"), "{still}");
    // a gauge without values for 7.5 s
    let dropout = imported("strain_5rpm", |lines| {
        change(lines, (2000, 2750), (';', 4), |_| "OVER".to_owned());
    });
    assert!(
        dropout.contains("a gap") && dropout.contains("750 missing values"),
        "{dropout}"
    );
    assert!(
        dropout.contains("3 whole turns at 5.0") || dropout.contains("4 whole turns at 5.0"),
        "{dropout}"
    );
    // rows lost over the rise of a pulse: its time is not known
    let lost = imported("strain_4rpm", |lines| drop(lines.drain(4530..4625)));
    assert!(
        lost.contains("left out: the turn from line") && lost.contains("3 whole turns"),
        "{lost}"
    );
}

/// Checks that a pulse at 30 deg whose successor was lost leaves out what is between the known ones.
#[test]
fn a_lost_pulse_spoils_no_turn_wherever_it_is() {
    let folder = ImportFolder::new();
    let mut lines = folder.raw_lines("strain_4rpm.csv.gz");
    let pulses: Vec<String> = lines[16..]
        .iter()
        .map(|line| line.split(',').nth(7).unwrap().to_owned())
        .collect();
    for (at, line) in lines[16..].iter_mut().enumerate() {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        // 125 rows later is 30 deg; the second pulse is lost
        let pulse = at
            .checked_sub(125)
            .map_or("+    0.000", |before| pulses[before].as_str());
        cells[7] = if (1600..1900).contains(&at) {
            "+    0.000"
        } else {
            pulse
        }
        .to_owned();
        *line = cells.join(",");
    }
    folder.write_raw("strain_4rpm.csv", &lines);
    let import = "record import case/raw/strain_4rpm.csv --case case --condition 4rpm";
    folder.run(import);
    let mapping = "case/measured/test_4rpm.import.toml";
    folder.state_zero(mapping);
    folder.replace(mapping, "pulse_deg = 0.0", "pulse_deg = 30.0");
    let (code, said) = folder.run(import);
    assert_eq!(code, 0, "{said}");
    assert!(said.contains("it took 30.0"), "{said}");
    assert!(
        said.contains("2 whole turns at 4.0") || said.contains("3 whole turns at 4.0"),
        "{said}"
    );
}

/// Change of an angle, given its row.
type Spoil = fn(usize, f64) -> f64;

/// Checks that an encoder of coarse steps and one with noise give the angle without a bias.
#[test]
fn coarse_and_noisy_encoders_have_no_bias() {
    let reference = ImportFolder::new();
    reference.import("5rpm");
    let expected = angles(&reference);
    let spoils: [(&str, Spoil, f64); 3] = [
        (
            "steps of 2 deg",
            |_, angle| (angle / 2.0).floor() * 2.0,
            0.1,
        ),
        (
            "held over 5 rows",
            |at, angle| angle - 0.3 * (at % 5) as f64,
            0.1,
        ),
        (
            "noise",
            |at, angle| angle + 0.6 * (((at * 7919) % 101) as f64 / 50.0 - 1.0),
            0.15,
        ),
    ];
    for (name, spoil, bound) in spoils {
        let folder = ImportFolder::new();
        let mut lines = folder.raw_lines("strain_5rpm.csv.gz");
        let end = lines.len() - 1;
        for (at, line) in lines[7..end].iter_mut().enumerate() {
            let mut cells: Vec<String> = line.split(';').map(str::to_owned).collect();
            let angle: f64 = cells[1].replace(',', ".").parse().unwrap();
            // whole steps begin at the zero of the crank
            let angle = (spoil(at, (angle - 37.4).rem_euclid(360.0)) + 37.4).rem_euclid(360.0);
            cells[1] = format!("{angle:.3}").replace('.', ",");
            *line = cells.join(";");
        }
        folder.write_raw("strain_5rpm.csv", &lines);
        let import = "record import case/raw/strain_5rpm.csv --case case --condition 5rpm";
        folder.run(import);
        folder.state_zero("case/measured/test_5rpm.import.toml");
        let (code, said) = folder.run(import);
        assert_eq!(code, 0, "{name}: {said}");
        let found = angles(&folder);
        let off: Vec<f64> = found
            .iter()
            .filter_map(|(cells, angle)| {
                Some((angle - expected.get(cells)? + 180.0).rem_euclid(360.0) - 180.0)
            })
            .collect();
        let mean = off.iter().sum::<f64>() / off.len() as f64;
        assert!(off.len() > 3000, "{name}: {}", off.len());
        assert!(mean.abs() < bound, "{name}: {mean}");
    }
}

/// Returns the angle of every sample of the imported record, by its other cells.
fn angles(folder: &ImportFolder) -> HashMap<String, f64> {
    let file = std::fs::File::open(folder.path("case/measured/test_5rpm.csv.gz")).unwrap();
    let mut text = String::new();
    std::io::Read::read_to_string(&mut flate2::read::GzDecoder::new(file), &mut text).unwrap();
    let rows = text.lines().skip(1).map(|line| {
        let mut cells = line.splitn(3, ',').skip(1);
        let angle = cells.next().unwrap().parse().unwrap();
        (cells.next().unwrap().to_owned(), angle)
    });
    rows.collect()
}

/// Checks that a card of several strokes and one that lacks a part are refused, and that one bad point is left
/// out.
#[test]
fn a_card_is_one_whole_stroke() {
    let folder = ImportFolder::new();
    let card = std::fs::read_to_string(folder.path("case/raw/card_5rpm.dyn")).unwrap();
    let points: Vec<&str> = card.lines().skip(1).take(360).collect();
    let import = |points: &[&str]| {
        let table = format!("Position (in),Load (lbf)\n{}\n", points.join("\n"));
        std::fs::write(folder.path("case/raw/card.csv"), table).unwrap();
        folder.run("record import case/raw/card.csv --case case --condition 5rpm")
    };
    let (code, said) = import(&[&points[..], &points[..]].concat());
    assert_eq!(code, 2, "{said}");
    assert!(said.contains("2 strokes; a card is one"), "{said}");
    let (code, said) = import(&points[..320]);
    assert_eq!(code, 2, "{said}");
    assert!(said.contains("a part of the stroke is missing"), "{said}");
    let mut spoilt = points.clone();
    let bad = format!("{}, 99999", points[100].split(',').next().unwrap());
    spoilt[100] = &bad;
    let (code, said) = import(&spoilt);
    assert_eq!(code, 0, "{said}");
    assert!(said.contains("1 outliers of the load"), "{said}");
}

/// Checks a card as services write it: angle, position and load without units, sections in comments, rows that
/// lack a cell at the end.
#[test]
fn the_card_of_a_service_is_read() {
    let folder = ImportFolder::new();
    let card = std::fs::read_to_string(folder.path("case/raw/card_5rpm.dyn")).unwrap();
    let points = card.lines().skip(1).take(360).enumerate();
    let rows = points.map(|(at, line)| {
        let section = if at == 180 { "# right\n" } else { "" };
        format!("{section}{at},{line}\n")
    });
    let rows: String = rows.collect();
    let text = format!("# well 7\n# 1715678560\nposition,length,weight\n# left\n{rows}360,0.00\n");
    std::fs::write(folder.path("case/raw/service.csv"), text).unwrap();
    let import = "record import case/raw/service.csv --case case --condition 5rpm";
    let (code, said) = folder.run(import);
    assert_eq!(code, 2, "{said}");
    assert!(
        said.contains("position = { column = \"length\", unit = \"in\" }"),
        "{said}"
    );
    assert!(
        said.contains("card.load: the unit of column \"weight\""),
        "{said}"
    );
    folder.replace("case/measured/card_5rpm.import.toml", "# load", "load");
    let (code, said) = folder.run(import);
    assert_eq!(code, 0, "{said}");
    assert!(said.contains("1 rows that lack a cell"), "{said}");
    let of = |case: std::path::PathBuf| {
        let file = case.join("measured/card_5rpm.csv");
        case::pumping_unit::read_card(&file, protocol::pumping_unit::Smoothing::None, "a card")
            .unwrap()
    };
    let (new, old) = (of(folder.path("case")), of(crate::folder::shipped()));
    let difference = crate::rms(new.load_n.iter().zip(&old.load_n).map(|(a, b)| a - b));
    assert!(difference < 50.0, "{difference}");
}
