//! What a description must have to be a machine.
use crate::model::description::{Description, Twins};
use crate::model::kinematics::DoesNotClose;
use crate::model::layout::MAX_MODES;

/// A description that cannot be a machine.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InvalidDescription {
    /// A number that must be positive and finite is not.
    #[error("{what} is {value}; it must be a positive number")]
    NotPositive {
        /// Which number.
        what: &'static str,
        /// Its value, SI.
        value: f64,
    },
    /// A table has the wrong size.
    #[error("{what} has {found} entries; expected {expected}")]
    Shape {
        /// Which table.
        what: &'static str,
        /// Entries found.
        found: usize,
        /// Entries expected.
        expected: usize,
    },
    /// There is more of something than a simulation takes.
    #[error("{what} are {found}; at most {most} can be simulated")]
    TooMany {
        /// Of what.
        what: &'static str,
        /// Entries found.
        found: usize,
        /// The most there may be.
        most: usize,
    },
    /// The mechanism does not turn through.
    #[error("the crank cannot turn through: {0}")]
    Mechanism(#[from] DoesNotClose),
}

/// Whether a description with so many modes in the plane is a machine.
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
        if !(value > 0.0 && value.is_finite()) {
            return Err(InvalidDescription::NotPositive { what, value });
        }
    }
    check_tables(d, modes)?;
    d.twins
        .as_ref()
        .map_or(Ok(()), |twins| check_twins(d, twins, modes))
}

/// The head has what its modes and its gauges need.
fn check_tables(d: &Description, modes: usize) -> Result<(), InvalidDescription> {
    let stations = d.head.radial.first().map_or(0, Vec::len);
    let sizes = [
        ("radial shapes", d.head.radial.len().min(modes), modes),
        (
            "tangential shapes",
            d.head.tangential.len().min(modes),
            modes,
        ),
        (
            "head frequencies",
            d.head.frequencies.len().min(modes),
            modes,
        ),
        (
            "gauge stresses",
            d.head.gauge_stress.len().min(modes),
            modes,
        ),
        (
            "participations",
            d.head.participation.len().min(modes),
            modes,
        ),
        ("normal influence lines", d.head.normal_influence.len(), 4),
        (
            "tangential influence lines",
            d.head.tangential_influence.len(),
            4,
        ),
        ("back rope", d.rope.back.min(3), 3),
        ("front rope", d.rope.front.min(3), 3),
        ("load card", d.card.len().min(8), 8),
    ];
    for (what, found, expected) in sizes {
        if found != expected {
            return Err(InvalidDescription::Shape {
                what,
                found,
                expected,
            });
        }
    }
    for table in d.head.radial.iter().chain(&d.head.tangential) {
        if table.len() != stations {
            return Err(InvalidDescription::Shape {
                what: "mode shape",
                found: table.len(),
                expected: stations,
            });
        }
    }
    Ok(())
}

/// A pair of ropes, and a head that has tables for it.
fn check_twins(d: &Description, twins: &Twins, modes: usize) -> Result<(), InvalidDescription> {
    let value = twins.offset;
    if !(value > 0.0 && value.is_finite()) {
        let what = "distance of twin ropes from the plane";
        return Err(InvalidDescription::NotPositive { what, value });
    }
    let sway = &twins.sway;
    let count = sway.frequencies.len();
    if modes + count > MAX_MODES {
        return Err(InvalidDescription::TooMany {
            what: "head modes of both families",
            found: modes + count,
            most: MAX_MODES,
        });
    }
    let lines = d.head.normal_influence.first().map_or(0, Vec::len);
    let stations = d.head.radial.first().map(Vec::len);
    let stations = stations.or(sway.radial.first().map(Vec::len)).unwrap_or(0);
    let tables = [
        (
            "radial shapes out of the plane",
            &sway.radial,
            count,
            stations,
        ),
        (
            "tangential shapes out of the plane",
            &sway.tangential,
            count,
            stations,
        ),
        ("lateral shapes", &sway.lateral, count, stations),
        (
            "normal influence lines of a pair",
            &sway.normal_influence,
            4,
            lines,
        ),
        (
            "tangential influence lines of a pair",
            &sway.tangential_influence,
            4,
            lines,
        ),
        ("lateral influence lines", &sway.lateral_influence, 4, lines),
    ];
    for (what, table, rows, entries) in tables {
        let wrong = table.iter().map(Vec::len).find(|&found| found != entries);
        let rows = (table.len() != rows).then_some((table.len(), rows));
        if let Some((found, expected)) = rows.or(wrong.map(|found| (found, entries))) {
            return Err(InvalidDescription::Shape {
                what,
                found,
                expected,
            });
        }
    }
    if sway.gauge_stress.len() != count {
        return Err(InvalidDescription::Shape {
            what: "gauge stresses out of the plane",
            found: sway.gauge_stress.len(),
            expected: count,
        });
    }
    Ok(())
}
