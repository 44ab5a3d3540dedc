//! Faults of twin ropes and of the head's tables for them that must be reported.
use super::spoilt::{Copy, MESH, Spoilt, TOML, TWINS};
use std::fs;

/// Adds a `[twin_ropes]` table with the given lines to the copied case file.
fn twins(c: &Copy, lines: &str) {
    let added = format!("[twin_ropes]\n{lines}\nhead_file = \"{TWINS}\"\n\n[genes]");
    c.replace(TOML, "[genes]", &added);
}

pub(super) const FAULTS: &[Spoilt] = &[
    (
        "twins without a place",
        |c| twins(c, "back_length_difference_m = 0.001"),
        "Toml",
        &["case.toml", "`offset_m`"],
    ),
    (
        "twins in one place",
        |c| twins(c, "offset_m = 0.0"),
        "Several",
        &["case.toml", "`twin_ropes.offset_m` = 0 ", "0.001 to 2 m"],
    ),
    (
        "lengths without a unit",
        |c| twins(c, "offset_m = 0.12\nback_length_difference = 0.001"),
        "Toml",
        &["`back_length_difference_m`"],
    ),
    (
        "lengths in millimetres",
        |c| twins(c, "offset_m = 0.12\nback_length_difference_m = 1.0"),
        "Field",
        &[
            "`twin_ropes.back_length_difference_m` = 1 ",
            "-0.05 to 0.05 m",
        ],
    ),
    (
        "more modes than can be simulated",
        |c| twins(c, "offset_m = 0.12\nmodes = 20"),
        "Several",
        &["`twin_ropes.modes` = 20", "0 to 18", "24"],
    ),
    (
        "more modes than there are",
        |c| twins(c, "offset_m = 0.12\nmodes = 15"),
        "Contradiction",
        &["12", "twin_ropes", "15", "--write"],
    ),
    (
        "tables of another pair",
        |c| twins(c, "offset_m = 0.11"),
        "Contradiction",
        &["offset_m is 0.12", "twin_ropes.offset_m = 0.11", "--write"],
    ),
    (
        "tables absent",
        |c| {
            twins(c, "offset_m = 0.12");
            fs::remove_file(c.path(TWINS)).unwrap();
        },
        "Missing",
        &["back_head_twin.json", "--write"],
    ),
    (
        "tables of another mesh",
        |c| {
            twins(c, "offset_m = 0.12");
            let text = fs::read_to_string(c.path(MESH)).unwrap();
            fs::write(c.path(MESH), text + "\n").unwrap();
        },
        "Contradiction",
        &["mesh_blake3 is", "--write"],
    ),
    (
        "tables ragged",
        |c| {
            twins(c, "offset_m = 0.12");
            c.replace(TWINS, "\"arc_deg\":[118.0,", "\"arc_deg\":[");
        },
        "Damaged",
        &["back_head_twin.json", "103", "102"],
    ),
];
