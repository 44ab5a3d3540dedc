//! What is fitted, and how: the case's unknowns, nuisances and the parameters of added effects, fits of
//! them to a record, and the experiments that a fit takes. What an effect does it does not know.
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
