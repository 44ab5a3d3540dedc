//! Sections of one page, published by the owner of a run and read by any number of readers.
use report::Section;
use report::document::section_markup;
use std::{
    collections::BTreeMap,
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
    /// Position in the journal at which the section last changed (bytes).
    pub position: u64,
    /// Number of the publication in which the section last changed.
    pub revision: u64,
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
    /// Position in the journal that the page shows (bytes).
    pub position: u64,
    /// Sections in page order.
    pub sections: Vec<Arc<Rendered>>,
}

/// Reader's end of a page.
pub type PageReader = watch::Receiver<Arc<PageState>>;

/// Writer's end of a page.
#[derive(Debug)]
pub struct Board {
    shown: watch::Sender<Arc<PageState>>,
    revision: u64,
    published: BTreeMap<String, Instant>,
}

impl Board {
    /// Creates an empty page.
    pub fn new(title: &str, run: &str) -> Self {
        let first = PageState {
            title: title.to_owned(),
            run: run.to_owned(),
            ..PageState::default()
        };
        Self {
            shown: watch::Sender::new(Arc::new(first)),
            revision: 0,
            published: BTreeMap::new(),
        }
    }

    /// Returns a reader of the page.
    pub fn reader(&self) -> PageReader {
        self.shown.subscribe()
    }

    /// Publishes the sections of the page at a position of the journal. Large sections that changed a short
    /// time ago are kept as they are, unless `last` states that no further publication follows.
    pub fn publish(
        &mut self,
        (title, state): (&str, &str),
        position: u64,
        sections: &[Section],
        last: bool,
    ) {
        self.revision += 1;
        let before = self.shown.borrow().clone();
        let now = Instant::now();
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
                        position,
                        revision: self.revision,
                    })
                }
            }
        });
        let snapshot = PageState {
            title: title.to_owned(),
            run: before.run.clone(),
            state: state.to_owned(),
            position,
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
            10,
            &[section("a", "1"), section("b", "1")],
            false,
        );
        board.publish(
            ("Calibration", "running"),
            20,
            &[section("a", "1"), section("b", "2")],
            false,
        );
        let seen = reader.borrow().clone();
        let revisions: Vec<_> = seen.sections.iter().map(|one| one.revision).collect();
        let positions: Vec<_> = seen.sections.iter().map(|one| one.position).collect();
        assert_eq!((revisions, positions), (vec![1, 2], vec![10, 20]));
        assert_eq!(seen.position, 20);
    }

    #[test]
    fn large_sections_wait_except_at_the_end() {
        let mut board = Board::new("Calibration", "runs/a");
        let reader = board.reader();
        let large = |mark: &str| section("large", &mark.repeat(3 * LARGE));
        let shown = || reader.borrow().sections[0].html.contains('y');
        board.publish(("", ""), 1, &[large("x")], false);
        board.publish(("", ""), 2, &[large("y")], false);
        assert!(!shown());
        board.publish(("", ""), 3, &[large("y")], true);
        assert!(shown());
    }
}
