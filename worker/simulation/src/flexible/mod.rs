//! Model reduction of the flexible back head: from a mesh of bricks or tetrahedra to modes and static
//! influence lines.
//!
//! Linear elasticity with the pin holes held. The result is all that the dynamics needs of the head: natural
//! modes evaluated along the rope arc, gauge stress, inertial coupling, exact statics. Input and output are
//! plain numbers in SI units; the module knows neither files nor the rest of the machine.
mod arc;
mod assembly;
mod cholesky;
mod coupling;
mod eigen;
mod element;
mod elimination;
mod error;
mod gauge;
mod mesh;
mod problem;
mod reduction;
mod request;
mod result;
mod surface;
mod sway;
#[cfg(test)]
mod tests;

pub use element::{ElementKind, Steel};
pub use error::ReductionError;
pub use gauge::Gauge;
pub use mesh::Mesh;
pub use reduction::reduce;
pub use request::{Family, Pair, ReductionRequest, SurfaceLoads, Wrap};
pub use result::{LeftOut, Mode, Reduction, SurfacePoint, SurfaceStress, SwayTables};
