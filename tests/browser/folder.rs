//! A folder of runs of the oscillator: finished, diagnosed, stopped, damaged and foreign ones.
use super::{
    Site, below,
    driver::{Browser, LIMIT},
    picture, shown, socket_address,
};
use oscillator::{case_folder, effect::Effects};
use rustix::process::Signal;
use serde_json::Value;
use std::{
    fs,
    io::{Read as _, Write as _},
    net::TcpStream,
    path::Path,
    time::Duration,
};
use tests::process::{Process, coordinator_program, wait_until};

/// Copies the files of a folder, without its folders.
pub(crate) fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        if entry.file_type().unwrap().is_file() {
            fs::copy(entry.path(), to.join(entry.file_name())).unwrap();
        }
    }
}

/// Returns the first line of the answer to a request.
fn status(url: &str, request: &str) -> String {
    let address = socket_address(url);
    let mut stream = TcpStream::connect(address).unwrap();
    stream
        .set_read_timeout(Some(Duration::from_secs(10)))
        .unwrap();
    let (_, token) = url.split_once('?').unwrap();
    let request = request.replace("ADDRESS", address).replace("TOKEN", token);
    stream.write_all(request.as_bytes()).unwrap();
    let mut answer = vec![0; 200];
    let length = stream.read(&mut answer).unwrap();
    let text = String::from_utf8_lossy(&answer[..length]).into_owned();
    text.lines().next().unwrap().to_owned()
}

/// Returns a site with a case of the oscillator in which friction is hidden.
pub(crate) fn oscillator_site() -> Site {
    let worker = coordinator_program().with_file_name("test-oscillator-worker");
    assert!(worker.exists(), "`cargo build` makes it");
    let site = Site::new(Some(worker));
    let effects = Effects {
        friction_n: case_folder::FRICTION_N,
        ..Effects::default()
    };
    case_folder::write(&site.path("case"), &case_folder::HIDDEN, &effects, 0).unwrap();
    site
}

#[test]
fn a_folder_shows_finished_stopped_damaged_foreign_and_deleted_runs() {
    let Some(browser) = Browser::start() else {
        return;
    };
    let site = oscillator_site();
    site.run(&["calibrate", "case", "--run", "runs/good"]);
    // with a page of its own, which ends with the command
    let diagnosed = site.run(&["diagnose", "case", "--run", "runs/named", "--dashboard=0"]);
    let told = String::from_utf8_lossy(&diagnosed.stderr);
    let line = told.lines().find(|line| line.starts_with("dashboard: "));
    let own = line.unwrap().trim_start_matches("dashboard: ");
    assert!(
        TcpStream::connect(socket_address(own)).is_err(),
        "{own} is still served"
    );
    stop_in_the_middle(&site);
    damage(&site);
    fs::create_dir(site.path("runs/empty")).unwrap();

    fs::create_dir(site.path("temporary")).unwrap();
    let (server, url) = site.dashboard("runs");
    browser.open(&url);
    browser.wait_for(
        "all runs are listed",
        "return document.querySelectorAll('#runs tbody tr').length === 5",
    );
    let table = browser.text("#runs");
    let (good, named) = (site.result("runs/good"), site.result("runs/named"));
    let objective = shown(&good["objective"]["optimised"]);
    let effect = &named["effects"][0];
    let title = effect["title"].as_str().unwrap();
    for text in [&objective, &format!("named: {title}"), "stopped"] {
        assert!(table.contains(text), "{text}: {table}");
    }
    every_row_is_complete(&browser);
    fits_every_window(&browser);
    browser.picture((1200, 600), &picture("folder"));
    browser.script("document.querySelector('a[href=\"/runs/good/\"]').click()");
    browser.wait_for_state("finished");
    assert!(browser.text("#summary").contains(&objective));

    browser.open(&below(&url, "runs/named/"));
    browser.wait_for_state("finished");
    let verdict = browser.text("#verdict");
    let sizes = effect["parameters"].as_object().unwrap();
    let size = shown(&sizes.values().next().unwrap()["value"]);
    for text in ["The simulation lacks", &size, "these data speak for"] {
        assert!(verdict.contains(text), "{text}: {verdict}");
    }
    browser.picture((1200, 1100), &picture("diagnosis"));

    shows_runs_in_trouble(&browser, &site, &url);
    rests_while_it_is_hidden(&browser, &site, &url);
    assert_eq!(browser.console(), Vec::<String>::new());
    refuses_requests(&url);
    leaves_nothing(&browser, &site, server, &url);
}

