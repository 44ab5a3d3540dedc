//! What a worker must be like to take part in a run, and in which words it is told what is wrong.
use super::state::Core;
use protocol::{
    announce::{Announcement, ModelDescriptor},
    wire,
};

/// How much of a text that cannot be trusted people are shown (characters).
const MOST_SHOWN: usize = 200;

/// More slots than any machine has: a number beyond it is a mistake.
const MOST_SLOTS: u32 = 4096;

/// More workers than any run has: so many are no workers.
const MOST_WORKERS: usize = 16 << 10;

/// Longest name of a machine, a build or a model (bytes).
const MOST_NAME: usize = 255;

/// Longest list of kinds of job, and of models with their effects (bytes, encoded): ten times what ours have.
const MOST_KINDS: usize = 4 << 10;
const MOST_MODELS: usize = 1 << 20;

/// This program's version.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// What no worker of ours would say of itself; it is kept, shown and written down, so there is an
/// end to it.
pub(super) fn malformed(announcement: &Announcement) -> Option<String> {
    let Announcement {
        build,
        host,
        job_kinds,
        models,
        ..
    } = announcement;
    let named = models.iter().flat_map(|model| {
        [
            ("models.kind", &model.kind),
            ("models.digest", &model.digest),
        ]
    });
    for (field, text) in [("host", host), ("build", build)].into_iter().chain(named) {
        if text.len() > MOST_NAME {
            let bytes = text.len();
            return Some(format!(
                "{field} has {bytes} bytes, allowed are {MOST_NAME}"
            ));
        }
        if text.chars().any(char::is_control) {
            return Some(format!("{field} holds control characters"));
        }
    }
    // what cannot be encoded came over no wire
    let bytes = |encoded: Result<Vec<u8>, wire::WireError>| encoded.map_or(0, |it| it.len());
    for (field, bytes, most) in [
        ("job_kinds", bytes(wire::encode(job_kinds)), MOST_KINDS),
        ("models", bytes(wire::encode(models)), MOST_MODELS),
    ] {
        if bytes > most {
            return Some(format!("{field} has {bytes} bytes, allowed are {most}"));
        }
    }
    None
}

/// What keeps a worker from taking part in this run, with the remedy.
pub(super) fn objection(core: &Core, announcement: &Announcement) -> Option<String> {
    const SAME: &str = "use the same build of horsehead and horsehead-worker on every machine";
    let Announcement {
        protocol,
        build,
        slots,
        ..
    } = announcement;
    if *protocol != wire::VERSION {
        return Some(format!(
            "protocol is {protocol}, this coordinator speaks {}: {SAME}",
            wire::VERSION
        ));
    }
    if build.split(' ').next() != Some(VERSION) {
        return Some(format!(
            "build is {build}, this coordinator's is {VERSION}: {SAME}"
        ));
    }
    if !(1..=MOST_SLOTS).contains(slots) {
        return Some(format!(
            "slots is {slots}, allowed are 1 to {MOST_SLOTS}: set --slots"
        ));
    }
    if core.members.len() >= MOST_WORKERS {
        return Some(format!(
            "workers are {MOST_WORKERS} already: start fewer, with more slots"
        ));
    }
    if core.options.model.is_empty() {
        return None;
    }
    let Some(model) = model(core, announcement) else {
        let kinds = announcement.models.iter();
        let kinds: Vec<&str> = kinds.map(|model| model.kind.as_str()).collect();
        return Some(format!(
            "models has no `{}`, which the case of this run is of; it has {}: start a worker program \
             that simulates it",
            core.options.model,
            shown(&kinds.join(", "))
        ));
    };
    if let Some(expected) = &core.options.model_digest
        && *expected != model.digest
    {
        return Some(format!(
            "model digest is {}, this run's is {expected}: {SAME}",
            model.digest
        ));
    }
    if let Some(expected) = &core.effects {
        let names: Vec<&String> = model.effects.iter().map(|effect| &effect.id).collect();
        let differs = |name: &&String| !expected.contains(*name);
        let more = names.iter().copied().find(differs);
        let fewer = expected.iter().find(|name| !names.contains(name));
        let difference = match (more, fewer) {
            (Some(more), _) => format!("{more} that the others do not know"),
            (None, Some(fewer)) => format!("no {fewer}, which the others know"),
            (None, None) => return None,
        };
        return Some(format!("effects has {difference}: {SAME}"));
    }
    None
}

/// The beginning of a text of somebody else, without what a terminal would obey.
pub(super) fn shown(text: &str) -> String {
    let plain = text.chars().filter(|letter| !letter.is_control());
    plain.take(MOST_SHOWN).collect()
}

/// How a worker simulates the kind of model that the run's case is of; none if it does not.
pub(super) fn model<'a>(
    core: &Core,
    announcement: &'a Announcement,
) -> Option<&'a ModelDescriptor> {
    let mut models = announcement.models.iter();
    models.find(|model| model.kind == core.options.model)
}
