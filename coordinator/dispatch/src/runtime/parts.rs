//! Parts of a run that do not depend on its link: the scheduler core, initialised from the journal, and the
//! journal.
use super::{divide::Divide, error::DispatchError, options::DispatchOptions};
use crate::scheduler::{Core, CoreOptions, Policy};
use journal::{Journal, StudyEntries, WriterReport};
use link::Blob;
use protocol::{
    id::{RunId, draw},
    wire,
};
use std::{
    collections::BTreeSet,
    sync::Arc,
    time::{Duration, SystemTime, UNIX_EPOCH},
};
use tokio::sync::mpsc::{UnboundedReceiver, unbounded_channel};

/// Journal and scheduler core of a run, independent of its link.
pub(super) struct Parts {
    pub(super) run: RunId,
    pub(super) core: Core,
    pub(super) journal: Journal,
    pub(super) said: UnboundedReceiver<WriterReport>,
    pub(super) blob: Blob,
    pub(super) pause_limit: Duration,
    pub(super) divide: Arc<dyn Divide>,
}

impl Parts {
    /// Opens or creates the journal, and initialises the core from it; also returns the entries of the study.
    pub(super) fn open(options: &DispatchOptions) -> Result<(Self, StudyEntries), DispatchError> {
        let now = SystemTime::now()
            .duration_since(UNIX_EPOCH)
            .unwrap_or_default();
        let place = format!("{}:{}", options.run_dir.display(), std::process::id());
        let fresh = RunId(draw(&place, now.as_nanos()));
        let (say, said) = unbounded_channel();
        let at_unix_ms = u64::try_from(now.as_millis()).unwrap_or(u64::MAX);
        let folder = &options.run_dir;
        let (journal, begun) = Journal::open(
            folder,
            &options.header,
            fresh,
            at_unix_ms,
            move |appended| {
                // at the very end nobody listens any more
                drop(say.send(appended));
            },
        )?;
        for damage in journal::describe_damage(&begun.report.damage) {
            tracing::warn!("{damage}");
        }
        let blob = Blob::new(wire::encode(&options.case)?);
        let core = Core::new(CoreOptions {
            run: begun.run,
            epoch: begun.epoch,
            case: blob.hash,
            case_bytes: blob.bytes.len() as u64,
            model: options.case.model.kind.clone(),
            model_digest: begun.model_digest,
            repeats: options.case.model.repeats,
            proof: begun.proof,
            finished: journal.finished().collect(),
            // local workers end with their coordinator
            expected: if options.access.listen.is_some() {
                begun.present
            } else {
                BTreeSet::new()
            },
            policy: Policy {
                pause_limit: options.pause_limit,
                ..Policy::of(&options.case)
            },
        });
        let parts = Self {
            run: begun.run,
            core,
            journal,
            said,
            blob,
            pause_limit: options.pause_limit,
            divide: Arc::clone(&options.divide),
        };
        Ok((parts, begun.entries))
    }
}
