//! Tests of the report as a whole with synthesised results: well-formed, self-contained, truthful, small.
mod diagnosis;
mod effect_gene;
mod geometry;
mod numbers;
mod rivals;
mod sample;
mod suspicion;

use protocol::job::{Reached, Verdict};
use protocol::pumping_unit::{Simulation, failure};
use report::document::TerminalStyle;
use report::pumping_unit::{balance, simulation};
use report::{
    self, Calibration, Figure, SingleRun, chart, table, write_calibration, write_simulation,
};
use roxmltree::{Document, ParsingOptions};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// HTML void elements, which have no closing tag.
const VOID: [&str; 3] = ["meta", "input", "br"];

/// Converts a page to XML by closing its void elements.
fn as_xml(page: &str) -> String {
    let mut rest = page;
    let mut xml = String::with_capacity(page.len() + 64);
    while let Some(at) = rest.find('<') {
        let (before, tag) = rest.split_at(at);
        xml.push_str(before);
        let end = tag.find('>').expect("every tag ends") + 1;
        let (tag, after) = tag.split_at(end);
        let name = tag
            .trim_start_matches('<')
            .split([' ', '>'])
            .next()
            .expect("every tag has a name");
        if VOID.contains(&name) {
            xml.push_str(tag.trim_end_matches('>'));
            xml.push_str("/>");
        } else {
            xml.push_str(tag);
        }
        rest = after;
    }
    xml.push_str(rest);
    xml
}

/// Checks the properties common to all pages: well-formed, unique ids, no external resources, no NaN or
/// infinity in attributes.
fn check_page(page: &str) {
    let xml = as_xml(page);
    let options = ParsingOptions {
        allow_dtd: true,
        ..ParsingOptions::default()
    };
    let document = Document::parse_with_options(&xml, options).expect("a well-formed page");
    let mut ids = BTreeSet::new();
    for node in document.descendants().filter(roxmltree::Node::is_element) {
        if let Some(id) = node.attribute("id") {
            assert!(ids.insert(id.to_owned()), "id {id} stands twice");
        }
        for attribute in node.attributes() {
            let name = attribute.name();
            assert!(
                !matches!(name, "src" | "srcset" | "data" | "action"),
                "{name} fetches something"
            );
            assert!(!name.starts_with("on"), "{name} is a script");
        }
        assert!(!matches!(
            node.tag_name().name(),
            "link" | "iframe" | "object" | "img"
        ));
        for number in ["NaN", "inf"] {
            let text = node.attributes().find(|a| a.value().contains(number));
            assert!(text.is_none(), "{number} in {node:?}");
        }
    }
    for node in document.descendants() {
        if let Some(target) = node.attribute("href") {
            let id = target.strip_prefix('#').expect("links stay in the page");
            assert!(ids.contains(id), "nothing has the id {id}");
        }
    }
    let without_namespace = page.replace("http://www.w3.org/2000/svg", "");
    for forbidden in ["http:", "https:", "//www", "@import", "url(\"", "url(h"] {
        assert!(
            !without_namespace.contains(forbidden),
            "{forbidden} in the page"
        );
    }
}

fn check_figure(figure: &Figure) {
    let document = Document::parse(&figure.svg).expect("well-formed SVG");
    let root = document.root_element();
    assert_eq!(root.tag_name().name(), "svg");
    assert!(root.attribute("viewBox").is_some());
    let texts = document
        .descendants()
        .filter(|node| node.has_tag_name(("http://www.w3.org/2000/svg", "text")));
    assert!(texts.count() > 3, "{} has hardly any text", figure.name);
    assert!(!figure.svg.contains("NaN"), "{}", figure.name);
}

fn page_of(calibration: &Calibration) -> String {
    report::page(&report::calibration(calibration))
}

/// Extracts the text of a page, without scripts and styles.
fn words(page: &str) -> String {
    let xml = as_xml(page);
    let options = ParsingOptions {
        allow_dtd: true,
        ..ParsingOptions::default()
    };
    let document = Document::parse_with_options(&xml, options).expect("a well-formed page");
    let texts = document.descendants().filter(|node| {
        let parent = node
            .parent()
            .map(|parent| parent.tag_name().name().to_owned());
        node.is_text() && !matches!(parent.as_deref(), Some("script" | "style"))
    });
    let words: Vec<_> = texts.filter_map(|node| node.text()).collect();
    words
        .join(" ")
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ")
}

