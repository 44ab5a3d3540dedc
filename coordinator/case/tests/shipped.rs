//! Tests that the shipped case loads and that its figures agree with its README.
use case::pumping_unit::{self as unit, RecordFacts, mesh};
use case::{self, CaseEffect, CaseParameter, GeneFile, Loaded, Overrides};
use protocol::{
    case::{Case, ChannelRecord, Offset, Term},
    pumping_unit::{Coefficient, Machine, Sensor},
    unit::Unit,
};
use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

fn shipped() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/cyjs10-5-37hb")
}

fn half_range(values: &[f64]) -> f64 {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    (high - low) / 2.0
}

fn root_mean_square(record: &ChannelRecord) -> f64 {
    let squares: f64 = record.spread.iter().map(|s| s * s).sum();
    (squares / record.spread.len() as f64).sqrt()
}

/// Returns the gauge records that a case has for a condition.
fn gauges(case: &Case, condition: usize) -> Vec<&ChannelRecord> {
    case.measured(condition)
        .filter(|(_, channel, _)| channel.name.starts_with("gauge"))
        .map(|(_, _, record)| record)
        .collect()
}

/// Returns the facts (sample count, rate, speed) of each gauge record of the shipped case.
fn facts() -> Vec<RecordFacts> {
    let conditions = unit::figures(&shipped())
        .expect("the shipped case")
        .conditions
        .into_iter();
    let records = conditions.filter_map(|condition| condition.record);
    records.map(|record| record.facts).collect()
}

/// Returns the rows of the table of figures in the README, computed from the records.
fn figures(loaded: &Loaded) -> [String; 3] {
    let conditions = 0..loaded.case.conditions.len();
    let records = conditions.map(|condition| gauges(&loaded.case, condition));
    let records: Vec<Vec<&ChannelRecord>> = records.filter(|it| !it.is_empty()).collect();
    let facts = facts();
    let ranges = records.iter().map(|gauges| {
        let half = gauges.iter().map(|record| half_range(&record.mean));
        half.map(|half| format!("{half:.2}"))
            .collect::<Vec<_>>()
            .join(", ")
    });
    let spreads = records.iter().map(|gauges| {
        let squares = gauges.iter().map(|record| root_mean_square(record).powi(2));
        let mean = squares.sum::<f64>() / gauges.len() as f64;
        format!("{:.2}", mean.sqrt())
    });
    let samples = facts.iter().map(|f| format!("{}, {}", f.samples, f.lost));
    let row = |name: &str, cells: Vec<String>| format!("| {name} | {} |", cells.join(" | "));
    [
        row("half-range at gauges 1, 2, 3, 4 [MPa]", ranges.collect()),
        row("standard deviation between cycles [MPa]", spreads.collect()),
        row("samples, lost", samples.collect()),
    ]
}

