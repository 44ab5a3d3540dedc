//! Tests of cases with a model kind that the program does not know: content that is read, and errors for
//! faults.
#![expect(
    clippy::unwrap_used,
    reason = "a test that cannot prepare its case has failed"
)]
mod faults;

use case::{self, Loaded, Overrides};
use protocol::case::{Channel, Offset, Scale};
use std::{fs, path::PathBuf};
use tempfile::TempDir;

const TOML: &str = include_str!("case.toml");
/// Record (CSV) of two cycles with four points each: means 1, 3, 5, 3; the cycles differ only at the third
/// point.
const SLOW: &str =
    "cycle,phase_deg,force_n\n1,0,1\n1,90,3\n1,180,6\n1,270,3\n2,0,1\n2,90,3\n2,180,4\n2,270,3\n";
const FAST: &str = "time_s,force_n\n0,1\n0.1,2.5\n0.3,2\n";

struct Case(TempDir);

impl Case {
    fn new() -> Self {
        let case = Self(TempDir::new().unwrap());
        for (file, text) in [("case.toml", TOML), ("slow.csv", SLOW), ("fast.csv", FAST)] {
            fs::write(case.path(file), text).unwrap();
        }
        case
    }

    fn path(&self, file: &str) -> PathBuf {
        self.0.path().join(file)
    }

    /// Replaces the first occurrence of a text in a file of the test case; fails if the file does not contain
    /// it.
    fn replace(&self, file: &str, from: &str, to: &str) {
        let text = fs::read_to_string(self.path(file)).unwrap();
        assert!(text.contains(from), "{file} has no `{from}`");
        fs::write(self.path(file), text.replacen(from, to, 1)).unwrap();
    }

    fn load(&self) -> Result<Loaded, case::CaseError> {
        case::load_with_notes(self.0.path(), &Overrides::default())
    }
}

/// Checks that the general parts of a case with an unknown model kind are parsed and that its model settings
/// are passed on unread as text.
#[test]
fn a_case_of_an_unknown_model_is_read_without_knowing_it() {
    let loaded = Case::new().load().unwrap();
    let case = loaded.case;
    assert_eq!(
        (case.name.as_str(), case.model.kind.as_str()),
        ("spring", "of somebody's own")
    );
    let own: toml::Table = String::from_utf8(case.model.settings)
        .unwrap()
        .parse()
        .unwrap();
    assert_eq!(own["model"]["depth_mm"].as_float(), Some(12.5));
    assert_eq!(own["model"]["table"]["words"].as_str(), Some("kept"));
    assert!(own["model"].get("kind").is_none());
    let hz: Vec<_> = own["conditions"]
        .as_array()
        .unwrap()
        .iter()
        .map(|one| one["hz"].as_float())
        .collect();
    assert_eq!(hz, [Some(3.0), Some(9.0)]);
    let [stiffness, twin, offset, mass] = &case.unknowns[..] else {
        panic!("four unknowns");
    };
    assert_eq!(
        (stiffness.symbol.as_str(), stiffness.unit.as_str()),
        ("k", "furlong/fortnight")
    );
    assert_eq!(
        (stiffness.start, stiffness.lower, stiffness.upper),
        (6.0, 1.0, 40.0)
    );
    assert_eq!(
        (offset.title.as_str(), offset.scale, offset.absent),
        ("offset", Scale::Linear, Some(0.0))
    );
    let tie = twin.tie.as_ref().unwrap();
    assert_eq!(
        (tie.to.as_str(), tie.ratio, mass.fixed),
        ("stiffness", 2.0, true)
    );
}

/// Checks that an objective may include several conditions and that the offset may be fixed for some channels
/// only.
#[test]
fn an_objective_is_over_the_conditions_that_it_names() {
    let case = Case::new();
    let from = "condition = \"slow\"\nterms";
    case.replace("case.toml", from, "condition = [\"fast\", \"slow\"]\nterms");
    case.replace(
        "case.toml",
        "unit = \"N\"\n",
        "unit = \"N\"\noffset = \"fixed\"\n",
    );
    case.replace("case.toml", "held_out = true\n", "");
    let loaded = case.load().unwrap().case;
    let objective = &loaded.objective;
    assert_eq!(objective.conditions().collect::<Vec<_>>(), [1, 0]);
    assert!(objective.holds(0) && objective.holds(1) && !objective.holds(2));
    let fixed: Vec<bool> = loaded.channels.iter().map(Channel::is_absolute).collect();
    assert_eq!(fixed, [true, false, false]);
    // the second condition measures something else
    let of_fast = "name = \"force\"\nunit = \"N\"\ncondition = \"fast\"";
    case.replace("case.toml", of_fast, &of_fast.replace("force", "thrust"));
    let error = case.load().unwrap_err().to_string();
    for part in [
        "`objective.condition[0]` = \"fast\"",
        "a record of one of the terms",
    ] {
        assert!(error.contains(part), "{error}");
    }
}

