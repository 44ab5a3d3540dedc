//! Sentences of a diagnosis report: verdict, confidence, next steps.
//!
//! Formats only: every number is taken from the diagnosis.
mod effect;
mod next;
mod reliability;
mod value;
mod verdict;

pub(super) use effect::{effects, generic};
pub(super) use next::next;
pub(super) use reliability::{confidence, data_role, gap_numbers, predictive_scores};
pub(super) use value::{equals, nats, p_value};
pub(super) use verdict::{outcome, verdict};
