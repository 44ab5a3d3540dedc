//! Validation of a machine description.
use crate::model::description::{Description, Twins};
use crate::model::kinematics::DoesNotClose;
use crate::model::layout::MAX_MODES;

/// Error: a description from which no machine can be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InvalidDescription {
    /// Number in the description that must be positive and finite, but is not.
    #[error("{what} is {value}; it must be a positive number")]
    NotPositive {
        /// Name of the number in the description that is not positive.
        what: &'static str,
        /// Value of the number that is not positive, in SI units.
        value: f64,
    },
    /// Table in the description with the wrong number of values.
    #[error("{what}: {found} entries found, {expected} expected")]
    Shape {
        /// Name of the table with the wrong number of values.
        what: &'static str,
        /// Number of values found in the table.
        found: usize,
        /// Number of values expected in the table.
        expected: usize,
    },
    /// Quantity in the description (for example the number of head modes) above the maximum that a simulation
    /// supports.
    #[error("{what}: {found} given, at most {most} can be simulated")]
    TooMany {
        /// Name of the quantity above its maximum.
        what: &'static str,
        /// Value of the quantity found in the description.
        found: usize,
        /// Maximum of the quantity that a simulation supports.
        most: usize,
    },
    /// Mechanism whose crank cannot make a full turn.
    #[error("the crank cannot make a full turn: {0}")]
    Mechanism(#[from] DoesNotClose),
}

/// Checks that a machine with `modes` in-plane modes can be built from a description.
pub(super) fn check(d: &Description, modes: usize) -> Result<(), InvalidDescription> {
    let positive: [(&'static str, f64); 14] = [
        ("gravity", d.gravity),
        ("beam inertia", d.beam_inertia),
        ("crank radius", d.crank.radius),
        ("crank speed", d.crank.speed),
        ("rod length", d.rod.length),
        ("rod mass", d.rod.mass),
        ("rod inertia", d.rod.inertia),
        ("suspension mass", d.suspension_mass),
        ("rope diameter", d.rope.diameter),
        ("cylinder length", d.rope.pitch),
        ("rope density", d.rope.density),
        ("reference length", d.rope.reference_pitch),
        ("front radius", d.front_arc.radius),
        ("back radius", d.back_arc.radius),
    ];
    for (what, value) in positive {
        check_positive(what, value)?;
    }
    check_tables(d, modes)?;
    d.twins
        .as_ref()
        .map_or(Ok(()), |twins| check_twins(d, twins, modes))
}

fn check_positive(what: &'static str, value: f64) -> Result<(), InvalidDescription> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(InvalidDescription::NotPositive { what, value })
}

fn check_size(what: &'static str, found: usize, expected: usize) -> Result<(), InvalidDescription> {
    if found == expected {
        return Ok(());
    }
    Err(InvalidDescription::Shape {
        what,
        found,
        expected,
    })
}

/// Checks the head's tables, the number of cylinders and the number of load card samples in a description.
fn check_tables(d: &Description, modes: usize) -> Result<(), InvalidDescription> {
    let head = &d.head;
    for (what, found, least) in [
        ("radial shapes", head.radial.len(), modes),
        ("tangential shapes", head.tangential.len(), modes),
        ("head frequencies", head.frequencies.len(), modes),
        ("gauge stresses", head.gauge_stress.len(), modes),
        ("participations", head.participation.len(), modes),
        ("back rope", d.rope.back, 3),
        ("front rope", d.rope.front, 3),
        ("load card", d.card.len(), 8),
    ] {
        check_size(what, found.min(least), least)?;
    }
    let tangential = head.tangential_influence.len();
    check_size("normal influence lines", head.normal_influence.len(), 4)?;
    check_size("tangential influence lines", tangential, 4)?;
    let stations = head.radial.first().map_or(0, Vec::len);
    let mut shapes = head.radial.iter().chain(&head.tangential);
    shapes.try_for_each(|shape| check_size("mode shape", shape.len(), stations))
}

/// Checks the twin ropes' parameters and the head's antisymmetric tables in a description.
fn check_twins(d: &Description, twins: &Twins, modes: usize) -> Result<(), InvalidDescription> {
    check_positive("distance of twin ropes from the plane", twins.offset)?;
    let sway = &twins.sway;
    let count = sway.frequencies.len();
    if modes + count > MAX_MODES {
        return Err(InvalidDescription::TooMany {
            what: "in-plane and out-of-plane head modes together",
            found: modes + count,
            most: MAX_MODES,
        });
    }
    let lines = d.head.normal_influence.first().map_or(0, Vec::len);
    let stations = d.head.radial.first().or(sway.radial.first());
    let stations = stations.map_or(0, Vec::len);
    for (family, sizes, tables) in [
        (
            [
                "radial shapes out of the plane",
                "tangential shapes out of the plane",
                "lateral shapes",
            ],
            [count, stations],
            [&sway.radial, &sway.tangential, &sway.lateral],
        ),
        (
            [
                "normal influence lines of twin ropes",
                "tangential influence lines of twin ropes",
                "lateral influence lines",
            ],
            [4, lines],
            [
                &sway.normal_influence,
                &sway.tangential_influence,
                &sway.lateral_influence,
            ],
        ),
    ] {
        let [rows, entries] = sizes;
        for (what, table) in family.into_iter().zip(tables) {
            check_size(what, table.len(), rows)?;
            let mut rows = table.iter();
            rows.try_for_each(|row| check_size(what, row.len(), entries))?;
        }
    }
    let found = sway.gauge_stress.len();
    check_size("gauge stresses out of the plane", found, count)
}
