//! The object that `horsehead diagnose CASE --output json` prints: a contract, more may be added.
pub(in crate::cli) mod answer;
mod effects;
mod gap;
mod place;
#[cfg(test)]
mod tests;
pub(in crate::cli) mod times;
mod wander;
