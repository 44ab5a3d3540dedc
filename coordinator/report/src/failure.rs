//! What ended a simulation, in words: one line for each kind of model that has words.
use protocol::{job::Word, pumping_unit::failure};

const ALL: &[&[(Word, &str)]] = &[&failure::ALL];

/// What ended a simulation, in words of the kind that knows it.
pub(crate) fn failure(word: Word) -> Option<&'static str> {
    let mut known = ALL.iter().copied().flatten();
    known.find(|(own, _)| *own == word).map(|(_, words)| *words)
}
