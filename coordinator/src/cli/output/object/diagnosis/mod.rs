//! JSON object printed by `horsehead diagnose CASE --output json`. Stable format: fields may be added, not
//! renamed.
pub(in crate::cli) mod answer;
mod effects;
mod gap;
mod localisation;
mod parameter_drift;
#[cfg(test)]
mod tests;
pub(in crate::cli) mod times;