#[test]
fn the_shipped_case_has_the_figures_of_its_readme() {
    let loaded = case::load_with_notes(&shipped(), &Overrides::default()).unwrap();
    let case = &loaded.case;
    assert_eq!(case.name, "CYJS10-5-37HB");
    assert_eq!(
        case.unknowns
            .iter()
            .map(|u| u.name.as_str())
            .collect::<Vec<_>>(),
        Coefficient::ALL.map(Coefficient::as_str)
    );
    assert_eq!(case.objective.condition, case.condition("5rpm").unwrap());
    let term = |gauge| Term {
        channel: Sensor::Gauge(gauge).name(),
        weight: 1.0,
    };
    assert_eq!(case.objective.terms, [1, 3].map(term));
    // of all sensors the torque alone has an absolute zero
    for own in &case.channels {
        let fixed = own.name == Sensor::Torque.name();
        assert_eq!(own.offset == Offset::Fixed, fixed, "{}", own.name);
    }
    for gene in &case.unknowns {
        assert!(
            (gene.upper / gene.start / 1e4 - 1.0).abs() < 1e-9,
            "{gene:?}"
        );
        assert!(
            (gene.start / gene.lower / 1e4 - 1.0).abs() < 1e-9,
            "{gene:?}"
        );
    }
    let machine = Machine::of(case).unwrap();
    for (index, working) in machine.conditions.iter().enumerate() {
        assert_eq!(working.card.load_n.len(), 720);
        let named: Vec<_> = case
            .channels_of(index)
            .map(|(_, c)| c.name.as_str())
            .collect();
        let names = [
            "gauge_1", "gauge_2", "gauge_3", "gauge_4", "position", "torque",
        ];
        assert_eq!(named, names);
        for (_, channel) in case.channels_of(index) {
            assert_eq!(channel.abscissa.points.len(), 720);
            assert!((channel.abscissa.points[719] - 359.5).abs() < 1e-9);
        }
        let gauges = gauges(case, index);
        assert_eq!(gauges.len(), 4);
        for record in &gauges {
            assert_eq!(record.cycles, 5);
            let spread = root_mean_square(record);
            assert!((0.1..0.3).contains(&spread), "{spread}");
        }
        // the quasi-static half-ranges, less than 10 % of ripple above them
        for (gauge, expected) in [(1, 12.76), (3, 17.71)] {
            let ratio = half_range(&gauges[gauge - 1].mean) / expected;
            assert!((1.0..1.1).contains(&ratio), "gauge {gauge}: {ratio}");
        }
    }
    let readme = fs::read_to_string(shipped().join("README.md")).unwrap();
    let rows = figures(&loaded);
    let kept = rows.iter().all(|row| readme.contains(row));
    assert!(
        kept,
        "the README's table of figures is\n{}",
        rows.join("\n")
    );
}

#[test]
fn the_shipped_sheets_say_how_good_the_instruments_are() {
    let loaded = case::load_with_notes(&shipped(), &Overrides::default()).unwrap();
    let sheet = [
        ("gauge_gain", "gain_1", 0.005),
        ("gauge_gain", "gain_2", 0.005),
        ("gauge_gain", "gain_3", 0.005),
        ("gauge_gain", "gain_4", 0.005),
        ("crank_angle_offset", "angle", 0.06),
        ("load_cell_gain", "gain", 0.003),
        ("amplifier_lag", "lag", 0.002),
        ("position_gain", "gain", 0.002),
        ("torque_gain", "gain", 0.005),
        ("pivot_friction", "moment", 50.0),
        ("beam_balance", "moment", 200.0),
    ];
    for record in &loaded.cycles {
        let nuisances = &record.stated.nuisances;
        let stated = nuisances
            .iter()
            .map(|own| (&*own.id, &*own.parameter, own.deviation));
        assert_eq!(stated.collect::<Vec<_>>(), sheet, "as the data sheets say");
        assert!(nuisances.iter().all(|own| !own.assumed));
        let positive = nuisances.iter().filter(|own| own.never_negative);
        let positive: Vec<&str> = positive.map(|own| &*own.id).collect();
        assert_eq!(positive, ["amplifier_lag", "pivot_friction"]);
    }
    let lost: Vec<u64> = facts().iter().map(|facts| facts.lost).collect();
    assert_eq!(lost, [30, 43], "as the data sheets say");
    assert_eq!(
        loaded.notes.len(),
        2,
        "lost samples, once per record: {:?}",
        loaded.notes
    );
}

/// Checks the envelope of the case against kinematics that another program computed.
#[test]
fn the_envelope_is_that_of_the_design_kinematics() {
    let text = fs::read_to_string(shipped().join("machine/kinematics_720.csv")).unwrap();
    let mut lines = text.lines();
    let header: Vec<&str> = lines
        .next()
        .unwrap()
        .trim_start_matches("# ")
        .split(',')
        .collect();
    let rows: Vec<Vec<f64>> = lines
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    let extremes = |name: &str| {
        let column = header.iter().position(|other| *other == name).unwrap();
        let values = rows.iter().map(|row| row[column]);
        [
            values.clone().fold(f64::INFINITY, f64::min),
            values.fold(f64::NEG_INFINITY, f64::max),
        ]
    };
    let envelope = unit::figures(&shipped()).unwrap().envelope;
    let near = |ours: [f64; 2], theirs: [f64; 2], tolerance: f64| {
        for (ours, theirs) in ours.into_iter().zip(theirs) {
            assert!((ours - theirs).abs() < tolerance, "{ours} {theirs}");
        }
    };
    // ours is sampled every 2 deg, an extreme is flat: 63.7/2 deg x (1 deg in rad)^2 / 2
    near(envelope.beam_deg, extremes("beam_deg"), 5e-3);
    near(envelope.contact_deg, extremes("psi_deg"), 2e-2);
    let [shortest, longest] = extremes("free_m");
    near(
        envelope.free_rope_m,
        [shortest - 2.876, longest - 2.876],
        1e-3,
    );
    near([0.0, envelope.stroke_m], extremes("s_m"), 1e-3);
}