#[test]
fn records_are_averaged_and_channels_say_where_they_stand() {
    let loaded = Case::new().load().unwrap();
    let [slow, speed, fast] = &loaded.case.channels[..] else {
        panic!("three channels");
    };
    assert_eq!(
        (slow.title.as_str(), fast.title.as_str()),
        ("force at the support", "force")
    );
    assert_eq!((slow.condition, fast.condition), (0, 1));
    assert_eq!(
        (slow.abscissa.period, fast.abscissa.period),
        (Some(360.0), None)
    );
    assert_eq!(slow.abscissa.points, [0.0, 90.0, 180.0, 270.0]);
    assert_eq!(speed.abscissa.points, [0.5, 0.75, 1.0, 1.25, 1.5]);
    assert_eq!((slow.noise, slow.step), (Some(0.1), Some(-14)));
    let record = slow.record.as_ref().unwrap();
    assert_eq!(
        (record.cycles, &record.mean[..]),
        (2, &[1.0, 3.0, 5.0, 3.0][..])
    );
    assert_eq!(record.spread, [0.0, 0.0, 2.0_f64.sqrt(), 0.0]);
    assert_eq!((speed.record.as_ref(), speed.step), (None, None));
    assert_eq!(fast.record.as_ref().unwrap().spread, [0.0; 3]);
    let objective = &loaded.case.objective;
    assert_eq!((objective.condition, &*objective.others), (0, &[][..]));
    assert_eq!((slow.offset, fast.offset), (Offset::Free, Offset::Free));
    assert_eq!(
        (
            objective.terms[0].channel.as_str(),
            objective.terms[0].weight
        ),
        ("force", 2.0)
    );
    // a diagnosis takes every cycle by itself
    let [first, second] = &loaded.cycles[..] else {
        panic!("two records");
    };
    assert_eq!((first.cycles.len(), second.cycles.len()), (2, 1));
    assert_eq!((first.held_out, second.held_out), (false, true));
    assert_eq!(first.cycles[1], [[1.0, 3.0, 4.0, 3.0]]);
}

/// Checks that the held-out part of a channel follows its fitted part, and that the stated errors apply to
/// both.
#[test]
fn a_part_of_a_channel_may_be_held_out() {
    let case = Case::new();
    let keys =
        "noise = 0.1\ncorrelation = 0.5\nmodel_error = 0.2\nheld_out = { from = 90.0, to = 180.0 }";
    case.replace("case.toml", "noise = 0.1", keys);
    let loaded = case.load().unwrap();
    let record = &loaded.cycles[0];
    let [fitted, held] = &record.channels[..] else {
        panic!("two parts");
    };
    assert_eq!((fitted.held_out, held.held_out), (false, true));
    assert_eq!(fitted.channel.abscissa.points, [0.0, 270.0]);
    assert_eq!(held.channel.abscissa.points, [90.0, 180.0]);
    assert_eq!(record.cycles[1], [[1.0, 3.0], [3.0, 4.0]]);
    for part in [fitted, held] {
        assert_eq!((part.correlation, part.model_error), (Some(0.5), Some(0.2)));
    }
    let said = case::check(case.0.path(), &Overrides::default())
        .unwrap()
        .text;
    for what in [
        "noise 0.1 N",
        "correlation 0.500",
        "model error 0.2 N",
        "2 values held out",
        "fast (held out)",
    ] {
        assert!(said.contains(what), "{what} is not in\n{said}");
    }
    // the case's own channel, which a calibration compares, is whole
    assert_eq!(loaded.case.channels[0].abscissa.points.len(), 4);
}

/// Checks that records in another folder replace those of the same names, and that conditions without a
/// record there are only simulated, except the calibrated condition.
#[test]
fn another_folder_replaces_the_records() {
    let case = Case::new();
    let other = case.path("other");
    fs::create_dir(&other).unwrap();
    fs::write(other.join("slow.csv"), SLOW.replace("180,6", "180,8")).unwrap();
    let overrides = Overrides {
        measured: Some(other.clone()),
    };
    let loaded = case::load_with_notes(case.0.path(), &overrides).unwrap();
    let [slow, _, fast] = &loaded.case.channels[..] else {
        panic!("three channels");
    };
    assert_eq!(
        slow.record.as_ref().unwrap().mean[2].to_bits(),
        6.0_f64.to_bits()
    );
    assert_eq!(
        (fast.record.as_ref(), &fast.abscissa.points[..]),
        (None, &[0.0, 0.1, 0.3][..])
    );
    assert!(
        loaded
            .notes
            .iter()
            .any(|note| note.to_string().contains("`fast` has no record"))
    );
    fs::remove_file(other.join("slow.csv")).unwrap();
    let message = case::load(case.0.path(), &overrides)
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("other/slow.csv: no such file"),
        "{message}"
    );
}

/// Checks that the error for each fault names file, field and remedy.
#[test]
fn every_fault_is_named() {
    let mut wrong = Vec::new();
    for (name, file, from, to, expected) in faults::FAULTS {
        let case = Case::new();
        case.replace(file, from, to);
        let message = match case.load() {
            Ok(_) => {
                wrong.push(format!("{name}: loads"));
                continue;
            }
            Err(error) => error.to_string(),
        };
        let help = message.lines().last().unwrap_or_default();
        if help.len() < 15 || !help.starts_with("help: ") {
            wrong.push(format!("{name}: no help in\n{message}"));
        }
        let place = if expected.iter().any(|part| part.contains(".csv")) {
            ".csv"
        } else {
            file
        };
        for part in expected.iter().chain([&place]) {
            if !message.contains(part) {
                wrong.push(format!("{name}: no `{part}` in\n{message}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}
