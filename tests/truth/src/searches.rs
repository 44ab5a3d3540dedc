//! Comparison of searches: calibrations by the program under test with several presets and seeds, on records
//! with known stiffness, as a table. Calibrations with an existing result are not run again.
use crate::suite::json_into;
use anyhow::{Context as _, ensure};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Comparison of calibrations to run: search presets, seeds and records.
#[derive(Debug)]
pub struct Searches<'a> {
    /// Case folder of the machine that is calibrated.
    pub case: &'a Path,
    /// Folders of further records, each named as its answer; the case's own record is calibrated first.
    pub records: &'a [PathBuf],
    /// Files of answers: those of `truth make`, or of the practice sets.
    pub answers: &'a [PathBuf],
    /// Path of the program under test.
    pub horsehead: &'a Path,
    /// Names of the search presets to compare.
    pub presets: &'a [String],
    /// Seeds used with each preset.
    pub seeds: &'a [u64],
    /// Name of the unknown whose calibrated value is compared with the hidden (true) value of the record.
    pub unknown: &'a str,
    /// Folder for runs and results.
    pub out: &'a Path,
}

/// Result and cost of one calibration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// Decadic logarithm of the compared unknown's calibrated value.
    pub unknown: f64,
    /// Objective value of the calibrated individual.
    pub objective: f64,
    /// Number of simulations that the calibration ran.
    pub jobs: f64,
    /// Cost in equivalent plain simulations: a simulation with derivatives counts as 5 + 0.1 per unknown.
    pub equivalent_simulations: f64,
    /// Wall time of the calibration (s).
    pub seconds: f64,
}

/// Parts of the output of `horsehead calibrate CASE --output json` that are used here.
#[derive(Deserialize)]
struct Result {
    wall_s: f64,
    genes: BTreeMap<String, Value>,
    objective: Objective,
}

#[derive(Deserialize)]
struct Value {
    value: f64,
}

#[derive(Deserialize)]
struct Objective {
    optimised: Option<f64>,
}

/// Outcomes by record number and preset index, one outcome for each seed.
type Outcomes = BTreeMap<(usize, usize), Vec<Outcome>>;

