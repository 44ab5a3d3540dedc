//! A reduced back head in numbers: its modes beside the case's, and what they alone would show.
use super::{Row, Table};
use crate::report::words::mode_family;
use crate::{
    report::number::{NONE, fixed, percent},
    study::HeadComparison,
};
use protocol::case::TwinHead;
use protocol::job::ReducedHead;

/// Modes, one row each, beside the most similar ones of the case's table.
pub fn head_modes(head: &ReducedHead, comparison: &HeadComparison) -> Table {
    let rows = (1..).zip(head.modes.iter().zip(&comparison.modes));
    let rows = rows.map(|(number, (mode, found))| {
        let of_table = found.table.map_or_else(
            || [NONE, NONE, NONE].map(str::to_owned),
            |(hz, mac)| {
                let difference = 100.0 * (mode.frequency_hz / hz - 1.0);
                [fixed(hz, 2), fixed(difference, 2), fixed(mac, 4)]
            },
        );
        let [hz, difference, mac] = of_table;
        let cells = [
            mode_family(mode.family).to_owned(),
            fixed(mode.frequency_hz, 2),
            hz,
            difference,
            mac,
        ];
        Row::new(format!("mode {number}"), cells)
    });
    let mut notes = vec![format!(
        "MAC: modal assurance criterion of the shapes along the rope arc. Mass {} kg; {} unknown \
         displacements, {} solves.",
        fixed(head.mass_kg, 2),
        head.unknowns,
        head.lanczos_steps
    )];
    if !comparison.inert_hz.is_empty() {
        let list: Vec<String> = comparison.inert_hz.iter().map(|hz| fixed(*hz, 1)).collect();
        notes.push(format!(
            "The case's table also holds modes that do not move the rope surface: {} Hz. No rope \
             drives them.",
            list.join(", ")
        ));
    }
    Table {
        title: "Modes of the back head, pin holes held".to_owned(),
        head: ["", "family", "Hz", "table Hz", "difference %", "MAC"]
            .map(str::to_owned)
            .to_vec(),
        rows: rows.collect(),
        notes,
    }
}

/// Modes that a pair of ropes drives by pulling unequally, one row each: how far they move the rope at
/// +z on the whole arc, and what the gauges read.
pub fn head_pair(tables: &TwinHead, offset_m: f64) -> Table {
    let most = |curve: &[f64]| curve.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let rows = (0..tables.frequencies_hz.len()).map(|k| {
        let shapes = [&tables.radial, &tables.tangential, &tables.lateral];
        let moves = shapes.map(|shape| fixed(1e3 * most(&shape[k]), 2));
        let gauges = tables.gauge_stress_mpa[k].map(|stress| fixed(1e-3 * stress, 2));
        let hz = fixed(tables.frequencies_hz[k], 2);
        let cells = std::iter::once(hz).chain(moves).chain(gauges);
        Row::new(format!("mode {}", k + 1), cells)
    });
    let head = [
        "",
        "Hz",
        "radial",
        "tangential",
        "lateral",
        "gauge 1",
        "gauge 2",
        "gauge 3",
        "gauge 4",
    ];
    Table {
        title: format!("Modes out of the plane, ropes at z = ±{offset_m} m"),
        head: head.map(str::to_owned).to_vec(),
        rows: rows.collect(),
        notes: vec![
            "Largest displacement of the rope at +z (mm) and gauge stress (GPa) per unit modal \
             coordinate (kg^1/2 m)."
                .to_owned(),
        ],
    }
}

/// What truncation costs over a quasi-static turn.
pub fn head_statics(comparison: &HeadComparison, condition: &str, modes: usize) -> Table {
    let ranges = &comparison.half_ranges;
    let rows = (0..4).map(|gauge| {
        let cells = [
            fixed(ranges.exact[gauge], 2),
            fixed(ranges.table[gauge], 2),
            percent(comparison.influence_difference[gauge]),
            fixed(ranges.displacement[gauge], 2),
            fixed(ranges.displacement_offset[gauge], 2),
        ];
        Row::new(format!("gauge {}", gauge + 1), cells)
    });
    Table {
        title: format!("Half-range of stress over a quasi-static turn, {condition} (MPa)"),
        head: [
            "",
            "exact",
            "case's table",
            "lines differ",
            "modes alone",
            "mean off by",
        ]
        .map(str::to_owned)
        .to_vec(),
        rows: rows.collect(),
        notes: vec![
            "Exact: influence lines (mode acceleration). Lines differ: largest difference of the \
             influence lines over their largest value."
                .to_owned(),
            format!("Modes alone: mode displacement with the first {modes} modes."),
        ],
    }
}
