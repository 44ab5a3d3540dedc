//! `horsehead life` on the shipped case: hot spots, gauges, mixes of conditions, and options that cannot be meant.
use crate::{changed_case, json, number};
use fatigue::{Assessment, Curve, MeanStress, damage};
use serde_json::Value;
use std::{fs, path::Path, process::Command};

fn years(spot: &Value) -> f64 {
    number(&spot["life_years"]["value"])
}

/// Checks that hot spots lie beside the pins, shortest life first, and that the gauges live as long as their simulated
/// readings give by hand.
#[test]
fn hot_spots_lie_at_the_pins_and_gauges_live_by_their_readings() {
    let scratch = tempfile::tempdir().unwrap();
    let run = scratch.path().join("life");
    let run = run.to_str().unwrap();
    let object = json(&["life", "CASE", "--run", run, "--hours", "5rpm=20"]);
    let spots = object["hot_spots"].as_array().unwrap();
    assert_eq!(spots.len(), 10);
    let lives: Vec<f64> = spots.iter().map(years).collect();
    assert!(lives.is_sorted() && lives[0] > 0.0, "{lives:?}");
    for spot in spots {
        let near = spot["near"].as_str().unwrap();
        assert!(near == "pin A" || near == "pin B");
        assert!((0.0..0.1).contains(&number(&spot["distance_m"])), "{spot}");
        assert!(number(&spot["range_mpa"]) <= 2.0 * number(&spot["von_mises_mpa"]));
        let factor = number(&spot["load_factor"]);
        assert_eq!(factor < 1.0, years(spot) < 20.0, "{spot}");
    }
    let simulated = json(&["simulate", "CASE", "--condition", "5rpm"]);
    let assessment = Assessment {
        curve: Curve::named("dnv-d").unwrap(),
        mean_stress: MeanStress::Ignored,
        factor: 1.0,
    };
    let gauges = object["gauges"].as_array().unwrap();
    assert_eq!(gauges.len(), 4);
    for (number_of, gauge) in (1..).zip(gauges) {
        let curve = simulated["gauge_mpa"][format!("{number_of}")].as_array();
        let curve: Vec<f64> = curve.unwrap().iter().map(number).collect();
        let by_hand = damage(&assessment, &curve);
        let found = number(&gauge["damage"][0]["damage_per_revolution"]);
        assert!((found / by_hand - 1.0).abs() < 1e-9, "{found} {by_hand}");
        // five revolutions a minute, 20 hours a day
        let expected = 1.0 / (by_hand * 5.0 * 60.0 * 20.0 * 365.25);
        assert!((years(gauge) / expected - 1.0).abs() < 1e-9);
    }
    // where the gauges sit, the surface is not the worst
    assert!(lives[0] < gauges.iter().map(years).fold(f64::MAX, f64::min));
}

/// Checks that damages of a mix add up, and that a factor on the stress is what the load factor says.
#[test]
fn damages_of_a_mix_add_up_and_the_load_factor_gives_the_target() {
    let scratch = tempfile::tempdir().unwrap();
    let run = scratch.path().join("life");
    let hours = ["life", "CASE", "--run", run.to_str().unwrap()];
    let hours = [&hours[..], &["--hours", "5rpm=12,4rpm=6"]].concat();
    let mix = json(&hours);
    let gauge = &mix["gauges"][2];
    let damages = gauge["damage"].as_array().unwrap();
    let a_day = number(&damages[0]["damage_per_revolution"]) * 5.0 * 60.0 * 12.0
        + number(&damages[1]["damage_per_revolution"]) * 4.0 * 60.0 * 6.0;
    assert!((years(gauge) * 365.25 * a_day - 1.0).abs() < 1e-9);
    let shares: f64 = damages.iter().map(|own| number(&own["share"])).sum();
    assert!((shares - 1.0).abs() < 1e-12);

    let factor = format!("{}", number(&gauge["load_factor"]));
    // another question to the same run is answered from its journal
    let size = || fs::metadata(run.join("journal.hhj")).unwrap().len();
    let before = size();
    let scaled = json(&[&hours[..], &["--stress-factor", &factor]].concat());
    let scaled = years(&scaled["gauges"][2]);
    assert!((scaled / 20.0 - 1.0).abs() < 1e-6, "{scaled}");
    // what a session enters is shorter than any result
    assert!(size() - before < 2000, "{before} {}", size());
    let mean = json(&[&hours[..], &["--survival", "0.5"]].concat());
    // two standard deviations of 0.2 in the decadic logarithm, to the three digits of the code's survival
    let longer = years(&mean["gauges"][2]) / years(gauge);
    assert!((longer.log10() / 0.4 - 1.0).abs() < 0.005, "{longer}");
    for file in ["report.html", "life.csv", "result.json"] {
        assert!(run.join(file).is_file(), "{file}");
    }
}

