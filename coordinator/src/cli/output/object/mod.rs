//! JSON objects printed by `--output json`, exactly one per command. Their format is stable: fields may be
//! added but not renamed. Numbers that are not finite become `null`.
pub(crate) mod calibration;
pub(in crate::cli) mod diagnosis;
pub(in crate::cli) mod identification;
pub(crate) mod orthogonal;
#[cfg(test)]
mod pumping_unit_tests;
pub(crate) mod score;
pub(crate) mod scored;
pub(crate) mod simulation;