/// Checks that resampling and averaging preserve the measured curve: a plain mean of all samples in bins of
/// one degree, computed here from the file, agrees within its noise. A shift by one grid step would appear as
/// 0.11 MPa.
#[test]
fn the_averaged_record_is_the_record() {
    let case = case::load(&shipped(), &Overrides::default()).unwrap();
    let packed = fs::read(shipped().join("measured/test_4rpm.csv.gz")).unwrap();
    let mut reader = csv::Reader::from_reader(flate2::read::GzDecoder::new(packed.as_slice()));
    let mut bins = vec![(0.0, 0.0); 360];
    for row in reader.records() {
        let row = row.unwrap();
        let [angle, stress] = [1, 4].map(|column| row[column].parse::<f64>().unwrap());
        // bins centred on whole degrees; the last half degree belongs to bin 0
        let at = (0..360).rfind(|&bin| f64::from(bin) - 0.5 <= angle && angle < 359.5);
        let bin = &mut bins[usize::try_from(at.unwrap_or(0)).unwrap()];
        bin.0 += stress;
        bin.1 += 1.0;
    }
    let mean = &gauges(&case, 1)[2].mean;
    let squares: f64 = (0..360)
        .map(|at| {
            let around: [f64; 3] = [(2 * at + 719) % 720, 2 * at, 2 * at + 1].map(|i| mean[i]);
            let ours = 0.25 * around[0] + 0.5 * around[1] + 0.25 * around[2];
            (ours - bins[at].0 / bins[at].1).powi(2)
        })
        .sum();
    let difference = (squares / 360.0).sqrt();
    assert!(difference < 0.05, "{difference} MPa");
}

#[test]
fn gene_files_are_read_in_the_units_of_the_case() {
    let folder = shipped();
    let case = case::load(&folder, &Overrides::default()).unwrap();
    let recommended = case::read_genes(&folder.join("recommended.toml"), &case).unwrap();
    assert_eq!(recommended, case.start());
    let optimised = case::read_genes(&folder.join("table3_optimised.toml"), &case).unwrap();
    assert_eq!(
        optimised,
        [
            7.81e8, 2.26e8, 204.0, 308.0, 5201.0, 4287.0, 45.0, 56.0, 4.01e8, 1.02e3
        ]
    );
    assert_eq!(case.unknowns[2].unit, Unit::NewtonMetrePerDegree.symbol());

    let scratch = tempfile::tempdir().unwrap();
    let file = scratch.path().join("genes.toml");
    let text = fs::read_to_string(folder.join("recommended.toml")).unwrap();
    let radians = text.replace(
        "value = 110.0, unit = \"N.m/deg\"",
        "value = 6302.535746439056, unit = \"N.m/rad\"",
    );
    assert_ne!(radians, text);
    fs::write(&file, radians).unwrap();
    let converted = case::read_genes(&file, &case).unwrap();
    assert!((converted[2] - 110.0).abs() < 1e-9, "{}", converted[2]);
    let faults = [
        (text.replace("kb56 =", "kb5 ="), "did you mean `kb56`?"),
        (
            text.replace("value = 137.0", "value = -137.0"),
            "`kb56.value` = -137",
        ),
        (
            text.replace("unit = \"N/m^1.5\"", "unit = \"N/m\""),
            "`kc.unit` = \"N/m\"",
        ),
        (
            text.replace(", unit = \"N/m^1.5\"", ""),
            "missing field `unit`",
        ),
    ];
    for (fault, expected) in faults {
        assert_refused(&file, &case, &fault, expected);
    }
}