impl Searches<'_> {
    /// Runs the missing calibrations and returns the table of all results; reports each calibration through
    /// `say`.
    ///
    /// # Errors
    /// File system errors; a calibration that fails; answers that cannot be read.
    pub fn run(&self, say: &mut dyn FnMut(&str) -> anyhow::Result<()>) -> anyhow::Result<String> {
        fs::create_dir_all(self.out).with_context(|| format!("making {}", self.out.display()))?;
        let mut outcomes = Outcomes::new();
        // seeds outermost: what is stopped early has every record
        for &seed in self.seeds {
            for record in 0..=self.records.len() {
                for (place, preset) in self.presets.iter().enumerate() {
                    let outcome = self.calibrate(record, preset, seed)?;
                    say(&format!(
                        "{} {preset} {seed}: {outcome:?}",
                        self.name(record)
                    ))?;
                    outcomes.entry((record, place)).or_default().push(outcome);
                    fs::write(self.out.join("table.md"), self.table(&outcomes)?)?;
                }
            }
        }
        self.table(&outcomes)
    }

    /// Returns the name of a record by its number; number 0 is the case's own record.
    fn name(&self, record: usize) -> String {
        let folder = record.checked_sub(1).and_then(|k| self.records.get(k));
        let name = folder.and_then(|folder| folder.file_name());
        name.map_or_else(
            || "shipped".to_owned(),
            |name| name.to_string_lossy().into_owned(),
        )
    }

    /// Runs one calibration, or reads its stored result.
    fn calibrate(&self, record: usize, preset: &str, seed: u64) -> anyhow::Result<Outcome> {
        let name = format!("{}-{preset}-{seed}", self.name(record));
        let (run, result) = (self.out.join(&name), self.out.join(format!("{name}.json")));
        let kept = self.out.join(format!("{name}.csv"));
        if !result.is_file() {
            let part = result.with_extension("part");
            let mut command = Command::new(self.horsehead);
            command.arg("calibrate").arg(self.case);
            if let Some(folder) = record.checked_sub(1).and_then(|k| self.records.get(k)) {
                command.arg("--measured").arg(folder);
            }
            command.args(["--preset", preset, "--seed", &seed.to_string()]);
            command.arg("--run").arg(&run);
            let status = json_into(&mut command, &part)?;
            ensure!(
                status.success(),
                "the calibration {name} failed ({status}): see {}",
                run.display()
            );
            fs::copy(run.join("csv/evaluations.csv"), &kept)
                .with_context(|| format!("reading {}", run.display()))?;
            fs::remove_dir_all(&run).with_context(|| format!("removing {}", run.display()))?;
            fs::rename(&part, &result).with_context(|| format!("writing {}", result.display()))?;
        }
        let bytes = fs::read(&result).with_context(|| format!("reading {}", result.display()))?;
        let log =
            fs::read_to_string(&kept).with_context(|| format!("reading {}", kept.display()))?;
        outcome(&bytes, &log, self.unknown)
            .with_context(|| format!("{} is not a valid calibration result", result.display()))
    }

    /// Returns the decadic logarithm of the hidden value of the compared unknown in a record; `None` if no
    /// answer file has the record.
    fn hidden(&self, record: usize) -> anyhow::Result<Option<f64>> {
        let name = self.name(record);
        for path in self.answers {
            let bytes = fs::read(path).with_context(|| format!("reading {}", path.display()))?;
            let all: serde_json::Value = serde_json::from_slice(&bytes)
                .with_context(|| format!("{} holds no answers", path.display()))?;
            let made = &all["sets"][&name]["genes"][self.unknown];
            // practice sets call `kb1` `k1`
            let practice = &all[&name]["parameters"][self.unknown.replacen('b', "", 1)];
            if let Some(value) = made.as_f64().or_else(|| practice.as_f64()) {
                return Ok(Some(libm::log10(value)));
            }
        }
        Ok(None)
    }

    /// Formats the outcomes as a table: one line per record and preset, values of several seeds separated by
    /// slashes.
    fn table(&self, outcomes: &Outcomes) -> anyhow::Result<String> {
        let mut text = format!(
            "| record | search | objective | over the least | log10({0}) less hidden | jobs | plain | s |\n\
             |---|---|---|---|---|---|---|---|\n",
            self.unknown
        );
        for ((record, place), own) in outcomes {
            let of_record = outcomes.iter().filter(|((other, _), _)| other == record);
            let all = of_record.flat_map(|(_, own)| own.iter().map(|one| one.objective));
            let least = all.fold(f64::INFINITY, f64::min);
            let hidden = self.hidden(*record)?;
            let joined = |value: &dyn Fn(&Outcome) -> String| {
                own.iter().map(value).collect::<Vec<_>>().join(" / ")
            };
            writeln!(
                text,
                "| {} | `{}` | {} | {} | {} | {} | {} | {} |",
                self.name(*record),
                self.presets[*place],
                joined(&|one| format!("{:.4}", one.objective)),
                joined(&|one| format!("{:.1} %", 100.0 * (one.objective / least - 1.0))),
                joined(&|one| hidden.map_or_else(
                    || format!("({:.3})", one.unknown),
                    |hidden| format!("{:+.3}", one.unknown - hidden)
                )),
                joined(&|one| format!("{}", one.jobs)),
                joined(&|one| format!("{:.0}", one.equivalent_simulations)),
                joined(&|one| format!("{:.0}", one.seconds)),
            )?;
        }
        Ok(text)
    }
}