/// Checks that runs that have ended are not called running, that calibrations show their result, and stopped runs the
/// number of their evaluations.
fn every_row_is_complete(browser: &Browser) {
    let cell = |run: &str, label: &str| {
        browser.text(&format!(
            "#runs tr:has(a[href='/runs/{run}/']) td[data-label='{label}']"
        ))
    };
    // a run of another machine is seen by its journal, which counts as growing for ten seconds
    browser.wait_for(
        "the killed run is stopped",
        "return document.querySelector(\"#runs tr:has(a[href='/runs/stopped/']) td[data-label='state']\")\
         .textContent === 'stopped'",
    );
    for (run, state) in [("good", "finished"), ("named", "finished")] {
        assert_eq!(cell(run, "state"), state, "{run}");
    }
    for run in ["good", "named", "stopped"] {
        let evaluations = cell(run, "evaluations");
        let digits: String = evaluations.chars().filter(char::is_ascii_digit).collect();
        assert!(digits.parse::<u64>().unwrap() > 10, "{run}: {evaluations}");
    }
    let result = cell("good", "result");
    assert!(
        result.starts_with("objective ") && result.contains(" → "),
        "{result}"
    );
    assert!(
        cell("named", "wall time").contains(" s"),
        "{}",
        cell("named", "wall time")
    );
}

/// Checks that no cell of the list is cut off and no name wrapped to many lines, in a wide window, a middle one and on a
/// phone.
fn fits_every_window(browser: &Browser) {
    // as long as the names of runs become
    browser.script(
        "const name = document.querySelector('#runs tbody a'); window.short = name.textContent; \
         name.textContent = 'cyjs10-5-37hb-quick-genes-0123abcd-with-stuffing-box-friction-seed1';",
    );
    for (width, lines) in [(1200, 2), (800, 3), (390, 3)] {
        browser.picture((width, 700), &picture(&format!("folder-{width}")));
        let cut = browser.script(
            "const right = document.documentElement.clientWidth; \
             return [...document.querySelectorAll('#runs td, #runs th a')] \
             .filter(cell => cell.offsetParent && cell.getBoundingClientRect().right > right + 1) \
             .map(cell => cell.textContent);",
        );
        assert_eq!(cut, Value::Array(Vec::new()), "at {width}");
        let wrapped = browser.script(
            "const name = document.querySelector('#runs tbody a'); \
             return Math.round(name.getBoundingClientRect().height / parseFloat(getComputedStyle(name).lineHeight));",
        );
        assert!(
            wrapped.as_u64().unwrap() <= lines,
            "{wrapped} lines at {width}"
        );
    }
    browser.script("document.querySelector('#runs tbody a').textContent = window.short;");
}

/// Checks that a page that is not visible gives its connection back, and catches up when it is looked at again.
/// Regression: each page kept its connection, and a browser opens six to one server, so that a seventh page never loaded.
fn rests_while_it_is_hidden(browser: &Browser, site: &Site, url: &str) {
    browser.open(url);
    let rows = "document.querySelectorAll('#runs tbody tr').length";
    // the list may be of before the last run began
    browser.wait_for("the runs are listed", &format!("return {rows} === 5"));
    let hide = |hidden: bool| {
        browser.script(&format!(
            "Object.defineProperty(document, 'hidden', {{ value: {hidden}, configurable: true }}); \
             document.dispatchEvent(new Event('visibilitychange'));"
        ));
    };
    hide(true);
    copy(&site.path("runs/good"), &site.path("runs/copy"));
    // longer than the interval at which the folder is read
    std::thread::sleep(Duration::from_secs(4));
    assert_eq!(browser.script(&format!("return {rows}")), 5);
    hide(false);
    browser.wait_for("the copy is listed", &format!("return {rows} === 6"));
}

/// Checks that an individual is simulated, and that nothing of it stays in the temporary folder when the dashboard ends.
fn leaves_nothing(browser: &Browser, site: &Site, server: Process, url: &str) {
    browser.open(&below(url, "runs/good/"));
    browser.wait_for_state("finished");
    browser.script("document.querySelector('tr[data-individual]').click()");
    browser.wait_for(
        "an individual is simulated",
        "return document.querySelector('#individual section') !== null",
    );
    let left = || fs::read_dir(site.path("temporary")).unwrap().count();
    assert!(left() > 0, "the individual is simulated in a temporary run");
    server.signal(Signal::INT);
    wait_until("the temporary run is removed", LIMIT, || left() == 0);
    drop(server);
}

