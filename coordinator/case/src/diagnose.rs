//! `[diagnose]` table of a case file: settings of a diagnosis that belong to the case.
use serde::Deserialize;
use std::num::NonZeroU32;

/// `[diagnose]` table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DiagnoseEntry {
    /// Total budget of a diagnosis in plain simulations; `None` for the budget that grows with the case.
    pub simulations: Option<NonZeroU32>,
}
