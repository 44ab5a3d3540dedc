//! Checks of the numbers in `case.toml`: ranges, and whether the ropes fit the machine.
use super::{
    document::{Document, Step},
    error::CaseError,
    geometry::{self, Envelope},
    schema::CaseFile,
};
use protocol::case::Smoothing;

/// Everything that `case.toml` alone can have wrong about the machine and the run.
pub(super) fn check(document: &Document, case: &CaseFile) -> Result<Envelope, CaseError> {
    check_ranges(document, case)?;
    check_run(document, case)?;
    check_ropes(document, case)
}

/// Each number in the range of a machine that can be built.
fn check_ranges(document: &Document, case: &CaseFile) -> Result<(), CaseError> {
    let length = 1.0e-3..=100.0;
    let place = -100.0..=100.0;
    let mass = 1.0e-3..=1.0e6;
    let inertia = 1.0e-6..=1.0e8;
    let checks = [
        ("gravity_m_s2", case.gravity_m_s2, 0.0..=100.0, "m/s2"),
        (
            "beam.inertia_kg_m2",
            case.beam.inertia_kg_m2,
            inertia.clone(),
            "kg m2",
        ),
        (
            "beam.gravity_moment_n_m",
            case.beam.gravity_moment_n_m,
            -1.0e6..=1.0e6,
            "N m",
        ),
        (
            "crank.center_x_m",
            case.crank.center_x_m,
            place.clone(),
            "m",
        ),
        (
            "crank.center_y_m",
            case.crank.center_y_m,
            place.clone(),
            "m",
        ),
        ("crank.radius_m", case.crank.radius_m, length.clone(), "m"),
        (
            "crank.counterweight_phase_deg",
            case.crank.counterweight_phase_deg,
            -360.0..=360.0,
            "deg",
        ),
        ("rod.length_m", case.rod.length_m, length.clone(), "m"),
        ("rod.mass_kg", case.rod.mass_kg, mass.clone(), "kg"),
        (
            "rod.center_of_mass_m",
            case.rod.center_of_mass_m,
            place.clone(),
            "m",
        ),
        (
            "rod.inertia_kg_m2",
            case.rod.inertia_kg_m2,
            inertia,
            "kg m2",
        ),
        ("suspension.mass_kg", case.suspension.mass_kg, mass, "kg"),
        ("ropes.diameter_m", case.ropes.diameter_m, 1.0e-3..=0.2, "m"),
        (
            "ropes.cylinder_length_m",
            case.ropes.cylinder_length_m,
            1.0e-3..=1.0,
            "m",
        ),
        (
            "ropes.density_kg_m3",
            case.ropes.density_kg_m3,
            100.0..=3.0e4,
            "kg/m3",
        ),
        (
            "ropes.reference_length_m",
            case.ropes.reference_length_m,
            1.0e-3..=1.0,
            "m",
        ),
        (
            "ropes.back_cylinders",
            case.ropes.back_cylinders as f64,
            2.0..=5000.0,
            "cylinders",
        ),
        (
            "ropes.front_cylinders",
            case.ropes.front_cylinders as f64,
            2.0..=5000.0,
            "cylinders",
        ),
        ("contact.exponent", case.contact.exponent, 1.0..=3.0, ""),
        (
            "contact.full_damping_penetration_m",
            case.contact.full_damping_penetration_m,
            1.0e-7..=0.01,
            "m",
        ),
        (
            "front_head.radius_m",
            case.front_head.radius_m,
            length.clone(),
            "m",
        ),
        (
            "front_head.rope_anchor_deg",
            case.front_head.rope_anchor_deg,
            0.0..=180.0,
            "deg",
        ),
        ("back_head.radius_m", case.back_head.radius_m, length, "m"),
        (
            "back_head.center_x_m",
            case.back_head.center_x_m,
            place.clone(),
            "m",
        ),
        (
            "back_head.center_y_m",
            case.back_head.center_y_m,
            place,
            "m",
        ),
        (
            "back_head.rope_anchor_deg",
            case.back_head.rope_anchor_deg,
            0.0..=360.0,
            "deg",
        ),
        (
            "flexible_head.density_kg_m3",
            case.flexible_head.density_kg_m3,
            100.0..=3.0e4,
            "kg/m3",
        ),
    ];
    for (field, value, range, unit) in checks {
        document.within(field, value, range, unit)?;
    }
    if case.name.trim().is_empty() {
        return Err(document.field(
            &[Step::Key("name")],
            "\"\"",
            "a name of the machine",
            "give the machine a name; it heads every report",
        ));
    }
    Ok(())
}