/// Checks that a run compares its parameters with the recommended ones, and that a curve of one's own counts.
#[test]
fn a_run_compares_before_and_after() {
    let scratch = tempfile::tempdir().unwrap();
    let run = scratch.path().join("run");
    let run = run.to_str().unwrap();
    let points = ["--preset", "random", "--set", "points=4"];
    json(&[&["calibrate", "CASE", "--run", run][..], &points].concat());
    // the curve of class D, typed by hand
    let table = scratch.path().join("d.csv");
    let curve = Curve::named("dnv-d").unwrap();
    let points = [150.0, 60.0, 52.63, 20.0].map(|range| format!("{},{range}", curve.cycles(range)));
    fs::write(&table, format!("cycles,range_mpa\n{}\n", points.join("\n"))).unwrap();
    let own = json(&["life", run, "--curve", table.to_str().unwrap()]);
    let names = own["variants"].as_array().unwrap();
    assert_eq!(names[0]["name"], "recommended");
    assert_eq!(names[1]["name"], "optimised");
    assert_eq!(own["hot_spots"], names[1]["hot_spots"]);
    let named = json(&["life", run]);
    // the report of the run shows it from now on
    json(&["report", run]);
    let page = fs::read_to_string(scratch.path().join("run/report.html")).unwrap();
    assert!(page.contains("id=\"life\"") && page.contains("from the hole"));
    // a run that was moved is not assessed again: its journal has the simulations
    let moved = scratch.path().join("moved");
    fs::rename(scratch.path().join("run"), &moved).unwrap();
    let size = || fs::metadata(moved.join("life/journal.hhj")).unwrap().len();
    let before = size();
    let again = json(&["life", moved.to_str().unwrap()]);
    assert_eq!(again["hot_spots"], named["hot_spots"]);
    assert!(size() - before < 2000, "{before} {}", size());
    let (own, named) = (years(&own["hot_spots"][0]), years(&named["hot_spots"][0]));
    assert!((own / named - 1.0).abs() < 0.01, "{own} {named}");
}

#[test]
fn options_that_cannot_be_meant_are_named_with_a_remedy() {
    let scratch = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        let path = scratch.path().join(name);
        fs::write(&path, text).unwrap();
        path.display().to_string()
    };
    let rising = file("rising.csv", "cycles,range_mpa\n1e4,100\n1e6,120\n");
    let header = file("header.csv", "N,S\n1e4,100\n1e6,50\n");
    let word = file("word.csv", "cycles,range_mpa\n1e4,100\n1e6,many\n");
    let short = file("short.csv", "cycles,range_mpa\n1e4,100\n");
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb");
    for (words, said) in [
        (vec!["--curve", "en-70"], vec!["en-70", "en-71"]),
        (vec!["--curve", &rising], vec!["rising.csv", "point 1"]),
        (
            vec!["--curve", &header],
            vec!["header.csv", "N,S", "cycles,range_mpa"],
        ),
        (vec!["--curve", &word], vec!["word.csv", "line 3"]),
        (vec!["--curve", &short], vec!["short.csv", "two points"]),
        (vec!["--mean-stress", "goodman"], vec!["--strength"]),
        (
            vec!["--mean-stress", "gerber", "--strength=-3"],
            vec!["--strength", "-3"],
        ),
        (vec!["--walker", "1.5"], vec!["--walker", "1.5"]),
        (vec!["--hours", "5rpm=20,4rpm=8"], vec!["28", "24"]),
        (vec!["--hours", "6rpm=8"], vec!["6rpm", "5rpm, 4rpm"]),
        (vec!["--hours", "5rpm"], vec!["`5rpm`", "NAME=HOURS"]),
        (vec!["--hours", "5rpm=1,5rpm=2"], vec!["5rpm twice"]),
        (vec!["--survival", "0.2"], vec!["--survival", "0.2"]),
        (
            vec!["--survival", "0.9", "--curve", "en-71"],
            vec!["scatter", "EN 1993-1-9 category 71"],
        ),
        (
            vec!["--stress-factor", "0"],
            vec!["--stress-factor", "positive"],
        ),
        (vec!["--target-years", "nan"], vec!["--target-years"]),
    ] {
        let output = Command::new(env!("CARGO_BIN_EXE_horsehead"))
            .arg("life")
            .arg(&case)
            .args(&words)
            .output()
            .unwrap();
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{words:?}: {errors}");
        for said in said {
            assert!(errors.contains(said), "{words:?}: {said}\n{errors}");
        }
    }
}

/// Checks that a case without a mesh has lives at its gauges, those of the case with one, and says why at no other place.
#[test]
fn without_a_mesh_the_gauges_alone_are_assessed() {
    let scratch = tempfile::tempdir().unwrap();
    let case = changed_case(&scratch.path().join("case"), |text| {
        let lines = text.lines();
        let kept = lines.filter(|line| !line.starts_with("mesh_file"));
        kept.collect::<Vec<_>>().join("\n")
    });
    let run = scratch.path().join("life");
    let bare = json(&["life", &case, "--run", run.to_str().unwrap()]);
    assert_eq!(bare["hot_spots"], serde_json::json!([]));
    let run = scratch.path().join("whole");
    let whole = json(&["life", "CASE", "--run", run.to_str().unwrap()]);
    assert_eq!(bare["gauges"], whole["gauges"]);
    let page = fs::read_to_string(scratch.path().join("life/report.html")).unwrap();
    assert!(page.contains("mesh_file") && page.contains("of the gauges at 3"));
}
