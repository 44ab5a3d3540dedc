//! What a diagnosis says, in sentences: verdict, grounds, what to do next.
//!
//! Judges nothing: every number is the diagnosis' own.
mod effect;
mod ground;
mod next;
mod value;
mod verdict;

pub(super) use effect::{effects, generic};
pub(super) use ground::{confidence, role};
pub(super) use next::next;
pub(super) use value::{equals, interval, nats, p_value};
pub(super) use verdict::{outcome, verdict};