/// Builds a sample calibration whose recommended run fails under the calibrated condition.
fn with_failed_recommended(points: usize) -> Calibration {
    let mut calibration = sample::calibration(800);
    let run = &mut calibration.conditions[0].recommended;
    sample::change(&calibration.case, run, |simulation| {
        sample::fail(simulation, points);
    });
    calibration
}

/// Returns the relative paths of the written files, and checks that each was written once.
fn names(folder: &Path, written: &[PathBuf]) -> BTreeSet<String> {
    let names: BTreeSet<String> = written
        .iter()
        .filter_map(|path| Some(path.strip_prefix(folder).ok()?.display().to_string()))
        .collect();
    assert_eq!(names.len(), written.len(), "a file is written twice");
    names
}

#[test]
fn a_calibration_is_written_with_its_data() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("calibration");
    let calibration = sample::calibration(4880);
    let written = write_calibration(&folder, &calibration).unwrap();
    let names = names(&folder, &written);
    for name in [
        "report.html",
        "curves.csv",
        "tables.txt",
        "figures/overlay_5rpm_gauge_1.svg",
        "figures/overlay_4rpm_gauge_3.svg",
        "figures/convergence.svg",
        "figures/genes.svg",
        "figures/contact.svg",
        "figures/workers.svg",
    ] {
        assert!(names.contains(name), "{name} is not among {names:?}");
    }
    let page = std::fs::read_to_string(&written[0]).unwrap();
    check_page(&page);
    let whole = report::calibration(&calibration);
    assert_eq!(whole.omitted, [""; 0], "every section has something to say");
    for section in &whole.sections {
        assert!(page.contains(&format!("<section id=\"{}\">", section.id)));
    }
    // what the page shows as tables stands in the plain text too, and every figure in a file
    let tables = std::fs::read_to_string(&written[1]).unwrap();
    assert_eq!(
        page.matches("<figure class=\"table\">").count(),
        tables.lines().filter(|line| line.starts_with('═')).count(),
        "{tables}"
    );
    for figure in whole.figures() {
        assert!(page.contains(&figure.svg));
        assert!(names.contains(&format!("figures/{}.svg", figure.name)));
    }
    assert!(page.contains("What remains unexplained under condition 5rpm"));
    let text = words(&page);
    for gene in &calibration.case.unknowns {
        assert!(text.contains(&gene.name), "{gene:?}");
    }
    for gauge in 1..=4 {
        assert!(text.contains(&format!("Gauge {gauge}")));
        assert!(text.contains(&format!("Gauge {gauge}")));
    }
    for part in [
        "4rpm",
        "took no part in the fit",
        "9b1d77aa03c2",
        "paper",
        "horsehead 0.1.0",
    ] {
        assert!(text.contains(part), "{part}");
    }
    assert_eq!(page, page_of(&calibration), "not the same bytes again");
}

#[test]
fn a_simulation_is_written_with_its_data() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("simulation");
    let run = sample::single();
    let written = write_simulation(&folder, &run).unwrap();
    let page = std::fs::read_to_string(&written[0]).unwrap();
    check_page(&page);
    for figure in report::simulation(&run).figures() {
        check_figure(figure);
        assert!(
            written
                .iter()
                .any(|path| path.ends_with(format!("figures/{}.svg", figure.name)))
        );
    }
    assert!(words(&page).contains("complete revolution"));
}

#[test]
fn every_figure_of_a_calibration_is_well_formed() {
    let calibration = sample::calibration(500);
    let case = &calibration.case;
    let overlays = chart::overlays(case, &calibration.conditions[0]);
    assert_eq!(overlays.len(), 4);
    let whole = report::calibration(&calibration);
    let figures = whole.figures();
    for name in ["convergence", "genes", "workers", "rope_tension", "contact"] {
        assert!(figures.iter().any(|figure| figure.name == name), "{name}");
    }
    for overlay in &overlays {
        assert!(figures.contains(&overlay), "{}", overlay.name);
    }
    for figure in &figures {
        check_figure(figure);
    }
    let genes = figures
        .iter()
        .find(|figure| figure.name == "genes")
        .unwrap();
    for gene in &case.unknowns {
        assert!(genes.svg.contains(&gene.name));
    }
}

