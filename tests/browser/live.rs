//! A calibration of the shipped machine under an open page: it goes on, its coordinator is killed and started again,
//! and it ends.
use super::{
    Site,
    driver::{Browser, LIMIT},
    folder::copy,
    picture, shown,
};
use rustix::process::Signal;
use serde_json::Value;
use std::{fs, path::Path};
use tests::process::{Process, wait_until};

/// Number of evaluations in the first row of the page's progress.
const EVALUATIONS: &str =
    "Number(document.querySelector('#progress dd').textContent.split(' ')[0].replace(/\\D/g, ''))";

/// Position of the beam on the page's drawing of the machine.
const BEAM: &str = "return document.getElementById('machine-beam').getAttribute('transform')";

#[test]
fn a_page_follows_a_run_that_is_killed_and_resumed_to_its_end() {
    let Some(browser) = Browser::start() else {
        return;
    };
    let site = Site::new(None);
    copy_with_another_speed(&site);
    let words = [
        "calibrate",
        "case",
        "--preset",
        "random",
        "--set",
        "points=40",
        "--workers",
        "1",
        "--run",
        "a",
    ];
    let coordinator = Process::logged(site.command(&words), &site.path("first.log"));
    let runs = site.path("a/run.json");
    wait_until("the run begins", LIMIT, || runs.exists());
    let (_server, url) = site.dashboard("a");
    browser.open(&url);
    goes_on(&browser);
    keeps_what_a_person_chose(&browser);
    let before = browser.script(&format!("return {EVALUATIONS}"));
    assert!(
        before.as_u64().unwrap() < 40,
        "{before}: too late to kill it"
    );
    coordinator.signal(Signal::KILL);
    drop(coordinator);
    browser.wait_for_state("stopped");
    site.run(&words);
    browser.wait_for_state("finished");
    agrees_with_the_result(&browser, &site);
    simulates_an_individual(&browser);
    fits_every_window(&browser);
    is_frozen_in_the_report(&browser, &site);
    assert_eq!(browser.console(), Vec::<String>::new());
}

/// Copies the shipped case and adds a condition with another speed and the load card of an existing one.
fn copy_with_another_speed(site: &Site) {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb");
    for part in ["", "back_head", "measured"] {
        copy(&shipped.join(part), &site.path("case").join(part));
    }
    let file = site.path("case/case.toml");
    let condition = "[[conditions]]\nname = \"6rpm\"\nspeed_rpm = 6.0\ncounterweight_moment_n_m = 106.2e3\n\
                     card_file = \"measured/card_5rpm.csv\"\nsmoothing = \"none\"\n\n[objective]";
    let text = fs::read_to_string(&file).unwrap();
    fs::write(&file, text.replace("[objective]", condition)).unwrap();
}

/// Checks that results arrive, and that the best individual so far is simulated and drawn.
fn goes_on(browser: &Browser) {
    browser.wait_for_state("running");
    browser.wait_for(
        "results arrive",
        &format!("return document.querySelector('#progress dd') !== null && {EVALUATIONS} >= 2"),
    );
    browser.wait_for(
        "the machine is drawn",
        "return document.querySelector('#machine-turn') !== null",
    );
    assert!(!browser.text("#figure-convergence figcaption").is_empty());
    begins_with_what_was_found(browser);
    browser.picture((1200, 1000), &picture("live"));
}

/// Checks that the sections follow each other from what was found over curves and machine to numbers and search.
fn begins_with_what_was_found(browser: &Browser) {
    let order = [
        "summary",
        "overlays",
        "curves",
        "moving-machine",
        "tables",
        "convergence",
        "individuals",
    ];
    let shown = browser
        .script("return [...document.querySelectorAll('#sections > section')].map(one => one.id)");
    let shown: Vec<&str> = shown
        .as_array()
        .unwrap()
        .iter()
        .filter_map(Value::as_str)
        .collect();
    let places = order.map(|id| shown.iter().position(|own| *own == id));
    assert!(
        places.iter().all(Option::is_some) && places.is_sorted(),
        "{shown:?}"
    );
    let lead = browser.text("#summary .verdict");
    assert!(
        lead.contains("root mean square") && lead.contains("peak-to-peak"),
        "{lead}"
    );
    assert!(lead.contains("the stroke by"), "{lead}");
}

