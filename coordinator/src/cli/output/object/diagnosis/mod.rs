//! JSON object printed by `horsehead diagnose CASE --output json`. Its format is stable: fields may be added
//! but not renamed.
pub(in crate::cli) mod answer;
mod effects;
mod gap;
mod localisation;
mod parameter_drift;
#[cfg(test)]
mod tests;