/// Checks that a faulty gene file is rejected with an error that states the fault, the file's name and a
/// remedy.
fn assert_refused(file: &Path, case: &Case, fault: &str, expected: &str) {
    fs::write(file, fault).expect("a file");
    let message = case::read_genes(file, case)
        .expect_err(expected)
        .to_string();
    assert!(
        message.contains(expected) && message.contains("genes.toml"),
        "{message}"
    );
    assert!(message.contains("\nhelp: "), "{message}");
}

/// Returns an effect with two searched parameters and a fixed one.
fn drift() -> CaseEffect {
    let parameter = |value, search| CaseParameter {
        value,
        unit: "MPa/rev".to_owned(),
        ci95: None,
        search,
    };
    CaseEffect {
        id: "gauge_drift".to_owned(),
        parameters: BTreeMap::from([
            ("drift_1".to_owned(), parameter(-0.3, Some([-1.0, 1.0]))),
            ("drift_2".to_owned(), parameter(1.0 / 7.0, None)),
            ("drift_3".to_owned(), parameter(0.5, Some([-1.0, 1.0]))),
        ]),
        provenance: None,
    }
}

/// Returns the shipped case with effects of a gene file.
fn with(effects: &[CaseEffect]) -> Case {
    let loaded = case::load_with_notes(&shipped(), &Overrides::default());
    let mut with = loaded.expect("the shipped case");
    with.take_effects(effects);
    with.case
}

/// Returns values of the case with [`drift`], the effect's own zero or negative among them.
fn drifting(case: &Case) -> Vec<f64> {
    let mut values = case.start();
    values[10] = 0.1 + 0.2;
    values[11] = -1.0 / 3.0;
    values
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|v| v.to_bits()).collect()
}

/// Checks that gene files carry the effects with which they were found: searched parameters survive writing and
/// reading bit for bit, and a case that lacks an effect, or has another size of it, is given it or refused.
#[test]
fn gene_files_carry_their_effects() {
    let case = with(&[drift()]);
    let names = case.unknowns[10..].iter().map(|own| own.name.as_str());
    assert_eq!(
        names.collect::<Vec<_>>(),
        ["gauge_drift.drift_1", "gauge_drift.drift_3"]
    );
    assert_eq!(CaseEffect::all_of(&case), [drift()]);
    let values = drifting(&case);
    let scratch = tempfile::tempdir().unwrap();
    let file = scratch.path().join("genes.toml");
    let text = case::write_genes(&case, &values, &[drift()], "a test");
    fs::write(&file, &text).unwrap();
    let read = |case: &Case| GeneFile::read(&file).unwrap().values(case);
    assert_eq!(bits(&read(&case).unwrap()), bits(&values));

    let refused = read(&with(&[])).unwrap_err().to_string();
    let place = "`effects[0].id` = \"gauge_drift\"";
    assert!(refused.contains(place), "{refused}");
    let given = with(GeneFile::read(&file).unwrap().effects());
    assert_eq!(bits(&read(&given).unwrap()), bits(&values));
    // a parameter that is not searched takes the file's value
    let mut other = drift();
    other.parameters.get_mut("drift_2").unwrap().value = 0.25;
    let refused = read(&with(std::slice::from_ref(&other)))
        .unwrap_err()
        .to_string();
    let place = "`effects[0].parameters.drift_2`";
    assert!(
        refused.contains(place) && refused.contains("0.25"),
        "{refused}"
    );
    assert_eq!(with(&[other, drift()]), case);

    for (from, to, expected) in [
        ("MPa/rev", "MPa", "`effects[0].parameters.drift_1.unit`"),
        (
            "id = \"gauge_drift\"",
            "id = \"gauge drift\"",
            "`effects[0].id`",
        ),
        ("[[effects]]", "[[effect]]", "[[effect]]"),
    ] {
        let fault = text.replace(from, to);
        assert_ne!(fault, text, "{expected}");
        assert_refused(&file, &case, &fault, expected);
    }
}

