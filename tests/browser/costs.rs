//! Costs of the dashboard: a page of 10,000 evaluations and 500 workers, and twenty readers of a run that goes on.
use super::{
    Site,
    driver::{Browser, LIMIT},
    folder::oscillator_site,
};
use journal::Journal;
use journal::event::{Account, Event, Spent, WorkerAccount};
use protocol::id::WorkerId;
use rustix::process::{Pid, Signal};
use std::{
    fs,
    io::{Read as _, Write as _},
    net::TcpStream,
    path::Path,
    thread,
    time::Duration,
};
use tests::process::{Process, wait_until};

/// Evaluations of the large run when its page is opened.
const EVALUATIONS: usize = 10_000;
/// Workers of the large run.
const WORKERS: u64 = 500;
/// Readers of the events of a run.
const READERS: usize = 20;

/// Prints a figure that was measured.
#[expect(clippy::print_stderr, reason = "a measurement is printed")]
fn print_figure(figure: &str) {
    eprintln!("{figure}");
}

/// Writes into the journal of a stopped run that workers have joined, each with an account.
fn add_workers(folder: &Path) {
    let mut begun = None;
    let report = journal::fold(&folder.join(journal::FILE), |_, event| {
        if let Event::Begun { run, header } = event {
            begun = Some((run, header));
        }
    });
    report.unwrap();
    let (run, header) = begun.unwrap();
    let (journal, _) = Journal::open(folder, &header, run, 0, |_| {}).unwrap();
    let row = |worker| WorkerAccount {
        worker: WorkerId(worker),
        host: format!("node-{worker:03}"),
        slots: 2,
        done: 20 + worker,
        failed: worker % 7,
        spent: Spent {
            connected_us: 120_000_000,
            useful_us: 200_000 * worker,
            ..Spent::default()
        },
    };
    for worker in 0..WORKERS {
        let joined = Event::Joined {
            worker: WorkerId(worker),
            host: format!("node-{worker:03}"),
            slots: 2,
            model_digest: String::new(),
        };
        journal.append(joined).unwrap();
    }
    let account = Account {
        epoch: 2,
        at_ms: 60_000,
        workers: (0..WORKERS).map(row).collect(),
    };
    journal.append(Event::Accounted(Box::new(account))).unwrap();
}

/// Returns the processor time that a process has used (s).
fn processor_s(process: Pid) -> f64 {
    let stat = fs::read_to_string(format!("/proc/{}/stat", process.as_raw_nonzero()));
    let stat = stat.unwrap_or_default();
    let (_, rest) = stat.rsplit_once(')').unwrap_or_default();
    let fields: Vec<f64> = rest
        .split_whitespace()
        .skip(11)
        .take(2)
        .filter_map(|field| field.parse().ok())
        .collect();
    // clock ticks of Linux: 100 a second
    fields.iter().sum::<f64>() / 100.0
}

/// Reads events until the connection ends.
fn read_events(url: &str) {
    let (address, (_, token)) = (super::socket_address(url), url.split_once('?').unwrap());
    let mut stream = TcpStream::connect(address).unwrap();
    let request = format!("GET /events?{token} HTTP/1.1\r\nHost: {address}\r\n\r\n");
    stream.write_all(request.as_bytes()).unwrap();
    let mut buffer = vec![0; 1 << 16];
    while stream.read(&mut buffer).is_ok_and(|length| length > 0) {}
}

#[test]
#[ignore = "measures: cargo test -p tests --test browser -- --ignored --nocapture"]
fn a_large_page_and_twenty_readers() {
    let Some(browser) = Browser::start() else {
        return;
    };
    let site = oscillator_site();
    large_page(&site, &browser);
    for round in 0..3 {
        let alone = coordinator_s_a_result(&site, &format!("alone{round}"), false);
        let read = coordinator_s_a_result(&site, &format!("read{round}"), true);
        print_figure(&format!(
            "coordinator: {:.1} us of processor time a result alone, {:.1} us with {READERS} readers, ratio {:.3}",
            1e6 * alone,
            1e6 * read,
            read / alone
        ));
    }
}

fn large_page(site: &Site, browser: &Browser) {
    let words = [
        "calibrate",
        "case",
        "--preset",
        "random",
        "--set",
        "points=14000",
        "--run",
        "large",
    ];
    let coordinator = Process::logged(site.command(&words), &site.path("large.log"));
    let file = site.path("large/journal.hhj");
    let limit = Duration::from_mins(5);
    let mut results = 0;
    wait_until("ten thousand results", limit, || {
        thread::sleep(Duration::from_millis(500));
        results = 0;
        let counted = journal::fold(&file, |_, event| {
            results += usize::from(matches!(event, Event::Finished(_)));
        });
        counted.is_ok() && results >= EVALUATIONS
    });
    coordinator.signal(Signal::KILL);
    drop(coordinator);
    add_workers(&site.path("large"));
    let (server, url) = site.dashboard("large");
    browser.open(&url);
    browser.wait_for(
        "the run is read",
        "return document.querySelectorAll('#live-workers tbody tr').length >= 500 && \
         document.querySelectorAll('tr[data-individual]').length >= 1000",
    );
    browser.open(&url);
    let paint = browser
        .script("return performance.getEntriesByName('first-contentful-paint')[0].startTime");
    let size = browser.script("return document.documentElement.outerHTML.length");
    print_figure(&format!(
        "page of {results} evaluations and {WORKERS} workers: first paint {paint} ms, {size} characters"
    ));
    let before = processor_s(server.pid());
    let going = Process::logged(site.command(&words), &site.path("large2.log"));
    browser.wait_for_state("running");
    browser.script(
        "window.longest = 0; window.tasks = 0; \
         new PerformanceObserver(list => list.getEntries().forEach(task => { \
         window.tasks += 1; window.longest = Math.max(window.longest, task.duration); \
         })).observe({ entryTypes: ['longtask'] });",
    );
    thread::sleep(Duration::from_secs(10));
    let longest = browser.script("return [window.tasks, window.longest]");
    print_figure(&format!(
        "updates in 10 s: [tasks of more than 50 ms, the longest in ms] = {longest}; the dashboard used {:.1} s of processor time",
        processor_s(server.pid()) - before
    ));
    drop(going);
}

/// Runs a calibration and returns the coordinator's own processor time for each result (s).
fn coordinator_s_a_result(site: &Site, run: &str, readers: bool) -> f64 {
    let words = [
        "calibrate",
        "case",
        "--preset",
        "random",
        "--set",
        "points=3000",
        "--workers",
        "1",
        "--run",
        run,
    ];
    let coordinator = Process::logged(site.command(&words), &site.path("costs.log"));
    let begun = site.path(run).join("run.json");
    wait_until("the run begins", LIMIT, || begun.exists());
    let dashboard = readers.then(|| site.dashboard(run));
    if let Some((_, url)) = &dashboard {
        for _ in 0..READERS {
            let url = url.clone();
            thread::spawn(move || read_events(&url));
        }
    }
    let result = site.path(run).join("result.json");
    let mut used = 0.0;
    wait_until("the run ends", Duration::from_mins(5), || {
        thread::sleep(Duration::from_millis(20));
        used = processor_s(coordinator.pid()).max(used);
        result.exists()
    });
    used / 3000.0
}
