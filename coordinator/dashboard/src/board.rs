//! Sections of one page, published by the owner of a run and read by any number of readers.
use report::Section;
use report::document::section_markup;
use std::{
    collections::BTreeMap,
    fmt,
    hash::{BuildHasher as _, RandomState},
    num::ParseIntError,
    str::FromStr,
    sync::Arc,
    time::{Duration, Instant},
};
use tokio::sync::watch;

/// Size of a section from which it is published less often (bytes).
const LARGE: usize = 100_000;
/// Minimum time between two publications of a large section, for each [`LARGE`] bytes of it. With it, readers
/// on the same machine receive at most 100 kB/s for each large section.
const LARGE_INTERVAL: Duration = Duration::from_secs(1);

/// Rendered section of a page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rendered {
    /// Anchor of the section in the page.
    pub id: String,
    /// Heading of the section.
    pub title: String,
    /// HTML element of the section.
    pub html: String,
    /// Number of the publication in which the section last changed.
    pub revision: u64,
}

/// Version of a page: which board published it, and the number of the publication. Readers that come back state
/// it, and are sent what has changed since; from another board, such as that of another dashboard or of a run that
/// took the place of a deleted one, they are sent everything.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Version {
    /// Number of the board, unique among all dashboards.
    pub board: u64,
    /// Number of the publication.
    pub revision: u64,
}

impl fmt::Display for Version {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(to, "{:x}-{}", self.board, self.revision)
    }
}

impl FromStr for Version {
    type Err = ParseIntError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let (board, revision) = text.split_once('-').unwrap_or_default();
        Ok(Self {
            board: u64::from_str_radix(board, 16)?,
            revision: revision.parse()?,
        })
    }
}

/// State of a page at one time.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PageState {
    /// Title of the page.
    pub title: String,
    /// Name of the run, or of the folder of runs.
    pub run: String,
    /// State of the run in a word or two, such as `running`.
    pub state: String,
    /// Version of the page.
    pub version: Version,
    /// Sections in page order.
    pub sections: Vec<Arc<Rendered>>,
}

/// Reader's end of a page.
pub(crate) type PageReader = watch::Receiver<Arc<PageState>>;

/// Writer's end of a page.
#[derive(Debug)]
pub(crate) struct Board {
    shown: watch::Sender<Arc<PageState>>,
    version: Version,
    published: BTreeMap<String, Instant>,
}

impl Board {
    /// Creates an empty page.
    pub(crate) fn new(title: &str, run: &str) -> Self {
        // the random state of a hash map differs from process to process, and from map to map
        let version = Version {
            board: RandomState::new().hash_one(run),
            revision: 0,
        };
        let first = PageState {
            title: title.to_owned(),
            run: run.to_owned(),
            version,
            ..PageState::default()
        };
        Self {
            shown: watch::Sender::new(Arc::new(first)),
            version,
            published: BTreeMap::new(),
        }
    }

    /// Returns a reader of the page.
    pub(crate) fn reader(&self) -> PageReader {
        self.shown.subscribe()
    }

    /// Publishes the sections of the page. Large sections that changed a short
    /// time ago are kept as they are, unless `last` states that no further publication follows.
    pub(crate) fn publish(
        &mut self,
        (title, state): (&str, &str),
        sections: &[Section],
        last: bool,
    ) {
        self.version.revision += 1;
        let before = self.shown.borrow().clone();
        let (now, version) = (Instant::now(), self.version);
        let shown: Vec<&Section> = sections
            .iter()
            .filter(|section| !section.blocks.is_empty())
            .collect();
        let sections = shown.into_iter().map(|section| {
            let old = before.sections.iter().find(|old| old.id == section.id);
            if let Some(old) = old
                && !last
                && self.is_too_early(old, now)
            {
                return Arc::clone(old);
            }
            let html = section_markup(section).into_string();
            match old {
                Some(old) if old.html == html => Arc::clone(old),
                _ => {
                    self.published.insert(section.id.to_owned(), now);
                    Arc::new(Rendered {
                        id: section.id.to_owned(),
                        title: section.title.to_owned(),
                        html,
                        revision: version.revision,
                    })
                }
            }
        });
        let snapshot = PageState {
            title: title.to_owned(),
            run: before.run.clone(),
            state: state.to_owned(),
            version,
            sections: sections.collect(),
        };
        self.shown.send_replace(Arc::new(snapshot));
    }

    fn is_too_early(&self, old: &Rendered, now: Instant) -> bool {
        let sizes = u32::try_from(old.html.len() / LARGE).unwrap_or(u32::MAX);
        let published = self.published.get(&old.id);
        published.is_some_and(|at| now.duration_since(*at) < sizes * LARGE_INTERVAL)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use report::Block;

    fn section(id: &'static str, text: &str) -> Section {
        Section {
            id,
            title: id,
            blocks: vec![Block::Text(text.to_owned())],
        }
    }

    #[test]
    fn only_what_changes_has_a_new_revision() {
        let mut board = Board::new("Calibration", "runs/a");
        let reader = board.reader();
        board.publish(
            ("Calibration", "running"),
            &[section("a", "1"), section("b", "1")],
            false,
        );
        board.publish(
            ("Calibration", "running"),
            &[section("a", "1"), section("b", "2")],
            false,
        );
        let seen = reader.borrow().clone();
        let revisions: Vec<_> = seen.sections.iter().map(|one| one.revision).collect();
        assert_eq!(revisions, [1, 2]);
        assert_eq!(seen.version.revision, 2);
        assert_eq!(seen.version.to_string().parse(), Ok(seen.version));
        let other = Board::new("Calibration", "runs/a").reader();
        assert_ne!(other.borrow().version.board, seen.version.board);
    }

    #[test]
    fn large_sections_wait_except_at_the_end() {
        let mut board = Board::new("Calibration", "runs/a");
        let reader = board.reader();
        let large = |mark: &str| section("large", &mark.repeat(3 * LARGE));
        let shown = || reader.borrow().sections[0].html.contains('y');
        board.publish(("", ""), &[large("x")], false);
        board.publish(("", ""), &[large("y")], false);
        assert!(!shown());
        board.publish(("", ""), &[large("y")], true);
        assert!(shown());
    }
}
