//! Force laws: what two markers, or a point and a surface, do to each other. They know nothing of
//! bodies, coordinates or integrators.
//!
//! A new element between two markers costs one file and one line in [`CATALOGUE`]; its tangent,
//! energy, action and reaction and its independence of the frame are then tested with those of all
//! others (`contract`).
pub mod bushing;
#[cfg(test)]
mod contract;
pub mod impact;
pub mod plane;
pub mod stop;

use bushing::{Bushing, LinkLoad, LinkTangent, Marker};
use impact::Impact;
use std::fmt::Debug;
use stop::Stop;

/// A force element between marker I and marker J.
pub trait ForceElement: Debug {
    /// Force and torques at a motion.
    fn load(&self, i: &Marker, j: &Marker) -> LinkLoad;

    /// Derivatives of the load by the motion of I and of J; `load` is that of the same motion.
    fn tangent(&self, i: &Marker, j: &Marker, load: &LinkLoad) -> [LinkTangent; 2];

    /// Stored energy \[J\].
    fn energy(&self, i: &Marker, j: &Marker) -> f64;
}

/// An element of the catalogue.
#[derive(Clone, Copy, Debug)]
pub struct ElementInfo {
    /// Name.
    pub name: &'static str,
    /// What it does, in a sentence.
    pub summary: &'static str,
    /// Where its equations come from.
    pub reference: &'static str,
    /// One with coefficients that are neither zero nor alike.
    pub example: fn() -> Box<dyn ForceElement>,
    /// One whose forces at rest derive exactly from its energy.
    pub conservative: fn() -> Box<dyn ForceElement>,
}

/// Every element between two markers.
pub static CATALOGUE: [ElementInfo; 2] = [
    ElementInfo {
        name: "bushing",
        summary: "Six linear springs and dampers, alike across the axis.",
        reference: "paper, Eqs. 1-3",
        example: || Box::new(example_bushing()),
        conservative: || {
            Box::new(Bushing {
                rotational_stiffness: [2.3; 2],
                ..example_bushing()
            })
        },
    },
    ElementInfo {
        name: "stop",
        summary: "One-sided contact of a point with a plane; a model of the arcs' contact, for proofs.",
        reference: "paper, Eqs. 4 and 6",
        example: || Box::new(example_stop()),
        conservative: || Box::new(example_stop()),
    },
];

const fn example_bushing() -> Bushing {
    Bushing {
        stiffness: [7.0, 3.0],
        damping: [0.9, 0.4],
        rotational_stiffness: [1.7, 2.3],
        rotational_damping: [0.6, 0.8],
        preload: 0.35,
    }
}

const fn example_stop() -> Stop {
    Stop {
        law: Impact {
            stiffness: 11.0,
            exponent: 1.7,
            damping: 0.6,
            full_damping_penetration: 0.9,
        },
    }
}