/// Settings of a run, and the smoothing of the cards.
fn check_run(document: &Document, case: &CaseFile) -> Result<(), CaseError> {
    let run = &case.run;
    document.within(
        "run.output_step_deg",
        run.output_step_deg,
        0.01..=30.0,
        "deg",
    )?;
    document.within("run.lead_in_deg", run.lead_in_deg, 0.0..=3600.0, "deg")?;
    document.within("run.ramp_s", run.ramp_s, 0.0..=600.0, "s")?;
    document.within("run.tolerance", run.tolerance, 1.0e-6..=1.0e3, "")?;
    let count = 360.0 / run.output_step_deg;
    if (count - count.round()).abs() > 1e-9 * count {
        return Err(document.field(
            &[Step::Key("run"), Step::Key("output_step_deg")],
            run.output_step_deg,
            "a step that divides 360 deg",
            &format!("take {} deg, for example", 360.0 / count.round().max(1.0)),
        ));
    }
    for (index, condition) in case.conditions.iter().enumerate() {
        let way = |key| [Step::Key("conditions"), Step::Index(index), Step::Key(key)];
        let bad = match condition.smoothing {
            Smoothing::Harmonics(0) => Some("at least 1 harmonic"),
            Smoothing::MovingAverageDeg(width) if !(width > 0.0 && width < 360.0) => {
                Some("a width above 0 and below 360 deg")
            }
            Smoothing::None | Smoothing::Harmonics(_) | Smoothing::MovingAverageDeg(_) => None,
        };
        if let Some(allowed) = bad {
            return Err(document.field(
                &way("smoothing"),
                format!("{:?}", condition.smoothing),
                allowed,
                "use smoothing = \"none\", { harmonics = 14 } or { moving_average_deg = 5.0 }",
            ));
        }
    }
    Ok(())
}

/// The ropes reach over the whole turn and stay on their arcs.
fn check_ropes(document: &Document, case: &CaseFile) -> Result<Envelope, CaseError> {
    let ropes = &case.ropes;
    let back = ropes.back_cylinders as f64 * ropes.cylinder_length_m;
    let front = ropes.front_cylinders as f64 * ropes.cylinder_length_m;
    let cylinders = |key| [Step::Key("ropes"), Step::Key(key)];
    let envelope = geometry::envelope(case).map_err(|pin| {
        document.field(
            &cylinders("back_cylinders"),
            format!("{} ({back} m of rope)", ropes.back_cylinders),
            format!(
                "enough that rope and rod ({} m) reach from the crank pin to the back head at every \
                 crank angle; they do not at a pin angle of {pin:.0} deg",
                case.rod.length_m
            ),
            "check cylinder count and length, rod.length_m, crank and back_head against each other",
        )
    })?;
    let pitch = ropes.cylinder_length_m;
    let [free, _] = envelope.free_rope_m;
    if free < pitch {
        return Err(document.field(
            &cylinders("back_cylinders"),
            format!("{} ({back} m of rope)", ropes.back_cylinders),
            format!(
                "at least {:.3} m: at one end of the stroke all of it lies on the head",
                back - free + pitch
            ),
            "the rope is shorter than the path it has to cover: add cylinders and shorten the rod, \
             or move rope_anchor_deg",
        ));
    }
    let [contact, _] = envelope.contact_deg;
    if contact <= case.back_head.rope_anchor_deg {
        return Err(document.field(
            &[Step::Key("back_head"), Step::Key("rope_anchor_deg")],
            case.back_head.rope_anchor_deg,
            format!(
                "below {contact:.1} deg, where the rope leaves the head at one end of the stroke"
            ),
            "move the anchor up, or lengthen rod or rope",
        ));
    }
    let [low, _] = envelope.beam_deg;
    if case.front_head.rope_anchor_deg <= -low {
        return Err(document.field(
            &[Step::Key("front_head"), Step::Key("rope_anchor_deg")],
            case.front_head.rope_anchor_deg,
            format!(
                "above {:.1} deg, where the rope leaves the head with the front down",
                -low
            ),
            "move the anchor up along the arc",
        ));
    }
    let [hang, _] = envelope.hang_m;
    if hang < pitch {
        return Err(document.field(
            &cylinders("front_cylinders"),
            format!("{} ({front} m of rope)", ropes.front_cylinders),
            format!(
                "at least {:.3} m: at the top of the stroke all of it lies on the head",
                front - hang + pitch
            ),
            "the rope is shorter than the path it has to cover: add cylinders",
        ));
    }
    Ok(envelope)
}

/// The anchor and the contact's whole travel lie on the arc of the reduced head.
pub(super) fn check_arc(
    document: &Document,
    case: &CaseFile,
    arc_deg: &[f64],
    envelope: &Envelope,
) -> Result<(), CaseError> {
    let (Some(from), Some(to)) = (arc_deg.first(), arc_deg.last()) else {
        return Ok(());
    };
    let anchor = case.back_head.rope_anchor_deg;
    if !(from..=to).contains(&&anchor) {
        return Err(document.field(
            &[Step::Key("back_head"), Step::Key("rope_anchor_deg")],
            anchor,
            format!(
                "{from} to {to} deg: the rope arc of {}",
                case.flexible_head.modes_file.display()
            ),
            "fix the rope on the arc, or reduce the head with a longer arc",
        ));
    }
    let [_, contact] = envelope.contact_deg;
    if contact > *to {
        return Err(document.field(
            &[Step::Key("back_head"), Step::Key("radius_m")],
            case.back_head.radius_m,
            format!(
                "a head whose contact stays on the arc of {} ({from} to {to} deg); it reaches {contact:.1} deg",
                case.flexible_head.modes_file.display()
            ),
            "check back_head, crank and rod against each other, or reduce the head with a longer arc",
        ));
    }
    Ok(())
}