/// Checks that the settings which make the case as fine as the numerical check are keys of its file, under which the ropes
/// keep their lengths.
#[test]
fn finer_settings_can_be_written_into_the_case() {
    let case = with(&[]);
    let lines = case::kind::of(&case).finer_settings(&case, 0.5).unwrap();
    let mut text = fs::read_to_string(shipped().join("case.toml")).unwrap();
    for line in &lines {
        let (key, value) = line.split_once(" = ").unwrap();
        let (table, key) = key.split_once('.').unwrap();
        let (before, rest) = text.split_once(&format!("\n[{table}]")).unwrap();
        let (own, rest) = rest.split_once(&format!("\n{key} = ")).unwrap();
        let (_, rest) = rest.split_once('\n').unwrap();
        text = format!("{before}\n[{table}]{own}\n{key} = {value}\n{rest}");
    }
    let scratch = tempfile::tempdir().unwrap();
    for part in ["", "back_head", "measured"] {
        let to = scratch.path().join(part);
        fs::create_dir_all(&to).unwrap();
        for entry in fs::read_dir(shipped().join(part)).unwrap() {
            let entry = entry.unwrap();
            if entry.file_type().unwrap().is_file() {
                fs::copy(entry.path(), to.join(entry.file_name())).unwrap();
            }
        }
    }
    fs::write(scratch.path().join("case.toml"), &text).unwrap();
    let finer = case::load(scratch.path(), &Overrides::default()).unwrap();
    let [coarse, finer] = [&case, &finer].map(|case| Machine::of(case).unwrap());
    let lengths = |machine: &Machine| {
        let ropes = &machine.ropes;
        [ropes.back_cylinders, ropes.front_cylinders]
            .map(|count| count as f64 * ropes.cylinder_length_m)
    };
    for (coarse, finer) in lengths(&coarse).iter().zip(lengths(&finer)) {
        assert!((coarse - finer).abs() < 1e-9, "{coarse} {finer}");
    }
    assert!(finer.ropes.cylinder_length_m < 0.6 * coarse.ropes.cylinder_length_m);
    assert!(finer.run.longest_step_s < 0.6 * coarse.run.longest_step_s);
}

/// Checks that a file of version 0.1, which states no effects, leaves the case's values or has lines for the effects'
/// parameters.
#[test]
fn gene_files_of_version_0_1_are_read() {
    let case = with(&[drift()]);
    let older = case::read_genes(&shipped().join("recommended.toml"), &case).unwrap();
    assert_eq!(bits(&older), bits(&case.start()));
    let values = drifting(&case);
    let lines = case::write_genes(&case, &values, &[], "version 0.1");
    assert!(lines.contains("\"gauge_drift.drift_3\" = {"), "{lines}");
    let scratch = tempfile::tempdir().unwrap();
    let file = scratch.path().join("genes.toml");
    fs::write(&file, &lines).unwrap();
    assert_eq!(
        bits(&case::read_genes(&file, &case).unwrap()),
        bits(&values)
    );
    for (from, to, expected) in [
        (
            "drift_3\"",
            "drft_3\"",
            "did you mean `gauge_drift.drift_3`?",
        ),
        (
            "gauge_drift.drift_3",
            "a.b",
            "kc, cc, gauge_drift.drift_1, gauge_drift.drift_3",
        ),
        ("MPa/rev", "MPa", "`gauge_drift.drift_1.unit`"),
        (
            "value = -3.333333333333333e-1",
            "value = nan",
            "`gauge_drift.drift_3.value` = NaN",
        ),
        (
            "\"gauge_drift.drift_1\"",
            "gauge_drift.drift_1",
            "unknown field `drift_1`",
        ),
    ] {
        let fault = lines.replace(from, to);
        assert_ne!(fault, lines, "{expected}");
        assert_refused(&file, &case, &fault, expected);
    }
}

