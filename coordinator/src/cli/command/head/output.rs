//! Output object of `horsehead head`.
use case::pumping_unit::{HeadComparison, HeadSource};
use protocol::{
    case::Case,
    pumping_unit::{ModeFamily, OmittedMode, ReducedHead},
};
use serde::Serialize;
use std::collections::BTreeMap;

/// Output object of `horsehead head`.
#[derive(Debug, Serialize)]
pub(crate) struct HeadOutput<'a> {
    case: &'a str,
    /// Name of the condition whose load is used for the quasi-static turn.
    condition: &'a str,
    mesh_blake3: &'a str,
    /// Computing time of the reduction on the worker (s).
    wall_s: f64,
    /// Number of displacement unknowns of the solved half of the mesh.
    unknowns: usize,
    lanczos_steps: usize,
    mass_kg: f64,
    modes: Vec<HeadModeOutput>,
    /// Frequencies of the head's out-of-plane modes (Hz); absent in cases with one rope.
    #[serde(skip_serializing_if = "Option::is_none")]
    twin_modes_hz: Option<&'a [f64]>,
    /// Computed modes that were discarded because they couple less to the loads of a revolution; empty unless
    /// coupled modes were requested.
    left_out: &'a [OmittedMode],
    /// Frequencies of modes in the case's table that do not move the rope surface (Hz).
    inert_table_modes_hz: &'a [f64],
    /// Stress results of the strain gauges over the quasi-static turn, by gauge number.
    gauges: BTreeMap<String, HeadGaugeOutput>,
}

/// Mode of the reduced head, compared with the mode of the case's table that matches it; the `table` fields
/// and `mac` (modal assurance criterion) are null where none matches.
#[derive(Debug, Serialize)]
pub(crate) struct HeadModeOutput {
    family: ModeFamily,
    frequency_hz: f64,
    table_frequency_hz: Option<f64>,
    mac: Option<f64>,
    /// Largest share of the mode in the static strain energy of any load pattern; null unless coupled modes
    /// were requested.
    coupling: Option<f64>,
}

/// Stress of a gauge over the quasi-static turn: half ranges from the exact solution, the case's table and
/// the modes alone.
#[derive(Debug, Serialize)]
pub(crate) struct HeadGaugeOutput {
    exact_half_range_mpa: f64,
    table_half_range_mpa: f64,
    mode_displacement_half_range_mpa: f64,
    mode_displacement_offset_mpa: f64,
    influence_difference: f64,
    /// Distance of the gauge from the surface of the mesh (m).
    surface_distance_m: f64,
    /// Stress under the rope at its largest tension (MPa), and its change when the gauge is moved along x, y and z
    /// (MPa/m); null along an axis on which the body ends on both sides of the gauge.
    largest_wrap_stress_mpa: f64,
    largest_wrap_gradient_mpa_per_m: [Option<f64>; 3],
}

pub(crate) fn object<'a>(
    (case, condition): (&'a Case, &'a str),
    (source, surface_distance_m): (&'a HeadSource, &[f64]),
    head: &'a ReducedHead,
    comparison: &'a HeadComparison,
) -> HeadOutput<'a> {
    let ranges = &comparison.half_ranges;
    let modes = head.modes.iter().zip(&comparison.modes);
    HeadOutput {
        case: &case.name,
        condition,
        mesh_blake3: &source.mesh_blake3,
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
                    surface_distance_m: surface_distance_m[gauge],
                    largest_wrap_stress_mpa: head.wrap_stress_mpa[gauge],
                    largest_wrap_gradient_mpa_per_m: head.wrap_gradient_mpa_per_m[gauge],
                };
                ((gauge + 1).to_string(), output)
            })
            .collect(),
    }
}
