//! Files of Dakota: the parameters that it hands a driver, the results that it takes, texts with `{name}`.
//!
//! Source: Dakota user's manual, chapters on parameters to and responses from simulations.
mod parameters;
mod results;
mod template;

pub use parameters::{Form, parameters};
pub use results::{Results, results};
pub use template::Template;
