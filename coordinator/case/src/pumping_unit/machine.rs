//! Consistency checks on the numbers of a `case.toml`: the output step divides a turn, and the ropes are long
//! enough over the whole turn and stay on their arcs. The range of each number was checked before.
use super::{
    geometry::{self, Envelope},
    schema::{CaseFile, ConditionEntry},
};
use crate::{
    document::{Document, DocumentStep},
    error::{CaseError, contradiction},
};
use protocol::pumping_unit::Smoothing;

/// Checks that the numbers of a case file are consistent with each other, without reading its other files;
/// returns the extreme values of the rigid kinematics.
///
/// # Errors
/// Returns an error for the first number that contradicts others.
pub(super) fn check(document: &Document, case: &CaseFile) -> Result<Envelope, CaseError> {
    if case.name.trim().is_empty() {
        return Err(document.field(
            &[DocumentStep::Key("name")],
            "\"\"",
            "a name of the machine",
            "give the machine a name; it heads every report",
        ));
    }
    check_output_step(document, case.run.output_step_deg)?;
    check_smoothing(document, &case.conditions)?;
    check_ropes(document, case)
}

/// Checks that the output step divides a turn into whole steps.
fn check_output_step(document: &Document, step: f64) -> Result<(), CaseError> {
    let count = 360.0 / step;
    if (count - count.round()).abs() > 1e-9 * count {
        return Err(document.field(
            &[
                DocumentStep::Key("run"),
                DocumentStep::Key("output_step_deg"),
            ],
            step,
            "a step that divides 360 deg",
            &format!("take {} deg, for example", plain_step(step)),
        ));
    }
    Ok(())
}

/// Checks that the smoothing of the load cards is valid.
fn check_smoothing(document: &Document, conditions: &[ConditionEntry]) -> Result<(), CaseError> {
    for (index, condition) in conditions.iter().enumerate() {
        let keys = |key| {
            [
                DocumentStep::Key("conditions"),
                DocumentStep::Index(index),
                DocumentStep::Key(key),
            ]
        };
        let bad = match condition.smoothing {
            Smoothing::Harmonics(0) => Some("at least 1 harmonic"),
            Smoothing::MovingAverageDeg(width) if !(width > 0.0 && width < 360.0) => {
                Some("a width above 0 and below 360 deg")
            }
            Smoothing::None | Smoothing::Harmonics(_) | Smoothing::MovingAverageDeg(_) => None,
        };
        if let Some(allowed) = bad {
            return Err(document.field(
                &keys("smoothing"),
                format!("{:?}", condition.smoothing),
                allowed,
                "use smoothing = \"none\", { harmonics = 14 } or { moving_average_deg = 5.0 }",
            ));
        }
    }
    Ok(())
}

/// Returns the divisor of 360 with few decimals that is nearest to a given output step, to be suggested in a
/// message \[deg\].
fn plain_step(step: f64) -> f64 {
    let plain = [
        0.1, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.75, 0.8, 0.9, 1.0, 1.2, 1.5, 2.0, 2.5, 3.0,
    ];
    let more = [
        4.0, 5.0, 6.0, 7.5, 8.0, 9.0, 10.0, 12.0, 15.0, 18.0, 20.0, 24.0, 30.0,
    ];
    let all = plain.into_iter().chain(more);
    all.min_by(|a, b| (a - step).abs().total_cmp(&(b - step).abs()))
        .unwrap_or(0.5)
}

