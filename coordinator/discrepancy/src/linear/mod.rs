//! Statistics of a model that is linear about its fit: what recalibration absorbs, tests of
//! signatures, evidence, and what could be told apart. Algebra alone: it knows neither effects nor
//! simulations.
pub mod evidence;
pub mod isolability;
pub mod score;
pub(crate) mod stack;
pub(crate) mod subset;
pub mod tangent;
