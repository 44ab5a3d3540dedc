//! Tables of a reduced back head: its modes compared with those of the case, and the truncation error of the
//! modes alone.
use super::name::mode_family;
use crate::document::{Row, Table};
use crate::number::{MISSING, fixed, percent};
use case::pumping_unit::HeadComparison;
use protocol::pumping_unit::{HeadGauge, OmittedMode, ReducedHead, TwinHead};

/// Note below the table of modes that defines the coupling of a mode: the largest share of the static energy
/// under a load pattern.
const COUPLING: &str = "Coupling: largest share of the static energy under a load pattern that the \
     mode holds. Patterns: the rope at its shortest, middle and longest wrap of the turn, and the \
     beam's accelerations along x, along y and about the pivot. Those that couple most are taken.";

/// Builds the table of the reduced head's kept modes, each with the most similar mode of the case's mode
/// table, and of the modes left out below the highest kept mode.
pub fn head_modes(head: &ReducedHead, comparison: &HeadComparison) -> Table {
    let row = |label: String, family, hz, table: Option<(f64, f64)>, coupling: f64| {
        let of_table = table.map_or_else(
            || [MISSING, MISSING, MISSING].map(str::to_owned),
            |(table_hz, mac)| {
                let difference = 100.0 * (hz / table_hz - 1.0);
                [fixed(table_hz, 2), fixed(difference, 2), fixed(mac, 4)]
            },
        );
        let coupling = head.coupled().then(|| fixed(100.0 * coupling, 3));
        let of_mode = [mode_family(family).to_owned(), fixed(hz, 2)];
        let cells = of_mode.into_iter().chain(of_table);
        Row::new(
            label,
            cells.chain([coupling.unwrap_or_else(|| MISSING.to_owned())]),
        )
    };
    let kept = (1..).zip(head.modes.iter().zip(&comparison.modes));
    let kept = kept.map(|(number, (mode, found))| {
        let label = format!("mode {number}");
        row(
            label,
            mode.family,
            mode.frequency_hz,
            found.table,
            mode.coupling,
        )
    });
    let (below, above) = left_out(head);
    let beside = below.iter().map(|mode| {
        let label = "left out".to_owned();
        row(label, mode.family, mode.frequency_hz, None, mode.coupling)
    });
    Table::new(
        "Modes of the back head, pin holes held",
        [
            "",
            "family",
            "Hz",
            "table Hz",
            "difference %",
            "MAC",
            "coupling %",
        ],
        kept.chain(beside).collect(),
    )
    .with_notes(mode_notes(head, comparison, above))
}

fn mode_notes(
    head: &ReducedHead,
    comparison: &HeadComparison,
    above: &[OmittedMode],
) -> Vec<String> {
    let mut notes = vec![format!(
        "MAC: modal assurance criterion of the shapes along the rope arc. Mass {} kg; {} unknown \
         displacements, {} solves.",
        fixed(head.mass_kg, 2),
        head.unknowns,
        head.lanczos_steps
    )];
    if head.coupled() {
        notes.push(COUPLING.to_owned());
    }
    if let (Some(first), Some(last)) = (above.first(), above.last()) {
        let most = above.iter().fold(0.0_f64, |most, m| most.max(m.coupling));
        notes.push(format!(
            "Looked at and left out above them: {} from {} to {} Hz, coupling {} % at most.",
            above.len(),
            fixed(first.frequency_hz, 1),
            fixed(last.frequency_hz, 1),
            fixed(100.0 * most, 3)
        ));
    }
    if !comparison.inert_hz.is_empty() {
        let list: Vec<String> = comparison.inert_hz.iter().map(|hz| fixed(*hz, 1)).collect();
        notes.push(format!(
            "The case's table also holds modes that do not move the rope surface: {} Hz. No rope \
             drives them.",
            list.join(", ")
        ));
    }
    notes
}

/// Returns the left-out modes below and above the highest kept mode.
fn left_out(head: &ReducedHead) -> (&[OmittedMode], &[OmittedMode]) {
    let highest = head.modes.last().map_or(0.0, |mode| mode.frequency_hz);
    let below = head
        .left_out
        .partition_point(|mode| mode.frequency_hz < highest);
    head.left_out.split_at(below)
}

/// Builds the table of the modes of the back head that a pair of ropes excites by unequal tension: largest
/// displacement over the arc of the rope at +z, and gauge stresses.
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
    Table::new(
        format!("Modes out of the plane, ropes at z = ±{offset_m} m"),
        head,
        rows.collect(),
    )
    .with_notes([
        "Largest displacement of the rope at +z (mm) and gauge stress (GPa) per unit modal \
             coordinate (kg^1/2 m).",
    ])
}

/// Builds the table of the gauges: place, distance from the surface of the mesh \[m\], and stress under the rope at
/// its largest tension with its change when the gauge is moved.
pub fn head_gauges(
    (head, tension_n): (&ReducedHead, f64),
    gauges: &[HeadGauge; 4],
    surface_distance_m: &[f64],
) -> Table {
    let rows = (0..4).map(|at| {
        let HeadGauge {
            position_m,
            direction,
            ..
        } = gauges[at];
        let list = |values: [f64; 3], digits| values.map(|x| fixed(x, digits)).join(", ");
        let stress = head.wrap_stress_mpa[at];
        let change = head.wrap_gradient_mpa_per_m[at].map(|own| {
            own.map_or_else(
                || MISSING.to_owned(),
                |per_m| percent(1e-3 * per_m / stress),
            )
        });
        let place = [
            list(position_m, 4),
            list(direction, 2),
            fixed(1e3 * surface_distance_m[at], 1),
            fixed(stress, 1),
        ];
        Row::new(format!("gauge {}", at + 1), place.into_iter().chain(change))
    });
    let head = [
        "",
        "x, y, z (m)",
        "direction",
        "from the surface (mm)",
        "stress (MPa)",
        "per mm along x",
        "along y",
        "along z",
    ];
    let title = format!(
        "Gauges, with the rope at its largest tension, {} kN",
        fixed(1e-3 * tension_n, 1)
    );
    Table::new(title, head, rows.collect()).with_notes([
        "Per mm: change of the stress when the gauge is moved by 1 mm, over its length on both sides; a gauge whose \
         place is known to 2 mm has twice this as the uncertainty of its reading.",
    ])
}

/// Builds the table of the error in gauge stress caused by truncating the head's modes, over a quasi-static
/// revolution.
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
    Table::new(
        format!("Half-range of stress over a quasi-static turn, {condition} (MPa)"),
        [
            "",
            "exact",
            "case's table",
            "lines differ",
            "modes alone",
            "mean off by",
        ],
        rows.collect(),
    )
    .with_notes([
        "Exact: influence lines (mode acceleration). Lines differ: largest difference of the \
             influence lines over their largest value."
            .to_owned(),
        format!("Modes alone: mode displacement with the first {modes} modes."),
    ])
}
