//! JSON objects printed by `--output json`, exactly one per command. Stable format: fields may be added, not
//! renamed. Numbers that are not finite become `null`.
pub(crate) mod calibration;
pub(in crate::cli) mod diagnosis;
pub(in crate::cli) mod identification;
pub(crate) mod orthogonal;
pub(crate) mod score;
pub(crate) mod scored;
pub(crate) mod simulation;
