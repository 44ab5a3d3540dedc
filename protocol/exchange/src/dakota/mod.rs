//! Dakota's files: parameters passed to a driver, results returned by a driver, and templates with `{name}`
//! fields.
//!
//! Source: Dakota user's manual, chapters on parameters to and responses from simulations.
mod parameters;
mod results;
mod template;

pub use parameters::{Form, Request, parameters};
pub use results::{Results, results};
pub use template::Template;
