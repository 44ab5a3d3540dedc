//! Report section on the provenance of the diagnosis: everything needed to reproduce it.
use crate::diagnosis::subject::{DiagnosisInput, channels};
use crate::document::{Block, Fact, Section};
use crate::number::duration;
use crate::section::origin;
use crate::words::condition_name;

pub(super) fn section(subject: &DiagnosisInput<'_>) -> Section {
    let mut facts = origin::facts(&subject.origin, subject.case);
    facts.extend(subject.diagnosed.records.iter().map(|record| {
        let name = condition_name(subject.case, record.condition);
        let (cycles, channels) = (record.cycles.len(), channels(record).join(", "));
        Fact::new(
            format!("record of {name}"),
            format!("{cycles} cycles of {channels}"),
        )
    }));
    let library = subject.diagnosed.result.library.iter();
    let named = library.filter(|effect| !effect.generic).count();
    let forces = subject.diagnosed.result.library.len() - named;
    facts.extend([
        Fact::new(
            "library",
            format!("{named} named effects, {forces} forces without a cause"),
        ),
        Fact::new("wall time", duration(subject.wall_s)),
    ]);
    let digest = &subject.origin.digest;
    facts.extend((!digest.is_empty()).then(|| Fact::code("digest of the result", digest)));
    origin::section(vec![Block::Facts(facts)])
}
