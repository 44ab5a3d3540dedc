//! Force laws between two markers, or between a point and a surface, independent of bodies, coordinates and
//! integrators.
//!
//! The bushing is the only law between two markers: between cylinders, and pinned, revolute or clamped at a
//! rope's ends. Its tangent, its energy, action and reaction, and its independence of the frame are tested
//! for each of these (`contract`).
pub mod bushing;
#[cfg(test)]
mod contract;
pub mod impact;
pub mod plane;
