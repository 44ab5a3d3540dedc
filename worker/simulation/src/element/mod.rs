//! Force laws: what two markers, or a point and a surface, do to each other. They know nothing of
//! bodies, coordinates or integrators.
//!
//! The bushing is the one law between two markers: between cylinders, and pinned, revolute or clamped at
//! a rope's ends. Its tangent, energy, action and reaction and its independence of the frame are proved
//! for each of these (`contract`).
pub mod bushing;
#[cfg(test)]
mod contract;
pub mod impact;
pub mod plane;
