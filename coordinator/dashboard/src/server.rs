//! Routes of the server, and the stream of changed sections.
use super::{
    access::{Access, guard},
    board::{PageReader, PageState, Rendered, Version},
    page,
};
use axum::{
    Router,
    extract::{Path, Query, State},
    http::{HeaderMap, HeaderName, StatusCode, Uri, header},
    middleware,
    response::{
        Html, IntoResponse, Redirect, Response,
        sse::{Event, KeepAlive, Sse},
    },
    routing::get,
};
use futures_util::{Stream, stream};
use std::{
    collections::{BTreeMap, VecDeque},
    convert::Infallible,
    io,
    sync::Arc,
    time::Duration,
};
use tokio::{net::TcpListener, time::sleep};

/// Minimum time between two groups of events to one reader.
const PACE: Duration = Duration::from_millis(300);
/// Header in which a browser that reconnects states the id of the last event that it received.
const LAST_EVENT_ID: HeaderName = HeaderName::from_static("last-event-id");

/// Pages that a server shows.
pub trait Pages: Send + Sync + 'static {
    /// Returns the start page: that of a run, or of a folder of runs.
    fn start(&self) -> PageReader;

    /// Returns the page of a run of the folder by its name; `None` if there is no such run.
    fn run(&self, name: &str) -> Option<PageReader>;

    /// Returns the HTML of one individual of a run by its number; `None` if there is no such run or
    /// individual. The name is empty for the run of the start page.
    fn individual(&self, run: &str, number: u64) -> impl Future<Output = Option<String>> + Send;
}

/// Serves pages at a listening socket, to requests that carry the token, until `end` is completed. The token is that
/// of the query of the address which the user opens, `?token=TOKEN`, and consists of letters and digits.
///
/// # Errors
/// If the socket fails.
pub async fn serve<P: Pages>(
    listener: TcpListener,
    token: &str,
    pages: Arc<P>,
    end: impl Future<Output = ()> + Send + 'static,
) -> io::Result<()> {
    let access = Access::new(listener.local_addr()?, token);
    let routes = Router::new()
        .route("/", get(start::<P>))
        .route("/events", get(start_events::<P>))
        .route("/individual/{number}", get(start_individual::<P>))
        .route("/runs/{name}", get(with_slash))
        .route("/runs/{name}/", get(run::<P>))
        .route("/runs/{name}/events", get(run_events::<P>))
        .route("/runs/{name}/individual/{number}", get(run_individual::<P>))
        .route("/page.js", get(script))
        .fallback(async || not_found("There is no such page."))
        .layer(middleware::from_fn_with_state(access, guard))
        .with_state(pages);
    let ended = async move {
        tokio::select! {
            () = end => {}
            // streams of events never end by themselves, and are cut
            served = axum::serve(listener, routes) => served?,
        }
        Ok(())
    };
    ended.await
}

fn not_found(message: &str) -> Response {
    (StatusCode::NOT_FOUND, Html(page::missing(message))).into_response()
}

async fn script() -> impl IntoResponse {
    (
        [(header::CONTENT_TYPE, "text/javascript; charset=utf-8")],
        report::script(),
    )
}

async fn start<P: Pages>(State(pages): State<Arc<P>>) -> Html<String> {
    let reader = pages.start();
    let snapshot = reader.borrow().clone();
    Html(page::page(&snapshot, None))
}

async fn run<P: Pages>(State(pages): State<Arc<P>>, Path(name): Path<String>) -> Response {
    match pages.run(&name) {
        Some(reader) => {
            let snapshot = reader.borrow().clone();
            Html(page::page(&snapshot, Some("/"))).into_response()
        }
        None => not_found(&format!("There is no run {name} in this folder.")),
    }
}

/// Leads from `/runs/NAME` to `/runs/NAME/`, below which the addresses on the page lie.
async fn with_slash(uri: Uri) -> Redirect {
    let query = uri
        .query()
        .map_or_else(String::new, |query| format!("?{query}"));
    Redirect::permanent(&format!("{}/{query}", uri.path()))
}

async fn start_individual<P: Pages>(
    State(pages): State<Arc<P>>,
    Path(number): Path<u64>,
) -> Response {
    individual(&*pages, "", number).await
}

async fn run_individual<P: Pages>(
    State(pages): State<Arc<P>>,
    Path((name, number)): Path<(String, u64)>,
) -> Response {
    individual(&*pages, &name, number).await
}

async fn individual<P: Pages>(pages: &P, run: &str, number: u64) -> Response {
    match pages.individual(run, number).await {
        Some(html) => Html(html).into_response(),
        None => not_found("There is no such individual."),
    }
}

async fn start_events<P: Pages>(
    State(pages): State<Arc<P>>,
    Query(query): Query<BTreeMap<String, String>>,
    headers: HeaderMap,
) -> Response {
    answer(pages.start(), &query, &headers)
}

async fn run_events<P: Pages>(
    State(pages): State<Arc<P>>,
    Path(name): Path<String>,
    Query(query): Query<BTreeMap<String, String>>,
    headers: HeaderMap,
) -> Response {
    match pages.run(&name) {
        Some(reader) => answer(reader, &query, &headers),
        None => not_found(&format!("There is no run {name} in this folder.")),
    }
}

