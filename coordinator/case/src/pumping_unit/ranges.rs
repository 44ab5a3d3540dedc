//! Allowed range of each number in a `case.toml`. The consistency of the numbers with each other is checked
//! elsewhere.
use super::schema::CaseFile;
use crate::{
    document::Document,
    error::{CaseError, Faults},
};

/// Allowed range of a number of the case file, with its unit for messages.
struct Range(f64, f64, &'static str);

const LENGTH: Range = Range(1.0e-3, 100.0, "m");
const PLACE: Range = Range(-100.0, 100.0, "m");
const MASS: Range = Range(1.0e-3, 1.0e6, "kg");
const INERTIA: Range = Range(1.0e-6, 1.0e8, "kg m2");
const ANGLE: Range = Range(-360.0, 360.0, "deg");
const MOMENT: Range = Range(-1.0e6, 1.0e6, "N m");
const PITCH: Range = Range(1.0e-3, 1.0, "m");
const CYLINDERS: Range = Range(2.0, 5000.0, "cylinders");
const RATING: Range = Range(1.0e3, 1.0e6, "N.m");
const DENSITY: Range = Range(100.0, 3.0e4, "kg/m3");
const MODULUS: Range = Range(1.0, 1.0e3, "GPa");
const POISSON: Range = Range(0.0, 0.49, "(no unit)");
const DIFFERENCE: Range = Range(-0.05, 0.05, "m");

/// Maximum number of head modes in a simulation, in-plane and out-of-plane together.
const MOST_MODES: usize = 24;

/// Checks the range of every number of a case file.
///
/// # Errors
/// Returns all numbers outside their ranges, with range and unit.
pub(super) fn check(document: &Document, case: &CaseFile) -> Result<(), CaseError> {
    let all = bodies(case).into_iter().chain(ropes(case)).chain(run(case));
    let mut faults = Faults::default();
    for (path, value, Range(low, high, unit)) in all.chain(twins(case)) {
        faults.take(document.within(path, value, low..=high, unit));
    }
    let modes = case.twin_ropes.as_ref().map_or(0, |pair| pair.modes);
    let most = MOST_MODES.saturating_sub(case.run.modes);
    faults.take(document.within(
        "twin_ropes.modes",
        modes as f64,
        0.0..=most as f64,
        &format!("modes: {MOST_MODES} together with run.modes"),
    ));
    faults.end()
}

/// Number of the case file: its dotted path, value and range.
type Number = (&'static str, f64, Range);

fn bodies(case: &CaseFile) -> Vec<Number> {
    let (beam, crank, rod) = (&case.beam, &case.crank, &case.rod);
    let (front, back) = (&case.front_head, &case.back_head);
    let (phase, height) = (
        crank.counterweight_phase_deg,
        beam.gravity_height_moment_n_m,
    );
    let rating = crank.reducer_rating_n_m.unwrap_or(RATING.0);
    let weights = crank.counterweights.iter().flat_map(|own| {
        [
            (
                "crank.counterweights.count",
                f64::from(own.count),
                Range(1.0, 100.0, "weights"),
            ),
            ("crank.counterweights.mass_kg", own.mass_kg, MASS),
            (
                "crank.counterweights.crank_moment_n_m",
                own.crank_moment_n_m,
                Range(0.0, 1.0e6, "N m"),
            ),
            ("crank.counterweights.nearest_m", own.nearest_m, LENGTH),
            (
                "crank.counterweights.farthest_m",
                own.farthest_m,
                Range(own.nearest_m, LENGTH.1, "m, at least nearest_m"),
            ),
        ]
    });
    let numbers = vec![
        ("gravity_m_s2", case.gravity_m_s2, Range(0.0, 100.0, "m/s2")),
        ("beam.inertia_kg_m2", beam.inertia_kg_m2, INERTIA),
        ("beam.gravity_moment_n_m", beam.gravity_moment_n_m, MOMENT),
        ("beam.gravity_height_moment_n_m", height, MOMENT),
        ("crank.radius_m", crank.radius_m, LENGTH),
        ("crank.center_x_m", crank.center_x_m, PLACE),
        ("crank.center_y_m", crank.center_y_m, PLACE),
        ("crank.counterweight_phase_deg", phase, ANGLE),
        ("crank.reducer_rating_n_m", rating, RATING),
        ("rod.length_m", rod.length_m, LENGTH),
        ("rod.mass_kg", rod.mass_kg, MASS),
        ("rod.center_of_mass_m", rod.center_of_mass_m, PLACE),
        ("rod.inertia_kg_m2", rod.inertia_kg_m2, INERTIA),
        ("suspension.mass_kg", case.suspension.mass_kg, MASS),
        ("front_head.radius_m", front.radius_m, LENGTH),
        ("front_head.rope_anchor_deg", front.rope_anchor_deg, ANGLE),
        ("back_head.radius_m", back.radius_m, LENGTH),
        ("back_head.center_x_m", back.center_x_m, PLACE),
        ("back_head.center_y_m", back.center_y_m, PLACE),
        ("back_head.rope_anchor_deg", back.rope_anchor_deg, ANGLE),
    ];
    numbers.into_iter().chain(weights).collect()
}

fn ropes(case: &CaseFile) -> Vec<Number> {
    let (ropes, contact) = (&case.ropes, &case.contact);
    let (steel, rope) = (&case.flexible_head, &case.rope_material);
    let (back, front) = (ropes.back_cylinders as f64, ropes.front_cylinders as f64);
    let (pitch, reference) = (ropes.cylinder_length_m, ropes.reference_length_m);
    let (depth, exponent) = (contact.full_damping_penetration_m, contact.exponent);
    vec![
        (
            "ropes.preload_n",
            ropes.preload_n,
            Range(-1.0e6, 1.0e6, "N"),
        ),
        (
            "ropes.diameter_m",
            ropes.diameter_m,
            Range(1.0e-3, 0.2, "m"),
        ),
        ("ropes.cylinder_length_m", pitch, PITCH),
        ("ropes.reference_length_m", reference, PITCH),
        ("ropes.back_cylinders", back, CYLINDERS),
        ("ropes.front_cylinders", front, CYLINDERS),
        ("ropes.density_kg_m3", ropes.density_kg_m3, DENSITY),
        ("flexible_head.density_kg_m3", steel.density_kg_m3, DENSITY),
        ("flexible_head.young_gpa", steel.young_gpa, MODULUS),
        ("flexible_head.poisson", steel.poisson, POISSON),
        ("rope_material.young_gpa", rope.young_gpa, MODULUS),
        ("rope_material.poisson", rope.poisson, POISSON),
        ("contact.exponent", exponent, Range(1.0, 3.0, "(no unit)")),
        (
            "contact.full_damping_penetration_m",
            depth,
            Range(1.0e-7, 0.01, "m"),
        ),
    ]
}

fn run(case: &CaseFile) -> Vec<Number> {
    let run = &case.run;
    let step = run.output_step_deg;
    let budget = run.iteration_budget as f64;
    vec![
        ("run.output_step_deg", step, Range(0.01, 30.0, "deg")),
        (
            "run.lead_in_deg",
            run.lead_in_deg,
            Range(0.0, 3600.0, "deg"),
        ),
        ("run.ramp_s", run.ramp_s, Range(0.0, 600.0, "s")),
        (
            "run.longest_step_s",
            run.longest_step_s,
            Range(1.0e-5, 1.0, "s"),
        ),
        (
            "run.iteration_budget",
            budget,
            Range(100.0, 1.0e9, "iterations"),
        ),
        (
            "run.tolerance",
            run.tolerance,
            Range(1.0e-6, 1.0e3, "(no unit)"),
        ),
    ]
}

fn twins(case: &CaseFile) -> Vec<Number> {
    let numbers = case.twin_ropes.as_ref().map(|pair| {
        let (back, front) = (
            pair.back_length_difference_m,
            pair.front_length_difference_m,
        );
        vec![
            (
                "twin_ropes.offset_m",
                pair.offset_m,
                Range(1.0e-3, 2.0, "m"),
            ),
            ("twin_ropes.back_length_difference_m", back, DIFFERENCE),
            ("twin_ropes.front_length_difference_m", front, DIFFERENCE),
        ]
    });
    numbers.unwrap_or_default()
}
