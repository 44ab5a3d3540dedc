//! The object of `horsehead head`.
use case::pumping_unit::HeadComparison;
use protocol::{
    case::Case,
    pumping_unit::{LeftOutMode, ModeFamily, ReducedHead},
};
use serde::Serialize;
use std::collections::BTreeMap;

/// Of `horsehead head`.
#[derive(Debug, Serialize)]
pub(crate) struct HeadOutput<'a> {
    case: &'a str,
    /// Condition of the quasi-static turn.
    condition: &'a str,
    /// Content of the mesh file.
    mesh_blake3: &'a str,
    /// Time on the worker (s).
    wall_s: f64,
    /// Unknown displacements of the half that was solved.
    unknowns: usize,
    lanczos_steps: usize,
    mass_kg: f64,
    modes: Vec<HeadModeOutput>,
    /// Modes out of the plane (Hz); absent where there is one rope.
    #[serde(skip_serializing_if = "Option::is_none")]
    twin_modes_hz: Option<&'a [f64]>,
    /// Modes that couple less to the loads of a turn; empty where they were not asked for.
    left_out: &'a [LeftOutMode],
    /// Modes of the case's table that do not move the rope surface (Hz).
    inert_table_modes_hz: &'a [f64],
    /// By gauge number.
    gauges: BTreeMap<String, HeadGaugeOutput>,
}

/// A mode; the table's are null where it has none like it.
#[derive(Debug, Serialize)]
pub(crate) struct HeadModeOutput {
    family: ModeFamily,
    frequency_hz: f64,
    table_frequency_hz: Option<f64>,
    mac: Option<f64>,
    /// Largest share of any load pattern's static energy; null where they were not asked for.
    coupling: Option<f64>,
}

/// Statics of a gauge over the quasi-static turn.
#[derive(Debug, Serialize)]
pub(crate) struct HeadGaugeOutput {
    exact_half_range_mpa: f64,
    table_half_range_mpa: f64,
    mode_displacement_half_range_mpa: f64,
    mode_displacement_offset_mpa: f64,
    influence_difference: f64,
}

/// Gathers what `horsehead head` prints.
pub(crate) fn head<'a>(
    (case, condition): (&'a Case, &'a str),
    mesh_blake3: &'a str,
    head: &'a ReducedHead,
    comparison: &'a HeadComparison,
) -> HeadOutput<'a> {
    let ranges = &comparison.half_ranges;
    let modes = head.modes.iter().zip(&comparison.modes);
    HeadOutput {
        case: &case.name,
        condition,
        mesh_blake3,
        wall_s: head.wall_s,
        unknowns: head.unknowns,
        lanczos_steps: head.lanczos_steps,
        mass_kg: head.mass_kg,
        modes: modes
            .map(|(mode, found)| HeadModeOutput {
                family: mode.family,
                frequency_hz: mode.frequency_hz,
                table_frequency_hz: found.table.map(|(hz, _)| hz),
                mac: found.table.map(|(_, mac)| mac),
                coupling: head.coupled().then_some(mode.coupling),
            })
            .collect(),
        twin_modes_hz: head.twin.as_ref().map(|twin| &twin.frequencies_hz[..]),
        left_out: &head.left_out,
        inert_table_modes_hz: &comparison.inert_hz,
        gauges: (0..4)
            .map(|gauge| {
                let output = HeadGaugeOutput {
                    exact_half_range_mpa: ranges.exact[gauge],
                    table_half_range_mpa: ranges.table[gauge],
                    mode_displacement_half_range_mpa: ranges.displacement[gauge],
                    mode_displacement_offset_mpa: ranges.displacement_offset[gauge],
                    influence_difference: comparison.influence_difference[gauge],
                };
                ((gauge + 1).to_string(), output)
            })
            .collect(),
    }
}
