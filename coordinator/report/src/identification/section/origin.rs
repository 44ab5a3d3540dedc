//! How it was made: enough to make it again.
use crate::document::{Block, Fact, Section};
use crate::identification::subject::Subject;
use crate::number::duration;
use crate::section::origin;

pub(super) fn section(subject: &Subject<'_>) -> Section {
    let mut facts = origin::facts(&subject.origin, subject.case);
    facts.push(Fact::new("wall time", duration(subject.wall_s)));
    origin::section(vec![Block::Facts(facts)])
}
