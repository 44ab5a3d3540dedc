//! Models and their fits: the unknowns of the case, nuisance parameters and parameters of added effects,
//! their fits to a record, and the simulations that a fit needs. The module does not know how an effect acts.
pub(crate) mod derivative;
pub mod experiments;
pub(crate) mod fit;
pub(crate) mod inactive_unknowns;
pub(crate) mod nuisance_parameter;
pub(crate) mod parameter;
pub mod probe;
pub(crate) mod unknowns;

pub use fit::{Fit, FitSummary};
pub use inactive_unknowns::InactiveUnknowns;
pub use nuisance_parameter::NuisanceParameter;
pub use parameter::{absent, at_typical, bounds, shapes, sizes};
pub use unknowns::{FittedModel, Point};
