//! The flexible back head: from a mesh of bricks or tetrahedra to modes and static influence lines.
//!
//! Linear elasticity with the pin holes held. What comes out is all that the dynamics need of the
//! head: natural modes seen along the rope arc, gauge stress, inertial coupling, exact statics.
//! Plain numbers in SI units come in and go out; nothing here knows of files or of the machine.
mod answer;
mod arc;
mod assembly;
mod cholesky;
mod coupling;
mod eigen;
mod element;
mod error;
mod gauge;
mod mesh;
mod problem;
mod reduction;
mod request;
mod sway;
#[cfg(test)]
mod tests;

pub use answer::{LeftOut, Mode, Reduction, SwayTables};
pub use element::{ElementKind, Steel};
pub use error::ReductionError;
pub use gauge::Gauge;
pub use mesh::Mesh;
pub use reduction::reduce;
pub use request::{Family, Pair, Request, Wrap};