#[test]
fn both_columns_of_an_overlay_share_their_scales() {
    let calibration = sample::calibration(0);
    let overlay = chart::overlay(&calibration.case, &calibration.conditions[0], 0);
    let svg = overlay.expect("the record has gauge 1").svg;
    // the measured mean is drawn in both columns with the same pen: same heights, shifted sideways
    let mean = curves(&svg, "#222222", "13");
    assert_eq!(mean.len(), 2);
    let shift = mean[1][0].0 - mean[0][0].0;
    assert!(shift > 3000, "the columns lie beside each other");
    for (left, right) in mean[0].iter().zip(&mean[1]) {
        assert_eq!(left.1, right.1);
        assert!((right.0 - left.0 - shift).abs() <= 1);
    }
}

/// Returns the points of every SVG curve longer than 100 points with the given stroke colour and width, in
/// drawing order.
fn curves(svg: &str, stroke: &str, width: &str) -> Vec<Vec<(i64, i64)>> {
    let document = Document::parse(svg).expect("well-formed SVG");
    let with_pen = document.descendants().filter(|node| {
        node.attribute("stroke") == Some(stroke) && node.attribute("stroke-width") == Some(width)
    });
    with_pen
        .filter_map(|node| node.attribute("points"))
        .map(|points| {
            let pairs = points.split_whitespace().filter_map(|p| p.split_once(','));
            pairs
                .filter_map(|(x, y)| Some((x.parse().ok()?, y.parse().ok()?)))
                .collect::<Vec<_>>()
        })
        .filter(|points| points.len() > 100)
        .collect()
}

#[test]
fn a_simulation_that_differs_by_its_zero_only_lies_on_the_measured_curve() {
    let mut calibration = sample::calibration(0);
    let record = calibration.case.channels[0].record.clone();
    let measured = record.expect("a record").mean;
    let run = &mut calibration.conditions[0].optimised;
    sample::change(&calibration.case, run, |simulation| {
        simulation.gauge_mpa[0] = measured.iter().map(|stress| stress - 5.0).collect();
    });
    let overlay = chart::overlay(&calibration.case, &calibration.conditions[0], 0);
    let svg = overlay.expect("the record has gauge 1").svg;
    let (mean, simulated) = (curves(&svg, "#222222", "13"), curves(&svg, "#c84b11", "11"));
    assert_eq!((mean.len(), simulated.len()), (2, 2));
    assert_eq!(
        mean[1], simulated[1],
        "the shift brings it onto the measured mean"
    );
    assert_ne!(mean[0], simulated[0]);
    // its residual lies on the zero line of the strip, the lowest one drawn
    let residual = &curves(&svg, "#222222", "8")[1];
    let document = Document::parse(&svg).unwrap();
    let zero = document
        .descendants()
        .filter(|node| node.attribute("stroke") == Some("#b9b9b5"))
        .filter_map(|node| node.attribute("points")?.split([',', ' ']).nth(1))
        .filter_map(|y| y.parse::<i64>().ok())
        .max()
        .expect("a zero line");
    for point in residual {
        assert!((point.1 - zero).abs() <= 1, "{} is not {zero}", point.1);
    }
}

#[test]
fn a_gauge_that_got_worse_is_said_to_be_worse() {
    let page = page_of(&sample::calibration(100));
    let text = words(&page);
    assert!(
        text.contains("Gauge 4: worse: mean squared error rose"),
        "{text}"
    );
    assert!(text.contains("Gauge 4 is worse with the optimised parameters under condition 4rpm."));
    assert!(text.contains("The sum of the mean squared errors of gauge 1 and gauge 3 fell from"));
}

#[test]
fn a_search_that_found_nothing_better_says_so() {
    let mut calibration = sample::calibration(100);
    let result = &mut calibration.conditions[0];
    result.optimised = result.recommended.clone();
    result.optimised.evaluation.fitness *= 1.1;
    let text = words(&page_of(&calibration));
    assert!(text.contains("The search found nothing better than the recommended parameters"));
}