/// Reads the outcome of a calibration from its JSON result and its CSV table of evaluations.
fn outcome(result: &[u8], log: &str, unknown: &str) -> anyhow::Result<Outcome> {
    let result: Result = serde_json::from_slice(result)?;
    let value = result.genes.get(unknown);
    let value = value
        .with_context(|| format!("the result has no unknown {unknown}"))?
        .value;
    let mut lines = log.lines();
    let header = lines.next().context("the table of evaluations is empty")?;
    let purpose = header.split(',').position(|name| name == "purpose");
    let purpose = purpose.context("the table of evaluations has no column `purpose`")?;
    let (mut jobs, mut plain) = (0.0, 0.0);
    for line in lines {
        let derivatives = line.split(',').nth(purpose) == Some("derivatives");
        jobs += 1.0;
        plain += if derivatives {
            5.0 + 0.1 * result.genes.len() as f64
        } else {
            1.0
        };
    }
    Ok(Outcome {
        unknown: libm::log10(value),
        objective: result.objective.optimised.unwrap_or(f64::INFINITY),
        jobs,
        equivalent_simulations: plain,
        seconds: result.wall_s,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_outcome_is_read_and_set_beside_the_hidden_value() {
        let result = br#"{"wall_s": 12.0, "genes": {"kb1": {"value": 1e9}, "kc": {"value": 2.0}},
                          "objective": {"recommended": 6.0, "optimised": 0.5}}"#;
        let log = "job,purpose\n0,initial\n1,derivatives\n2,least_squares\n";
        let found = outcome(result, log, "kb1").expect("a result");
        assert!(
            (found.equivalent_simulations - 7.2).abs() < 1e-12,
            "{found:?}"
        );
        let missing = outcome(result, log, "kb2").unwrap_err().to_string();
        assert!(missing.contains("kb2"), "{missing}");

        let scratch = tempfile::tempdir().expect("a folder");
        let answers = scratch.path().join("answers.json");
        fs::write(&answers, r#"{"sets": {"a": {"genes": {"kb1": 1e8}}}}"#).expect("a file");
        let searches = Searches {
            case: Path::new("case"),
            records: &[PathBuf::from("sets/a")],
            answers: &[answers],
            horsehead: Path::new("none"),
            presets: &["one".to_owned()],
            seeds: &[1],
            unknown: "kb1",
            out: scratch.path(),
        };
        let better = Outcome {
            objective: 0.25,
            ..found
        };
        let outcomes = Outcomes::from([((0, 0), vec![found]), ((1, 0), vec![found, better])]);
        let table = searches.table(&outcomes).expect("a table");
        assert!(
            table.contains("| shipped | `one` | 0.5000 | 0.0 % | (9.000) | 3 | 7 | 12 |"),
            "{table}"
        );
        assert!(
            table.contains("| a | `one` | 0.5000 / 0.2500 | 100.0 % / 0.0 % | +1.000 / +1.000 |"),
            "{table}"
        );
    }

    /// Checks that an existing result is read instead of starting the program.
    #[test]
    fn a_result_that_is_there_is_read() {
        let scratch = tempfile::tempdir().expect("a folder");
        fs::write(
            scratch.path().join("shipped-one-1.json"),
            r#"{"wall_s": 1.0, "genes": {"kb1": {"value": 1e8}}, "objective": {"optimised": 2.0}}"#,
        )
        .expect("a file");
        fs::write(
            scratch.path().join("shipped-one-1.csv"),
            "purpose\ninitial\n",
        )
        .expect("a file");
        let mut searches = Searches {
            case: Path::new("case"),
            records: &[],
            answers: &[],
            horsehead: Path::new("/none/such"),
            presets: &["one".to_owned()],
            seeds: &[1],
            unknown: "kb1",
            out: scratch.path(),
        };
        let mut said = 0;
        let mut say = |_: &str| {
            said += 1;
            Ok(())
        };
        let table = searches.run(&mut say).expect("a table");
        assert!(table.contains("(8.000)"), "{table}");
        searches.seeds = &[1, 2];
        let refused = searches.run(&mut say).unwrap_err().to_string();
        assert!(refused.contains("/none/such"), "{refused}");
        assert_eq!(said, 2);
    }
}
