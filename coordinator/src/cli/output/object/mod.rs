//! What `--output json` prints: exactly one object per command. The fields are a contract with
//! other programs; more may be added, none renamed. Numbers that are not finite become `null`.
pub(crate) mod calibration;
pub(in crate::cli) mod diagnosis;
pub(in crate::cli) mod identification;
pub(crate) mod orthogonal;
pub(crate) mod score;
pub(crate) mod scored;
pub(crate) mod simulation;