/// Turns the machine by its slider.
fn turn(browser: &Browser, deg: u32) {
    browser.script(&format!(
        "const turn = document.getElementById('machine-turn'); turn.value = {deg}; \
         turn.dispatchEvent(new Event('input'));"
    ));
}

/// Sets the filter of the table of individuals.
fn filter(browser: &Browser, text: &str) {
    browser.script(&format!(
        "const filter = document.getElementById('individuals-filter'); filter.value = '{text}'; \
         filter.dispatchEvent(new Event('input'));"
    ));
}

/// Moves the machine and filters the table, and checks that a section that is replaced keeps the filter.
fn keeps_what_a_person_chose(browser: &Browser) {
    turn(browser, 90);
    let at_90 = browser.script(BEAM);
    turn(browser, 200);
    assert_ne!(at_90, browser.script(BEAM));
    filter(browser, "individual<2");
    browser.script("window.seen = document.getElementById('individuals')");
    browser.wait_for(
        "the table is replaced",
        "return document.getElementById('individuals') !== window.seen",
    );
    let kept = browser.script("return document.getElementById('individuals-filter').value");
    assert_eq!(kept, "individual<2");
    let rows = "[...document.querySelectorAll('tr[data-individual]')].filter(row => !row.hidden)";
    assert_eq!(browser.script(&format!("return {rows}.length <= 2")), true);
}

/// Checks that the numbers on the page are those of the result.
fn agrees_with_the_result(browser: &Browser, site: &Site) {
    let result = site.result("a");
    let summary = browser.text("#summary");
    for number in ["recommended", "optimised"] {
        let number = shown(&result["objective"][number]);
        assert!(summary.contains(&number), "{number}: {summary}");
    }
    let machine = result["machine"].as_array().unwrap();
    let stroke = machine.iter().find(|own| own["quantity"] == "stroke");
    let stroke = stroke.unwrap()["after"].as_f64().unwrap();
    for part in [
        "Stroke and torque",
        "peak torque",
        "37.0",
        &format!("{stroke:.3}"),
    ] {
        assert!(summary.contains(part), "{part}: {summary}");
    }
    for flag in machine.iter().filter_map(|own| own["flag"].as_str()) {
        assert!(summary.contains(flag), "{flag}: {summary}");
    }
    let notes = browser.text("#notes");
    assert!(notes.contains("this is no prediction for 6rpm"), "{notes}");
    let convergence = browser.text("#convergence");
    let evaluations = format!("{} evaluations", result["evaluations"]);
    assert!(convergence.contains(&evaluations), "{convergence}");
    filter(browser, "");
    browser.script(
        "[...document.querySelectorAll('#individuals th')].find(head => head.dataset.name === 'objective').click();",
    );
    let least = browser.script(
        "return document.querySelector('tr[data-individual] td[data-value]').dataset.value",
    );
    let least: f64 = least.as_str().unwrap().parse().unwrap();
    let optimised = result["objective"]["optimised"].as_f64().unwrap();
    assert!((least - optimised).abs() < 1e-9);
}

/// Opens an individual whose curves the journal does not hold.
fn simulates_an_individual(browser: &Browser) {
    browser.script("document.querySelector('tr[data-individual=\"7\"]').click()");
    browser.wait_for(
        "individual 7 is simulated",
        "return document.querySelector('#individual section') !== null",
    );
    let one = browser.text("#individual");
    assert!(one.contains("Individual 7"), "{one}");
}

/// Checks that no window is too narrow for the page, and states how soon the page is painted.
fn fits_every_window(browser: &Browser) {
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
}

/// Checks that the report is the same page in one file.
fn is_frozen_in_the_report(browser: &Browser, site: &Site) {
    begins_with_what_was_found(browser);
    let summary = browser.text("#summary");
    let report = site.path("a/report.html");
    assert!(report.metadata().unwrap().len() < 3_000_000);
    browser.open(&format!("file://{}", report.display()));
    assert_eq!(browser.text("#summary"), summary);
    let at_0 = browser.script(BEAM);
    turn(browser, 90);
    assert_ne!(browser.script(BEAM), at_0);
}
