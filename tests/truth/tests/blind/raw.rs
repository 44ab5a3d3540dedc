//! Records of a set written as the raw files of a logger and a dynamometer, and imported again as the manual
//! says (`docs/records.md`).
use crate::coarse::{Trial, run};
use flate2::read::GzDecoder;
use std::{fmt::Write as _, fs, io::Read as _, path::Path};

/// Strain of a gauge per stress of steel of 206 GPa [um/m per MPa].
const STRAIN: f64 = 1.0 / 0.206;

/// Number of the raw angle column at bottom dead centre \[deg\].
const ZERO: f64 = 250.0;

/// Returns the rows of a table in CSV with a header.
fn rows(text: &str) -> impl Iterator<Item = Vec<f64>> {
    let rows = text.lines().skip(1);
    rows.map(|line| {
        line.split(',')
            .filter_map(|cell| cell.parse().ok())
            .collect()
    })
}

/// Writes a record as a strain logger would: semicolons, decimal commas, microstrain, its own zero of the
/// angle.
fn logger(record: &Path, to: &Path) {
    let mut text = String::new();
    let file = fs::File::open(record).expect("a record");
    GzDecoder::new(file)
        .read_to_string(&mut text)
        .expect("gzip");
    let header: Vec<&str> = text.lines().next().expect("a header").split(',').collect();
    let column = |name: &str| {
        header
            .iter()
            .position(|own| *own == name)
            .expect("a column")
    };
    let gauges = [1, 2, 3, 4].map(|gauge| column(&format!("stress_{gauge}_mpa")));
    let (time, angle) = (column("time_s"), column("crank_deg"));
    let (position, torque) = (column("polished_rod_position_m"), column("crank_torque_nm"));
    let mut raw = "Logger;8 channels\nStart;14.05.2025 09:12:40\nTime [s];Crank angle [\u{b0}];SG1 [\u{b5}m/m];\
                   SG2 [\u{b5}m/m];SG3 [\u{b5}m/m];SG4 [\u{b5}m/m];Position [mm];Torque [kN.m]\n"
        .to_owned();
    for row in rows(&text) {
        let mut cells = vec![row[time], (row[angle] + ZERO) % 360.0];
        cells.extend(gauges.map(|gauge| STRAIN * row[gauge]));
        cells.extend([1e3 * row[position], 1e-3 * row[torque]]);
        let cells: Vec<String> = cells
            .iter()
            .map(|cell| format!("{cell:.3}").replace('.', ","))
            .collect();
        let _infallible = writeln!(raw, "{}", cells.join(";"));
    }
    fs::write(to, raw).expect("a raw file");
}

/// Writes a load card in Theta's format, from the kinematics of the shipped case.
fn dynamometer(card: &Path, speed: &str, to: &Path) {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/cyjs10-5-37hb");
    let kinematics =
        fs::read_to_string(shipped.join("machine/kinematics_720.csv")).expect("a table");
    let card = fs::read_to_string(card).expect("a card");
    let positions: Vec<f64> = rows(&kinematics).map(|row| row[3]).collect();
    let loads: Vec<f64> = rows(&card).map(|row| row[1]).collect();
    assert_eq!(positions.len(), loads.len());
    let mut raw = format!("{}\n", loads.len());
    for (position, load) in positions.iter().zip(loads) {
        let _infallible = writeln!(
            raw,
            "{:.3}, {:.2}",
            position / 0.0254,
            load / 4.448_221_615_260_5
        );
    }
    let _infallible = writeln!(raw, "0\n{speed}\n157.5\n0\n0\n24");
    fs::write(to, raw).expect("a raw file");
}

/// Replaces records and cards of a set by what their raw files give; the data sheets keep what is known of the
/// instruments.
pub(crate) fn import_again(trial: &Trial) {
    let case = trial.at("imported");
    fs::create_dir_all(case.join("measured")).expect("a folder");
    fs::copy(trial.at("case/case.toml"), case.join("case.toml")).expect("a copy");
    for speed in ["5", "4"] {
        let name = |file: String| (trial.set.join(&file), case.join("measured").join(&file));
        let (record, imported) = name(format!("test_{speed}rpm.csv.gz"));
        let (card, imported_card) = name(format!("card_{speed}rpm.csv"));
        let (sheet, imported_sheet) = name(format!("test_{speed}rpm.toml"));
        fs::copy(&sheet, &imported_sheet).expect("a copy");
        let (raw, dyn_file) = (format!("strain_{speed}.csv"), format!("card_{speed}.dyn"));
        logger(&record, &trial.at(&raw));
        dynamometer(&card, speed, &trial.at(&dyn_file));
        let condition = format!("{speed}rpm");
        let import = [
            "record",
            "import",
            &raw,
            &dyn_file,
            "--case",
            "imported",
            "--condition",
            &condition,
        ];
        let proposed = trial.horsehead(&import).output().expect("it starts");
        assert_eq!(proposed.status.code(), Some(2), "{proposed:?}");
        let mapping = case.join(format!("measured/test_{speed}rpm.import.toml"));
        let text = fs::read_to_string(&mapping).expect("a proposal");
        let text = text
            .replace(
                "# bottom_dead_centre_deg = 0.0",
                &format!("bottom_dead_centre_deg = {ZERO:?}"),
            )
            .replace("# uncertainty_deg = 0.1", "uncertainty_deg = 0.06");
        fs::write(&mapping, text).expect("a mapping");
        run(&mut trial.horsehead(&import));
        for (to, from) in [
            (record, imported),
            (card, imported_card),
            (sheet, imported_sheet),
        ] {
            fs::copy(from, to).expect("a copy");
        }
    }
}
