//! Force laws: what two markers, or a point and a surface, do to each other. They know nothing of
//! bodies, coordinates or integrators.
pub mod bushing;
pub mod impact;
pub mod plane;
