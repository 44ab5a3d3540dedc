//! Linear statistics of a model about its fitted point: projection on the complement of the tangent space,
//! score tests of signatures, log evidence and isolability. The module contains algebra alone and knows
//! neither effects nor simulations.
pub mod discrepancy;
pub mod evidence;
pub mod isolability;
pub mod score;
pub(crate) mod stack;
pub(crate) mod subset;
pub mod tangent;
pub(crate) mod waves;
pub mod whitened;