/// Begins a run and kills its coordinator after some results.
fn stop_in_the_middle(site: &Site) {
    let words = [
        "calibrate",
        "case",
        "--preset",
        "memetic",
        "--run",
        "runs/stopped",
    ];
    let coordinator = Process::logged(site.command(&words), &site.path("memetic.log"));
    let journal = site.path("runs/stopped/journal.hhj");
    wait_until("results are stored", LIMIT, || {
        fs::metadata(&journal).is_ok_and(|file| file.len() > 200_000)
    });
    coordinator.signal(Signal::KILL);
}

/// Copies a finished run twice: with zeros in the middle of its journal, and with the version of every record
/// raised.
fn damage(site: &Site) {
    let change = |name: &str, change: &dyn Fn(&mut [u8])| {
        copy(&site.path("runs/good"), &site.path(name));
        let journal = site.path(name).join("journal.hhj");
        let mut bytes = fs::read(&journal).unwrap();
        change(&mut bytes);
        fs::write(&journal, &bytes).unwrap();
    };
    change("runs/damaged", &|bytes| {
        let middle = bytes.len() / 2;
        bytes[middle..middle + 40].fill(0);
    });
    change("runs/foreign", &|bytes| {
        for at in 0..bytes.len() - 4 {
            if bytes[at..].starts_with(b"HHJ") {
                bytes[at + 3] += 1;
            }
        }
    });
}

/// Checks the pages of a damaged run, of one of another version, and of one that is deleted under its page.
fn shows_runs_in_trouble(browser: &Browser, site: &Site, url: &str) {
    browser.open(&below(url, "runs/damaged/"));
    browser.wait_for_state("incomplete");
    let notices = browser.text("#notices");
    assert!(
        notices.contains("are damaged and were skipped"),
        "{notices}"
    );
    assert!(!browser.text("#convergence").is_empty());

    browser.open(&below(url, "runs/foreign/"));
    browser.wait_for(
        "the other version is named",
        "return document.getElementById('sections').innerText.includes('is of version')",
    );

    browser.open(&below(url, "runs/stopped/"));
    browser.wait_for_state("stopped");
    browser.wait_for(
        "its results are shown",
        "return document.querySelectorAll('tr[data-individual]').length > 50",
    );
    fs::remove_dir_all(site.path("runs/stopped")).unwrap();
    browser.wait_for_state("deleted");
    assert!(!browser.text("#convergence").is_empty());
    // another run takes its place, under the page that is open
    let words = [
        "calibrate",
        "case",
        "--preset",
        "descent",
        "--run",
        "runs/stopped",
    ];
    site.run(&words);
    browser.wait_for_state("finished");
    let objective = shown(&site.result("runs/stopped")["objective"]["optimised"]);
    assert!(
        browser.text("#summary").contains(&objective),
        "{}",
        browser.text("#summary")
    );
}

/// Checks the answers to requests that pages of other sites could make, or that would change something.
fn refuses_requests(url: &str) {
    let own = "GET /?TOKEN HTTP/1.1\r\nHost: ADDRESS\r\n\r\n";
    assert!(status(url, own).contains("200"));
    for (request, code) in [
        (
            "POST /?TOKEN HTTP/1.1\r\nHost: ADDRESS\r\nContent-Length: 0\r\n\r\n",
            "405",
        ),
        ("GET /?TOKEN HTTP/1.1\r\nHost: other.example\r\n\r\n", "403"),
        (
            "GET /events?TOKEN HTTP/1.1\r\nHost: ADDRESS\r\nOrigin: http://other.example\r\n\r\n",
            "403",
        ),
        (
            "GET /runs/..%2f..%2fetc/?TOKEN HTTP/1.1\r\nHost: ADDRESS\r\n\r\n",
            "404",
        ),
        (
            "GET /runs/empty/?TOKEN HTTP/1.1\r\nHost: ADDRESS\r\n\r\n",
            "404",
        ),
        (
            "GET /runs/good?TOKEN HTTP/1.1\r\nHost: ADDRESS\r\n\r\n",
            "308",
        ),
        ("GET / HTTP/1.1\r\nHost: ADDRESS\r\n\r\n", "403"),
        (
            "GET /individual/1?TOKEN HTTP/1.1\r\nHost: ADDRESS\r\nSec-Fetch-Site: same-site\r\n\r\n",
            "403",
        ),
    ] {
        let line = status(url, request);
        assert!(line.contains(code), "{request}: {line}");
    }
}