#[test]
fn a_failed_recommended_run_draws_what_exists_and_says_so() {
    let calibration = with_failed_recommended(210);
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("failed");
    let written = write_calibration(&folder, &calibration).unwrap();
    let page = std::fs::read_to_string(&written[0]).unwrap();
    check_page(&page);
    let text = words(&page);
    assert!(
        text.contains("the rope sank through the surface of a head after 34.0 %"),
        "{text}"
    );
    assert!(text.contains("no error to compare with"));
    let overlay = chart::overlay(&calibration.case, &calibration.conditions[0], 2);
    let svg = overlay.expect("the record has gauge 3").svg;
    let simulated = |svg: &str| {
        let document = Document::parse(svg).unwrap();
        let curves = document
            .descendants()
            .filter(|node| node.attribute("stroke") == Some("#c84b11"))
            .filter_map(|node| node.attribute("points"));
        let mut lengths: Vec<_> = curves
            .map(|points| points.split_whitespace().count())
            .collect();
        lengths.sort_unstable();
        lengths
    };
    let lengths = simulated(&svg);
    assert_eq!(lengths[lengths.len() - 2..], [210, 720]);
    let tables = table::text(&table::table_3(&calibration), TerminalStyle::default());
    assert!(
        tables.contains("Recommended parameters failed: the rope sank"),
        "{tables}"
    );
}

#[test]
fn an_optimum_that_failed_is_not_sold_as_a_result() {
    let mut calibration = sample::calibration(50);
    let run = &mut calibration.conditions[0].optimised;
    sample::change(&calibration.case, run, |simulation| {
        sample::fail(simulation, 0);
    });
    for point in &mut calibration.history {
        point.complete = false;
    }
    let page = page_of(&calibration);
    check_page(&page);
    let text = words(&page);
    assert!(text.contains("No usable parameters were found"), "{text}");
    assert!(text.contains("no individual completed"));
}

#[test]
fn nothing_at_all_still_makes_a_page() {
    let mut calibration = sample::calibration(0);
    calibration.conditions.clear();
    calibration.workers.clear();
    calibration.notes.clear();
    calibration.optimised.genes.clear();
    check_page(&page_of(&calibration));

    let mut run: SingleRun = sample::single();
    let mut simulation = Simulation::of(&run.curves).unwrap();
    sample::fail(&mut simulation, 0);
    simulation.verdict = Verdict::Failed {
        kind: failure::BUDGET,
        reached: Reached::LoadFraction(0.5),
    };
    run.curves = sample::curves(&run.case, 0, simulation);
    run.evaluation = None;
    for channel in &mut run.case.channels {
        channel.record = None;
    }
    let page = report::page(&report::simulation(&run));
    check_page(&page);
    assert!(words(&page).contains(
        "the iteration budget was used up; `iteration_budget` in [run] of case.toml raises it"
    ));
}

#[test]
fn numbers_that_are_none_are_left_out() {
    let mut calibration = sample::calibration(60);
    let run = &mut calibration.conditions[0].optimised;
    let mut simulation = Simulation::of(&run.curves).unwrap();
    for curve in &mut simulation.gauge_mpa {
        curve[100..140].fill(f64::NAN);
    }
    simulation.crank_torque_n_m.fill(f64::NAN);
    simulation.suspension_m[0] = f64::INFINITY;
    simulation.motion[3].back_tension_n.fill(f32::NAN);
    simulation.motion[3].back_rope_m.fill([f32::NAN, 0.0]);
    let snapshots = simulation.motion.len();
    run.curves = sample::curves(&calibration.case, 0, simulation);
    run.evaluation.channels[0].relative_error = f64::NAN;
    calibration.history[7].fitness = f64::NAN;
    calibration.history[8].genes[2] = f64::NAN;
    calibration.history[9].genes.clear();
    calibration.workers[0].spent.connected_us = 0;
    let page = page_of(&calibration);
    check_page(&page);
    assert!(!words(&page).contains("NaN"));
    let frames = page.matches("\"path\":[").count();
    assert_eq!(
        frames,
        2 * (snapshots - 1),
        "a snapshot without places is left out"
    );
    let case = &calibration.case;
    let overlay = chart::overlay(case, &calibration.conditions[0], 0);
    let simulated = curves(&overlay.unwrap().svg, "#c84b11", "11");
    let lengths: Vec<_> = simulated.iter().map(Vec::len).collect();
    // recommended, then optimised on both sides of its gap (a stretch of 100 is not listed)
    assert_eq!(lengths, [720, 580]);
}

