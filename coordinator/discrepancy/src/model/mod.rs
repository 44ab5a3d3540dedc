//! Models and their fits: the unknowns of the case, nuisance parameters and parameters of added effects,
//! their fits to a record, and the simulations that a fit needs. The module does not know how an effect acts.
pub(crate) mod change;
pub mod experiments;
pub(crate) mod fit;
pub(crate) mod off;
pub(crate) mod parameter;
pub mod probe;
pub(crate) mod tolerated;
pub(crate) mod unknowns;

pub use fit::Fit;
pub use off::Off;
pub use parameter::{absent, at_typical, bounds, shapes, sizes};
pub use tolerated::Tolerated;
pub use unknowns::{Model, Point};
