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
        &["case.toml", "missing field `offset_m`"],
    ),
    (
        "twins in one place",
        |c| twins(c, "offset_m = 0.0"),
        &["case.toml", "`twin_ropes.offset_m` = 0 ", "0.001 to 2 m"],
    ),
    (
        "lengths without a unit",
        |c| twins(c, "offset_m = 0.12\nback_length_difference = 0.001"),
        &["unknown field", "did you mean `back_length_difference_m`?"],
    ),
    (
        "lengths in millimetres",
        |c| twins(c, "offset_m = 0.12\nback_length_difference_m = 1.0"),
        &[
            "`twin_ropes.back_length_difference_m` = 1 ",
            "-0.05 to 0.05 m",
        ],
    ),
    (
        "more modes than can be simulated",
        |c| twins(c, "offset_m = 0.12\nmodes = 20"),
        &[
            "`twin_ropes.modes` = 20",
            "0 to 18",
            "24 together with run.modes",
        ],
    ),
    (
        "more modes than there are",
        |c| twins(c, "offset_m = 0.12\nmodes = 15"),
        &[
            "the number of modes is 12",
            "twin_ropes.modes = 15",
            "head CASE --write",
        ],
    ),
    (
        "tables of another pair",
        |c| twins(c, "offset_m = 0.11"),
        &[
            "offset_m is 0.12",
            "twin_ropes.offset_m = 0.11",
            "head CASE --write",
        ],
    ),
    (
        "tables absent",
        |c| {
            twins(c, "offset_m = 0.12");
            fs::remove_file(c.path(TWINS)).unwrap();
        },
        &["back_head_twin.json: no such file", "head CASE --write"],
    ),
    (
        "tables of another mesh",
        |c| {
            twins(c, "offset_m = 0.12");
            let text = fs::read_to_string(c.path(MESH)).unwrap();
            fs::write(c.path(MESH), text + "\n").unwrap();
        },
        &["mesh_blake3 is", "another mesh", "head CASE --write"],
    ),
    (
        "tables ragged",
        |c| {
            twins(c, "offset_m = 0.12");
            c.replace(TWINS, "\"arc_deg\":[118.0,", "\"arc_deg\":[");
        },
        &["back_head_twin.json", "103 entries for 102 stations"],
    ),
];