#[test]
fn huge_histories_stay_small() {
    let mut calibration = sample::calibration(100_000);
    let run = &mut calibration.conditions[0].optimised;
    let simulation = sample::simulation(&calibration.case, 0.08, 0.5);
    assert_eq!(simulation.motion.len(), 720);
    run.curves = sample::curves(&calibration.case, 0, simulation);
    let page = page_of(&calibration);
    assert!(page.len() < 5_000_000, "{} bytes", page.len());
    check_page(&page);
}

#[test]
fn terminal_tables_are_styled_only_on_demand() {
    let table = table::table_3(&sample::calibration(10));
    let plain = table::text(&table, TerminalStyle::default());
    assert!(!plain.contains('\u{1b}'));
    let bold = TerminalStyle {
        bold: true,
        ..TerminalStyle::default()
    };
    // a number is not broken where the terminal is narrow, nor is a line longer than it
    let narrow = TerminalStyle {
        width: Some(60),
        ..TerminalStyle::default()
    };
    let text = table::text(&table, narrow);
    let rows = text.lines().filter(|line| !line.starts_with("  "));
    let longest = rows.skip(1).map(|line| line.chars().count()).max();
    assert!(longest.is_some_and(|longest| longest <= 60), "{text}");
    assert!(text.contains("3.14\u{a0}×\u{a0}10⁸"), "{text}");
    assert!(text.contains("\u{a0}\u{a0}kb4"), "{text}");
    assert!(table::text(&table, bold).contains('\u{1b}'));
    for part in [
        "kb56",
        "N·m/deg",
        "401\u{a0}×",
        "gauge 3",
        "mean absolute error over",
    ] {
        assert!(plain.contains(part), "{part} is not in\n{plain}");
    }
    let run = sample::single();
    let drawn = Simulation::of(&run.curves).unwrap();
    let single = table::text(&simulation(&run, &drawn), TerminalStyle::default())
        + &table::text(&balance(&run, &drawn), TerminalStyle::default());
    for part in [
        "gauge 4",
        "stroke",
        "Newton iterations",
        "error of the balance",
    ] {
        assert!(single.contains(part), "{part} is not in\n{single}");
    }
}

#[test]
fn a_gene_at_its_bound_is_marked() {
    let mut calibration = sample::calibration(10);
    calibration.optimised.genes[8] = calibration.case.unknowns[8].upper;
    let text = words(&page_of(&calibration));
    assert!(text.contains("kc ended at its upper bound"));
    assert!(text.contains("* at a bound of the search: kc at its upper bound"));
}

#[test]
fn the_film_shows_the_machine_where_it_was() {
    let run = sample::single();
    let simulation = Simulation::of(&run.curves).unwrap();
    let page = report::page(&report::simulation(&run));
    let xml = as_xml(&page);
    let options = ParsingOptions {
        allow_dtd: true,
        ..ParsingOptions::default()
    };
    let document = Document::parse_with_options(&xml, options).unwrap();
    let film = document
        .descendants()
        .find(|node| node.attribute("id") == Some("machine-film"))
        .and_then(|node| node.text())
        .expect("the page has a film");
    let film: serde_json::Value = serde_json::from_str(film).unwrap();
    assert_eq!(
        film["turn"].as_array().unwrap().len(),
        simulation.motion.len()
    );
    let motion = &simulation.motion[40];
    let frame = &film["back"][40];
    let path: Vec<i64> = serde_json::from_value(frame["path"].clone()).unwrap();
    let (mut x, mut y) = (0, 0);
    for (step, point) in path.chunks(2).zip(&motion.back_rope_m) {
        x += step[0];
        y += step[1];
        assert!((x as f64 - 1e3 * f64::from(point[0])).abs() <= 0.5);
        assert!((y as f64 - 1e3 * f64::from(point[1])).abs() <= 0.5);
    }
    let tension = frame["tension"][5].as_f64().unwrap();
    assert!((100.0 * tension - f64::from(motion.back_tension_n[5])).abs() <= 50.0);
    // the last cylinder ends at the anchor: half a cylinder away, at most
    let (sin, cos) = f64::from(motion.beam_deg).to_radians().sin_cos();
    let anchor = |i: usize| film["back_head"][i].as_f64().unwrap();
    let at = (
        cos * anchor(2) - sin * anchor(3),
        sin * anchor(2) + cos * anchor(3),
    );
    assert!((at.0 - x as f64).hypot(at.1 - y as f64) < 60.0);
}

