//! Rules that a worker must meet to join a run, with the messages sent to refused workers.
use super::state::Core;
use protocol::{
    announce::{Announcement, ModelDescriptor},
    wire,
};

/// Maximum length of untrusted text that is displayed (characters).
const MOST_SHOWN: usize = 200;

/// Maximum number of slots of a worker; a larger number is taken for a mistake.
const MOST_SLOTS: u32 = 4096;

/// Maximum number of workers of a run, as protection against floods of announcements.
const MOST_WORKERS: usize = 16 << 10;

/// Maximum length of the name of a host, build or model in a worker's announcement (bytes).
const MOST_NAME: usize = 255;

/// Maximum encoded length of the list of job kinds (bytes), ten times the usual length; `MOST_MODELS` is that
/// of the list of models with their effects.
const MOST_KINDS: usize = 4 << 10;
const MOST_MODELS: usize = 1 << 20;

/// Version of this program.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Returns what is malformed in an announcement, if anything. Announcements are stored, displayed and
/// recorded, so their sizes are bounded.
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
                "{field} has {bytes} bytes, at most {MOST_NAME} are allowed"
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
            return Some(format!(
                "{field} has {bytes} bytes, at most {most} are allowed"
            ));
        }
    }
    None
}

/// Returns the reason why a worker may not join this run, with the remedy; `None` if it may.
pub(super) fn refusal_reason(core: &Core, announcement: &Announcement) -> Option<String> {
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
            "slots is {slots}, but must be 1 to {MOST_SLOTS}: set --slots"
        ));
    }
    if core.members.len() >= MOST_WORKERS {
        return Some(format!(
            "the run already has {MOST_WORKERS} workers: start fewer workers with more slots each"
        ));
    }
    if core.options.model.is_empty() {
        return None;
    }
    let Some(model) = model(core, announcement) else {
        let kinds = announcement.models.iter();
        let kinds: Vec<&str> = kinds.map(|model| model.kind.as_str()).collect();
        return Some(format!(
            "models has no `{}`, which is the model kind of this run's case; the worker has \
             {}: start a worker program that simulates that kind",
            core.options.model,
            if kinds.is_empty() {
                "none".to_owned()
            } else {
                sanitized(&kinds.join(", "))
            }
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
            (Some(more), _) => format!("`{more}`, which the other workers do not have"),
            (None, Some(fewer)) => format!("no `{fewer}`, which the other workers have"),
            (None, None) => return None,
        };
        return Some(format!("effects has {difference}: {SAME}"));
    }
    None
}

/// Returns the beginning of an untrusted text without control characters.
pub(super) fn sanitized(text: &str) -> String {
    let plain = text.chars().filter(|letter| !letter.is_control());
    plain.take(MOST_SHOWN).collect()
}

/// Returns the worker's descriptor of the model kind of the run's case; `None` if it does not simulate that
/// kind.
pub(super) fn model<'a>(
    core: &Core,
    announcement: &'a Announcement,
) -> Option<&'a ModelDescriptor> {
    let mut models = announcement.models.iter();
    models.find(|model| model.kind == core.options.model)
}
