//! Faults of the back head's modes, influence lines and mesh that must be reported.
use super::spoilt::{INFLUENCE, MESH, MODES, Spoilt, TOML, cell, scaled};
use std::fs;

pub(super) const FAULTS: &[Spoilt] = &[
    (
        "several faults at once",
        |c| {
            c.replace(TOML, "mass_kg = 450.0", "mass_kg = -450.0");
            c.replace(TOML, "radius_m = 1.900", "radius_m = 0.0");
            c.replace(TOML, "recommended = 3.14e8", "recommended = 3.14e13");
            c.effect("parameters = { moment = { value = inf, unit = \"N.m\" } }");
            for file in ["measured/test_4rpm.csv.gz", "measured/card_5rpm.csv"] {
                fs::remove_file(c.path(file)).unwrap();
            }
            for file in [
                "back_head/back_head.msh",
                "back_head/back_head_influence.csv",
            ] {
                fs::remove_file(c.path(file)).unwrap();
            }
        },
        "Several",
        &[
            "8 faults",
            "`rod.mass_kg` = -450",
            "`back_head.radius_m` = 0",
            "`genes.kb1.recommended`",
            "`effects[0].parameters.moment.value` = inf",
            "test_4rpm.csv.gz",
            "card_5rpm.csv",
            "back_head.msh",
            "back_head_influence.csv",
        ],
    ),
    (
        "modes absent",
        |c| fs::remove_file(c.path(MODES)).unwrap(),
        "Missing",
        &["back_head_modes.json"],
    ),
    (
        "modes truncated",
        |c| {
            let bytes = fs::read(c.path(MODES)).unwrap();
            fs::write(c.path(MODES), &bytes[..bytes.len() / 2]).unwrap();
        },
        "Damaged",
        &["back_head_modes.json", "line 1"],
    ),
    (
        "modes ragged",
        |c| c.replace(MODES, "\"arc_deg\": [118.0, ", "\"arc_deg\": ["),
        "Field",
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
            );
        },
        "Field",
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
        "Field",
        &[
            "back_head_modes.json",
            "`frequencies_hz[1]` = 116.0122",
            "ascending",
        ],
    ),
    (
        "stations not ascending",
        |c| c.replace(MODES, "118.0, 119.0,", "119.0, 118.0,"),
        "Field",
        &["back_head_modes.json", "`arc_deg[1]` = 118", "ascending"],
    ),
    (
        "influence too short",
        |c| c.lines(INFLUENCE, |at, line| (at < 100).then(|| line.to_owned())),
        "Cell",
        &[
            "back_head_influence.csv",
            "row 99",
            "`psi_deg`",
            "118 to 220 deg",
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
            });
        },
        "Cell",
        &["back_head_influence.csv", "row 9", "`psi_deg`", "ascending"],
    ),
    (
        "influence in Pa",
        |c| c.lines(INFLUENCE, |at, line| scaled(at, line, &[1, 2, 3], 1e6)),
        "Cell",
        &["back_head_influence.csv", "`normal_1_mpa_per_n`"],
    ),
    (
        "mesh absent",
        |c| fs::remove_file(c.path(MESH)).unwrap(),
        "Missing",
        &["back_head.msh"],
    ),
    (
        "mesh of another format",
        |c| fs::write(c.path(MESH), "solid head\nfacet normal 0 0 1\n").unwrap(),
        "Damaged",
        &["back_head.msh", "line 1", "$MeshFormat", "MSH 4.1"],
    ),
    (
        "mesh of another version",
        |c| c.replace(MESH, "4.1 0 8", "4.0 0 8"),
        "Damaged",
        &[
            "back_head.msh",
            "line 2",
            "`4.0 0 8`",
            "`4.1 0 8` or `2.2 0 8`",
        ],
    ),
    (
        "binary mesh",
        |c| c.replace(MESH, "4.1 0 8", "4.1 1 8"),
        "Damaged",
        &["back_head.msh", "line 2", "ASCII"],
    ),
    (
        "group missing",
        |c| c.replace(MESH, "2 3 \"pin_b\"", "2 3 \"pinb\""),
        "Damaged",
        &["back_head.msh", "`pin_b`", "pinb"],
    ),
    (
        "mesh cut off",
        |c| {
            let bytes = fs::read(c.path(MESH)).unwrap();
            fs::write(c.path(MESH), &bytes[..bytes.len() / 2]).unwrap();
        },
        "Damaged",
        &["back_head.msh", "line ", "MSH 4.1"],
    ),
    (
        "mesh with text",
        |c| c.replace(MESH, "-2.049794994", "-2.04x"),
        "Damaged",
        &["back_head.msh", "line 23436", "numbers"],
    ),
    (
        "mesh in millimetres",
        |c| c.replace(MESH, "-2.049794994", "-2049.794994"),
        "Damaged",
        &[
            "back_head.msh",
            "line 23436",
            "-100 to 100 m",
            "mesh_unit_m = 0.001",
        ],
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
        "Damaged",
        &["back_head.msh", "`steel`"],
    ),
    (
        "mass contradicts the modes",
        |c| {
            c.replace(
                TOML,
                "density_kg_m3 = 7850.0                                 #",
                "density_kg_m3 = 7000.0 #",
            );
        },
        "Contradiction",
        &[
            "back_head.msh",
            "785",
            "mass_kg = 881.016",
            "flexible_head.density_kg_m3",
        ],
    ),
    (
        "tables of another mesh",
        |c| {
            c.replace(
                MODES,
                "{\"frequencies_hz\"",
                "{\"mesh_blake3\": \"00ff\", \"frequencies_hz\"",
            );
        },
        "Contradiction",
        &[
            "back_head.msh",
            "back_head_modes.json",
            "mesh_blake3 = 00ff",
            "49980a8862ebdc7b",
        ],
    ),
    (
        "tables of another steel, arc or gauges",
        |c| {
            c.replace(
                MODES,
                "{\"frequencies_hz\"",
                "{\"source_blake3\": \"00ff\", \"frequencies_hz\"",
            );
        },
        "Contradiction",
        &["back_head_modes.json", "source_blake3", "--write"],
    ),
    (
        "stiffness in another unit",
        |c| {
            c.replace(
                TOML,
                "density_kg_m3 = 7850.0                                 #",
                "young_gpa = 2.06e11\ndensity_kg_m3 = 7850.0 #",
            );
        },
        "Field",
        &["case.toml", "flexible_head.young_gpa", "GPa"],
    ),
    (
        "unknown stress recovery",
        |c| {
            c.replace(
                TOML,
                "density_kg_m3 = 7850.0                                 #",
                "stress = \"modal\"\ndensity_kg_m3 = 7850.0 #",
            );
        },
        "Toml",
        &["case.toml", "modal", "mode_displacement"],
    ),
];