/// Answers a request for events: those after the version that a reconnecting browser states, or that the page
/// states in its first request.
fn answer(reader: PageReader, query: &BTreeMap<String, String>, headers: &HeaderMap) -> Response {
    let known = headers
        .get(LAST_EVENT_ID)
        .and_then(|value| value.to_str().ok());
    let known = known.or_else(|| query.get("after").map(String::as_str));
    let known = known.and_then(|text| text.parse().ok());
    Sse::new(events(reader, known.unwrap_or_default()))
        .keep_alive(KeepAlive::default())
        .into_response()
}

/// What one reader of a page has been sent.
struct Reading {
    page: PageReader,
    /// Version that the reader's page shows.
    known: Version,
    /// Revision of each section that was sent.
    sent: BTreeMap<String, u64>,
    /// Header of the page as it was sent last.
    header: String,
    waiting: VecDeque<Event>,
    first: bool,
}

/// Returns the stream of a page's changes: at first the sections that changed after the known version, then each
/// section as it changes. Sections that change faster than the reader takes them are skipped.
fn events(page: PageReader, known: Version) -> impl Stream<Item = Result<Event, Infallible>> {
    let reading = Reading {
        page,
        known,
        sent: BTreeMap::new(),
        header: String::new(),
        waiting: VecDeque::new(),
        first: true,
    };
    stream::unfold(reading, async |mut reading| {
        loop {
            if let Some(event) = reading.waiting.pop_front() {
                return Some((Ok(event), reading));
            }
            if !reading.first {
                // the page's owner is gone: the browser asks again
                reading.page.changed().await.ok()?;
                sleep(PACE).await;
            }
            reading.first = false;
            let snapshot = reading.page.borrow_and_update().clone();
            reading.collect(&snapshot);
        }
    })
}

impl Reading {
    /// Collects the events that bring the reader's page up to date. The last one alone carries the version: a reader
    /// whose connection is cut before has not seen all of it.
    fn collect(&mut self, snapshot: &PageState) {
        let sections = snapshot.sections.iter();
        let order: Vec<_> = sections.map(|own| [&own.id, &own.title]).collect();
        let header = serde_json::json!({
            "title": snapshot.title,
            "run": snapshot.run,
            "state": snapshot.state,
            "sections": order,
        })
        .to_string();
        let mut events = Vec::new();
        for section in &snapshot.sections {
            if self.is_new(section, snapshot.version.board) {
                self.sent.insert(section.id.clone(), section.revision);
                let data = serde_json::json!({ "id": section.id, "html": section.html });
                events.push(Event::default().event("section").data(data.to_string()));
            }
        }
        if header != self.header {
            events.push(Event::default().event("header").data(header.as_str()));
            self.header = header;
        }
        let last = events.pop();
        let last = last.map(|last| last.id(snapshot.version.to_string()));
        self.waiting.extend(events.into_iter().chain(last));
    }

    fn is_new(&self, section: &Rendered, board: u64) -> bool {
        match self.sent.get(&section.id) {
            Some(revision) => *revision != section.revision,
            None => self.known.board != board || section.revision > self.known.revision,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::board::Board;
    use report::{Block, Section};

    fn section(id: &'static str, text: &str) -> Section {
        Section {
            id,
            title: id,
            blocks: vec![Block::Text(text.to_owned())],
        }
    }

    /// Returns the events that a reader gets who knows a version.
    fn sent(page: &PageReader, known: Version) -> Vec<String> {
        let mut reading = Reading {
            page: page.clone(),
            known,
            sent: BTreeMap::new(),
            header: String::new(),
            waiting: VecDeque::new(),
            first: true,
        };
        let snapshot = page.borrow().clone();
        reading.collect(&snapshot);
        let events = reading.waiting.iter();
        events.map(|event| format!("{event:?}")).collect()
    }

    /// Checks that a reader whose connection is cut in the middle of a batch gets all of it again, and that one who comes
    /// from another board gets everything. Regressions: all events of a batch carried its version; versions were
    /// positions in the journal, which begins anew where a run is deleted and begun again.
    #[test]
    fn nothing_is_missed_after_a_cut() {
        let mut board = Board::new("Calibration", "runs/a");
        let page = board.reader();
        let both = [section("a", "1"), section("b", "1")];
        board.publish(("Calibration", "running"), &both, false);
        let first = page.borrow().version;
        let all = sent(&page, Version::default());
        assert_eq!(all.len(), 3, "two sections and the header");
        let with_version: Vec<bool> = all
            .iter()
            .map(|one| one.contains(&first.to_string()))
            .collect();
        assert_eq!(with_version, [false, false, true]);
        let both = [section("a", "1"), section("b", "2")];
        board.publish(("Calibration", "running"), &both, false);
        assert_eq!(sent(&page, first).len(), 2, "what changed, and the header");
        assert_eq!(sent(&page, page.borrow().version).len(), 1);
        let elsewhere = Version {
            board: first.board + 1,
            revision: 1000,
        };
        assert_eq!(sent(&page, elsewhere).len(), 3);
    }
}
