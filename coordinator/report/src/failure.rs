//! Descriptions of why a simulation failed: one line for each kind of model that provides some.
use protocol::{job::Identifier, pumping_unit::failure};

const ALL: &[&[(Identifier, &str)]] = &[&failure::ALL];

/// Returns the description of a failure code, from the kind of model that defines it.
pub(crate) fn failure(word: Identifier) -> Option<&'static str> {
    let mut known = ALL.iter().copied().flatten();
    known.find(|(own, _)| *own == word).map(|(_, words)| *words)
}