/// Checks nodes and elements of the mesh against the crate mshio, and its volume against the mass of the
/// modes.
#[test]
fn the_mesh_is_read_as_by_another_reader() {
    let path = shipped().join("back_head/back_head.msh");
    let ours = mesh::read(&path).unwrap();
    let bytes = fs::read(&path).unwrap();
    let theirs = mshio::parse_msh_bytes(&bytes).unwrap();
    let nodes: Vec<[f64; 3]> = theirs
        .data
        .nodes
        .unwrap()
        .node_blocks
        .iter()
        .flat_map(|block| block.nodes.iter().map(|node| [node.x, node.y, node.z]))
        .collect();
    assert_eq!(ours.nodes_m, nodes);
    // the tags of this mesh count from 1 in the order of its nodes
    let theirs: Vec<Vec<Vec<usize>>> = theirs
        .data
        .elements
        .unwrap()
        .element_blocks
        .iter()
        .map(|block| {
            let index = |&tag: &u64| usize::try_from(tag).unwrap() - 1;
            block
                .elements
                .iter()
                .map(|e| e.nodes.iter().map(index).collect())
                .collect()
        })
        .collect();
    for (group, block) in ["pin_a", "pin_b", "rope_surface"].iter().zip(&theirs) {
        assert_eq!(ours.surfaces[*group], block.concat(), "{group}");
    }
    assert_eq!(ours.volumes[mesh::VOLUME], theirs[3].concat());
    assert_eq!(theirs[3].len(), 13_838);
    let mass = ours.volume_m3() * 7850.0;
    assert!((mass / 881.016 - 1.0).abs() < 1e-4, "{mass} kg");
}

#[test]
fn the_summary_tells_what_a_user_asks_first() {
    let summary = case::check(&shipped(), &Overrides::default()).unwrap().text;
    for expected in [
        "CYJS10-5-37HB",
        "stroke      4.000 m",
        "3.600 m in 72 cylinders",
        "5.700 m in 114 cylinders",
        "881.0 kg, modes at 116.0, 121.3",
        "gauge 3   at (-1.0453, -0.3953, -0.1600) m, 12 mm along y, 0.0 mm from the surface",
        "kb4       1.100e2 (1.10e-2 .. 1.10e6) N.m/deg",
        "condition   5rpm: 5 /min, load 34.4 to 78.3 kN",
        "record 5 cycles, 5970 samples at 100 Hz, 30 lost, measured speed 5.001 /min",
        "gauge 1: half-range 13.",
        "objective   5rpm: gauge_1 (weight 1), gauge_3 (weight 1)",
        "30 of 6000 samples are lost",
    ] {
        assert!(summary.contains(expected), "no `{expected}` in\n{summary}");
    }
}

/// Checks that the template written by `case new` loads once the files that it names exist.
#[test]
fn the_template_loads_beside_its_data() {
    let scratch = tempfile::tempdir().unwrap();
    let files = unit::new_files().unwrap();
    let (_, template) = files[0];
    fs::create_dir(scratch.path().join("measured")).unwrap();
    for (file, text) in &files {
        fs::write(scratch.path().join(file), text).unwrap();
    }
    let message = case::load(scratch.path(), &Overrides::default())
        .unwrap_err()
        .to_string();
    assert!(message.contains("back_head.msh: no such file"), "{message}");
    fs::create_dir(scratch.path().join("back_head")).unwrap();
    for folder in ["measured", "back_head"] {
        for entry in fs::read_dir(shipped().join(folder)).unwrap() {
            let entry = entry.unwrap();
            let to = scratch.path().join(folder).join(entry.file_name());
            // the data sheet is the template's
            if !to.exists() {
                fs::copy(entry.path(), to).unwrap();
            }
        }
    }
    let case = case::load(scratch.path(), &Overrides::default()).unwrap();
    assert_eq!(case.conditions.len(), 1);
    assert_eq!(case.unknowns.len(), 10);
    for line in template.lines().filter(|line| line.contains(" = ")) {
        let plain = [
            "gauges",
            "center_y_m",
            "gravity_m_s2",
            "mass_kg",
            "density_kg_m3",
            "diameter_m",
            "radius_m",
        ];
        let described = line.contains('#') || plain.iter().any(|key| line.starts_with(key));
        assert!(described, "no comment on `{line}`");
    }
}

#[test]
fn a_folder_of_measurements_that_is_not_there_is_named_as_such() {
    let overrides = Overrides {
        measured: Some("no/such/folder".into()),
    };
    let error = case::load(&shipped(), &overrides).unwrap_err().to_string();
    assert!(
        error.starts_with("no/such/folder: the folder given by --measured does not exist"),
        "{error}"
    );
    let own = case::load_with_notes(&shipped(), &Overrides::default()).unwrap();
    assert!(own.synthetic, "the shipped records were computed");
}