#[test]
fn an_absolute_error_that_rose_behind_a_free_offset_is_said() {
    let mut calibration = sample::calibration(10);
    let before = calibration.conditions[0].recommended.evaluation.channels[0];
    let after = &mut calibration.conditions[0].optimised.evaluation.channels[0];
    assert!(after.mse < before.mse);
    after.mse_fixed_offset = 3.0 * before.mse_fixed_offset + 1.0;
    let said = "the absolute mean squared error (offset not removed) got worse";
    let text = words(&page_of(&calibration));
    assert!(text.contains(said), "{text}");
    let printed = table::text(&table::table_3(&calibration), TerminalStyle::default());
    assert!(printed.contains(said) && printed.contains("MSE, absolute (offset not removed)"));
    let after = &mut calibration.conditions[0].optimised.evaluation.channels[0];
    after.mse_fixed_offset = 0.5 * before.mse_fixed_offset;
    let printed = table::text(&table::table_3(&calibration), TerminalStyle::default());
    assert!(!printed.contains(said));
}

#[test]
fn the_fitted_condition_is_not_called_unseen() {
    let calibration = sample::calibration(10);
    let title =
        |result: usize| table::table_4(&calibration.case, &calibration.conditions[result]).title;
    assert!(title(0).ends_with("the calibrated condition"));
    assert!(title(1).ends_with("which took no part in the fit"));
}

#[test]
fn computed_records_are_not_passed_off_as_measured() {
    let mut calibration = sample::calibration(10);
    let said = "The records of this case are synthetic";
    let page = |calibration: &Calibration| words(&page_of(calibration));
    assert!(!page(&calibration).contains(said));
    calibration.origin.synthetic = true;
    assert!(page(&calibration).contains(said));
}

/// Checks that the slowest simulations are listed first, with processor and wall time.
#[test]
fn the_slowest_simulations_are_listed_with_what_they_cost() {
    let calibration = sample::calibration(1000);
    let text = report::text(&report::calibration(&calibration), TerminalStyle::default());
    let (_, list) = text.split_once("The slowest simulations").expect("a table");
    let (list, note) = list
        .split_once("All 1\u{202f}000 simulations")
        .expect("a note");
    let rows: Vec<&str> = list.lines().filter(|line| line.contains("ms ")).collect();
    assert_eq!(rows.len(), 10, "{list}");
    for (row, individual) in rows.iter().zip([907, 807, 707]) {
        assert!(
            row.trim_start().starts_with(&individual.to_string()),
            "{row}"
        );
        assert!(
            row.contains("401\u{a0}ms") && row.contains("601\u{a0}ms"),
            "{row}"
        );
    }
    assert!(note.contains("the slowest took 2.0 times that"), "{note}");
}

/// Checks that on a narrow screen tables and figures scroll inside the page, with figures at a legible size.
#[test]
fn tables_and_figures_scroll_on_a_narrow_screen() {
    let page = page_of(&sample::calibration(100));
    assert!(page.contains("name=\"viewport\" content=\"width=device-width"));
    // the machine in motion has a small table and curves of its own, on which its cursor moves
    for (element, own) in [("<table>", 0), ("<svg xmlns", 1)] {
        let all = page.matches(element).count() - own;
        let scrolled = page
            .matches(&format!("<div class=\"scroll\">{element}"))
            .count();
        assert!(
            all > 3 && scrolled == all,
            "{element}: {scrolled} of {all} scroll"
        );
    }
    let (_, narrow) = page
        .split_once("@media screen and (max-width: 640px)")
        .expect("a rule");
    assert!(narrow.contains(".scroll > svg { width: 700px; max-width: none; }"));
    assert!(page.contains(".scroll { overflow-x: auto;"));
}
