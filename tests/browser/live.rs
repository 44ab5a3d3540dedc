//! A calibration of the shipped machine under an open page: it goes on, its coordinator is killed and started again,
//! and it ends.
use super::{Site, driver::Browser, picture, shown};
use rustix::process::Signal;
use serde_json::Value;
use std::path::Path;
use tests::process::Process;

/// Number of evaluations in the first row of the page's progress.
const EVALUATIONS: &str =
    "Number(document.querySelector('#progress dd').textContent.split(' ')[0].replace(/\\D/g, ''))";

#[test]
fn a_page_follows_a_run_that_is_killed_and_resumed_to_its_end() {
    let Some(browser) = Browser::start() else {
        return;
    };
    let site = Site::new(None);
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb");
    let words = [
        "calibrate",
        case.to_str().unwrap(),
        "--preset",
        "random",
        "--set",
        "points=40",
        "--workers",
        "1",
        "--run",
        "a",
    ];
    // the page may be opened before the run has begun
    let coordinator = Process::logged(site.command(&words), &site.path("first.log"));
    let runs = site.path("a/run.json");
    tests::process::wait_until("the run begins", super::driver::LIMIT, || runs.exists());
    let (_server, url) = site.dashboard("a");
    browser.open(&url);
    browser.wait_for_state("running");
    browser.wait_for(
        "results arrive",
        &format!("return document.querySelector('#progress dd') !== null && {EVALUATIONS} >= 2"),
    );
    // the best individual so far, simulated by the dashboard's own worker
    browser.wait_for(
        "the machine is drawn",
        "return document.querySelector('#machine-turn') !== null",
    );
    assert!(!browser.text("#figure-convergence figcaption").is_empty());
    browser.picture((1200, 1000), &picture("live"));

    // a person moves the machine, filters and sorts; a section that is replaced keeps it
    browser.script(
        "const turn = document.getElementById('machine-turn'); turn.value = 90; \
         turn.dispatchEvent(new Event('input')); \
         const filter = document.getElementById('individuals-filter'); filter.value = 'individual<2'; \
         filter.dispatchEvent(new Event('input')); window.seen = document.getElementById('individuals');",
    );
    let beam = "document.getElementById('machine-beam').getAttribute('transform')";
    let at_90 = browser.script(&format!("return {beam}"));
    browser.script(
        "const turn = document.getElementById('machine-turn'); turn.value = 200; \
         turn.dispatchEvent(new Event('input'));",
    );
    assert_ne!(at_90, browser.script(&format!("return {beam}")));
    browser.wait_for(
        "the table is replaced",
        "return document.getElementById('individuals') !== window.seen",
    );
    let kept = browser.script("return document.getElementById('individuals-filter').value");
    assert_eq!(kept, "individual<2");
    let rows =
        "[...document.querySelectorAll('tr[data-individual]')].filter(row => !row.hidden).length";
    assert_eq!(browser.script(&format!("return {rows} <= 2")), true);

    let before = browser.script(&format!("return {EVALUATIONS}"));
    assert!(
        before.as_u64().unwrap() < 60,
        "{before}: too late to kill it"
    );
    coordinator.signal(Signal::KILL);
    drop(coordinator);
    browser.wait_for_state("stopped");
    let begun = std::time::Instant::now();
    site.run(&words);
    assert!(begun.elapsed().as_secs() < 100);
    browser.wait_for_state("finished");

    // what the page says is what the result says
    let result = site.result("a");
    let summary = browser.text("#summary");
    for number in ["recommended", "optimised"] {
        let number = shown(&result["objective"][number]);
        assert!(summary.contains(&number), "{number}: {summary}");
    }
    let changes = browser.text("#changes");
    let evaluations = format!("{} evaluations", result["evaluations"]);
    assert!(changes.contains(&evaluations), "{changes}");
    browser.script(
        "const filter = document.getElementById('individuals-filter'); filter.value = ''; \
         filter.dispatchEvent(new Event('input')); \
         [...document.querySelectorAll('#individuals th')].find(head => head.dataset.name === 'objective').click();",
    );
    let least = browser.script(
        "return document.querySelector('tr[data-individual] td[data-value]').dataset.value",
    );
    let least: f64 = least.as_str().unwrap().parse().unwrap();
    assert!((least - result["objective"]["optimised"].as_f64().unwrap()).abs() < 1e-9);
    // an individual that the journal does not hold in curves
    browser.script("document.querySelector('tr[data-individual=\"7\"]').click()");
    browser.wait_for(
        "individual 7 is simulated",
        "return document.querySelector('#individual section') !== null",
    );
    let one = browser.text("#individual");
    assert!(one.contains("Individual 7"), "{one}");

    // nothing is wider than the window, and nothing went wrong
    for (name, size) in [
        ("wide", (1200, 1000)),
        ("middle", (800, 1000)),
        ("phone", (500, 900)),
    ] {
        browser.script("window.scrollTo(0, 0)");
        browser.picture(size, &picture(name));
        let over =
            browser.script("return document.documentElement.scrollWidth - window.innerWidth");
        assert!(over.as_i64().unwrap() <= 0, "{name}: {over} px too wide");
    }
    let paint = browser
        .script("return performance.getEntriesByName('first-contentful-paint')[0].startTime");
    assert!(paint.as_f64().unwrap() < 5000.0, "{paint} ms");
    assert_eq!(browser.console(), Vec::<String>::new());

    // the report is the same page in one file
    let report = site.path("a/report.html");
    assert!(report.metadata().unwrap().len() < 3_000_000);
    browser.open(&format!("file://{}", report.display()));
    assert_eq!(browser.text("#summary"), summary);
    browser.script(
        "const turn = document.getElementById('machine-turn'); turn.value = 90; \
         turn.dispatchEvent(new Event('input'));",
    );
    assert_ne!(browser.script(&format!("return {beam}")), Value::Null);
    assert_eq!(browser.console(), Vec::<String>::new());
}
