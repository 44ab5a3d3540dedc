//! What `--output json` prints: exactly one object per command. The fields are a contract with
//! other programs; more may be added, none renamed. Numbers that are not finite become `null`.
pub(in crate::cli) mod calibration;
pub(in crate::cli) mod diagnosis;
pub(in crate::cli) mod head;
pub(in crate::cli) mod score;
pub(in crate::cli) mod simulation;
#[cfg(test)]
mod tests;
