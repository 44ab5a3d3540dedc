//! Reduction of a head: from a mesh to modes along the rope arc and static influence lines.
//!
//! Every computation runs on the half z >= 0. A rope over the whole width pulls symmetrically: antisymmetric
//! modes do not move the rope surface in the mean and do not couple to plane motion, though gauges measure
//! them. Two ropes beside each other do excite them (`sway.rs`). This file defines the sequence of the work;
//! `problem.rs` implements it.
use super::arc::{Rim, Station};
use super::coupling::{CANDIDATES, Patterns, pick};
use super::error::ReductionError;
use super::mesh::Half;
use super::problem::{ModeOutputs, Problem};
use super::request::{Family, ReductionRequest};
use super::result::{Reduction, Row};
use super::surface::surface;

/// Reduces a head to modes and static influence lines.
///
/// # Errors
/// [`ReductionError`] for a mesh that is not usable, stations or gauges outside it, or too few converged
/// modes.
pub fn reduce(request: &ReductionRequest<'_>) -> Result<Reduction, ReductionError> {
    let half = Half::new(request.mesh)?;
    let rim = Rim::new(&half.mesh, request.center);
    let stations = request.stations.iter().map(|&psi| rim.station(psi));
    let stations: Vec<Station> = stations.collect::<Result<_, _>>()?;
    let rows = gauge_rows(request, &half)?;
    let mut modes = Vec::new();
    let mut lanczos_steps = 0;
    let statics = Problem::new(request, &half, Family::Symmetric)?;
    let patterns = match request.patterns {
        [] => None,
        ropes => Some(Patterns::new(&statics, &rim, ropes)?),
    };
    let count = request.modes * patterns.as_ref().map_or(1, |_| CANDIDATES);
    for &family in request.families {
        let other;
        let problem = if family == Family::Symmetric {
            &statics
        } else {
            other = Problem::new(request, &half, family)?;
            &other
        };
        let coupling = |frequency: f64, field: &[[f64; 3]]| {
            let of = patterns.as_ref().filter(|_| family == Family::Symmetric);
            let shares = of.map(|patterns| patterns.shares(frequency, field));
            shares.map_or(0.0, |shares| shares.fold(0.0, f64::max))
        };
        let seen = ModeOutputs {
            stations: &stations,
            rows: &rows,
            fields: request.fields || request.surface.is_some(),
        };
        let (found, steps) = problem.modes(count, &coupling, &seen)?;
        modes.extend(found);
        lanczos_steps += steps;
    }
    let (mut modes, left_out) = if patterns.is_some() {
        pick(modes, request.modes)
    } else {
        modes.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
        modes.truncate(request.modes);
        (modes, Vec::new())
    };
    let mut reduction = statics.statics(request, &rim, &stations, &rows)?;
    if let Some(loads) = &request.surface {
        let surface = surface(&statics, request, &rim, (loads, &modes))?;
        reduction.surface = Some(surface);
    }
    if !request.fields {
        for mode in &mut modes {
            mode.field = Vec::new();
        }
    }
    if let Some(pair) = &request.pair {
        let problem = Problem::new(request, &half, Family::Antisymmetric)?;
        reduction.sway = Some(problem.sway(request, &rim, pair, &rows)?);
    }
    reduction.modes = modes;
    reduction.left_out = left_out;
    reduction.lanczos_steps = lanczos_steps;
    Ok(reduction)
}

fn gauge_rows(request: &ReductionRequest<'_>, half: &Half) -> Result<Vec<Row>, ReductionError> {
    let young = request.steel.young;
    let numbered = (1..).zip(request.gauges);
    numbered
        .map(|(number, gauge)| gauge.row(&half.mesh, young, number))
        .collect()
}
