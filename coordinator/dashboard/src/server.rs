//! Routes of the server, and the stream of changed sections.
use super::{
    access::{Access, guard},
    board::{PageReader, PageState, Rendered},
    page,
};
use axum::{
    Router,
    extract::{Path, Query, State},
    http::{HeaderMap, HeaderName, StatusCode, header},
    middleware,
    response::{
        Html, IntoResponse, Response,
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

/// Answers a request for events: those after the position that a reconnecting browser states, or that the page
/// states in its first request.
fn answer(reader: PageReader, query: &BTreeMap<String, String>, headers: &HeaderMap) -> Response {
    let known = headers
        .get(LAST_EVENT_ID)
        .and_then(|value| value.to_str().ok());
    let known = known.or_else(|| query.get("after").map(String::as_str));
    let known = known.and_then(|text| text.parse().ok()).unwrap_or(0);
    Sse::new(events(reader, known))
        .keep_alive(KeepAlive::default())
        .into_response()
}

/// What one reader of a page has been sent.
struct Reading {
    page: PageReader,
    /// Position in the journal that the reader's page shows (bytes).
    known: u64,
    /// Revision of each section that was sent.
    sent: BTreeMap<String, u64>,
    /// Header of the page as it was sent last.
    header: String,
    waiting: VecDeque<Event>,
    first: bool,
}

/// Returns the stream of a page's changes: at first the sections that changed at or after a position of the
/// journal, then each section as it changes. Sections that change faster than the reader takes them are skipped.
fn events(page: PageReader, known: u64) -> impl Stream<Item = Result<Event, Infallible>> {
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
    /// Collects the events that bring the reader's page up to date.
    fn collect(&mut self, snapshot: &PageState) {
        let id = snapshot.position.to_string();
        let sections = snapshot.sections.iter();
        let order: Vec<_> = sections.map(|own| [&own.id, &own.title]).collect();
        let header = serde_json::json!({
            "title": snapshot.title,
            "run": snapshot.run,
            "state": snapshot.state,
            "sections": order,
        })
        .to_string();
        for section in &snapshot.sections {
            if self.is_new(section) {
                self.sent.insert(section.id.clone(), section.revision);
                let data = serde_json::json!({ "id": section.id, "html": section.html });
                let event = Event::default().event("section").id(id.as_str());
                self.waiting.push_back(event.data(data.to_string()));
            }
        }
        if header != self.header {
            let event = Event::default().event("header").id(id.as_str());
            self.waiting.push_back(event.data(header.as_str()));
            self.header = header;
        }
    }

    fn is_new(&self, section: &Rendered) -> bool {
        match self.sent.get(&section.id) {
            Some(revision) => *revision != section.revision,
            None => section.position >= self.known,
        }
    }
}