/// Checks that the ropes are long enough over the whole turn and stay on their arcs.
fn check_ropes(document: &Document, case: &CaseFile) -> Result<Envelope, CaseError> {
    let ropes = &case.ropes;
    let back = ropes.back_cylinders as f64 * ropes.cylinder_length_m;
    let front = ropes.front_cylinders as f64 * ropes.cylinder_length_m;
    let cylinders = |key| [DocumentStep::Key("ropes"), DocumentStep::Key(key)];
    let envelope = geometry::envelope(case).map_err(|pin| open_loop(document, case, pin))?;
    let pitch = ropes.cylinder_length_m;
    let [lowest, highest] = envelope.beam_deg;
    // the path that a rope has to cover grows with the swing, and that with the crank
    let crank = format!(
        "; or correct crank.radius_m = {}, if a swing of {:.1} deg is not this machine's",
        case.crank.radius_m,
        highest - lowest
    );
    let [free, _] = envelope.free_rope_m;
    if free < pitch {
        return Err(document.field(
            &cylinders("back_cylinders"),
            format!("{} ({back:.3} m of rope)", ropes.back_cylinders),
            format!(
                "at least {:.3} m: at one end of the stroke all of it lies on the head",
                back - free + pitch
            ),
            &format!(
                "the rope is shorter than the path it has to cover: add cylinders and shorten the rod, \
                 or move rope_anchor_deg{crank}"
            ),
        ));
    }
    let [contact, _] = envelope.contact_deg;
    if contact <= case.back_head.rope_anchor_deg {
        return Err(document.field(
            &cylinders("back_cylinders"),
            format!("{} ({back:.3} m of rope)", ropes.back_cylinders),
            format!(
                "more: at one end of the stroke the rope would leave the head at {contact:.1} deg, \
                 beyond its anchor at {} deg",
                case.back_head.rope_anchor_deg
            ),
            &format!(
                "rope and rod are shorter than the path they have to cover: add cylinders, lengthen \
                 rod.length_m, or move back_head.rope_anchor_deg{crank}"
            ),
        ));
    }
    if case.front_head.rope_anchor_deg <= -lowest {
        return Err(document.field(
            &[
                DocumentStep::Key("front_head"),
                DocumentStep::Key("rope_anchor_deg"),
            ],
            case.front_head.rope_anchor_deg,
            format!(
                "above {:.1} deg, where the rope leaves the head with the front down",
                -lowest
            ),
            "move the anchor up along the arc",
        ));
    }
    let [hang, _] = envelope.hang_m;
    if hang < pitch {
        return Err(document.field(
            &cylinders("front_cylinders"),
            format!("{} ({front:.3} m of rope)", ropes.front_cylinders),
            format!(
                "at least {:.3} m: at the top of the stroke all of it lies on the head",
                front - hang + pitch
            ),
            &format!("the rope is shorter than the path it has to cover: add cylinders{crank}"),
        ));
    }
    Ok(envelope)
}

/// Builds the error for a crank that cannot complete a turn, because at a pin angle \[deg\] no beam angle
/// closes the loop of crank, rod, rope and head.
fn open_loop(document: &Document, case: &CaseFile, pin: f64) -> CaseError {
    let back = case.ropes.back_cylinders as f64 * case.ropes.cylinder_length_m;
    contradiction(
        &document.path,
        "the loop of crank, rod, back rope and back head",
        format!("open at a pin angle of {pin:.0} deg"),
        format!(
            "the crank has to turn through: crank.radius_m = {}, its centre ({}, {}) m, rod.length_m = {}, \
             ropes.back_cylinders = {} ({back:.3} m of rope), back_head.radius_m = {}, its centre \
             ({}, {}) m",
            case.crank.radius_m,
            case.crank.center_x_m,
            case.crank.center_y_m,
            case.rod.length_m,
            case.ropes.back_cylinders,
            case.back_head.radius_m,
            case.back_head.center_x_m,
            case.back_head.center_y_m
        ),
        "one of these is wrong, or in another unit: rod and rope must reach from the crank pin to \
         the head at every crank angle",
    )
}

/// Checks that the beam with both heads has at least the inertia of the flexible head's mass at half its radius.
pub(super) fn check_inertia(
    document: &Document,
    case: &CaseFile,
    head_mass_kg: f64,
) -> Result<(), CaseError> {
    let least = head_mass_kg * (0.5 * case.back_head.radius_m).powi(2);
    if case.beam.inertia_kg_m2 >= least {
        return Ok(());
    }
    Err(document.field(
        &[DocumentStep::Key("beam"), DocumentStep::Key("inertia_kg_m2")],
        case.beam.inertia_kg_m2,
        format!(
            "at least {least:.0} kg m2: the {head_mass_kg:.0} kg of {} at half of back_head.radius_m",
            case.flexible_head.modes_file.display()
        ),
        "state the inertia of the beam with both heads about the saddle bearing in kg m2 (t m2 times 1000)",
    ))
}

/// Checks that the rope's anchor and all its contact points over a turn lie on the arc covered by the tables
/// of the reduced head.
pub(super) fn check_contact_on_arc(
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
            &[
                DocumentStep::Key("back_head"),
                DocumentStep::Key("rope_anchor_deg"),
            ],
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
            &[DocumentStep::Key("back_head"), DocumentStep::Key("radius_m")],
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
