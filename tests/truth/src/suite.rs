//! Complete run of the blind suite: makes sets of synthetic records with hidden effects, diagnoses them with
//! the program under test and keeps the verdicts; a stopped run continues.
//!
//! A set's name follows from the salt of the answer file and the set's number, so an incomplete set is made
//! again under the same name; records and verdicts get their final names only when complete.
use crate::files::Channels;
use crate::law::Tolerance;
use crate::machine::Resolution;
use crate::plan::{SetSpec, Stratum, make};
use crate::seal::Sealed;
use anyhow::{Context as _, bail};
use protocol::pumping_unit::PumpingUnit;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// Settings of a run of the blind test suite.
#[derive(Debug)]
pub struct Suite<'a> {
    /// Parameters of the pumping unit whose records are simulated.
    pub unit: PumpingUnit,
    /// Case folder of the pumping unit, passed to every diagnosis.
    pub case: &'a Path,
    /// Folder for record sets, run folders, the answer file and verdicts.
    pub out: &'a Path,
    /// Path of the program under test.
    pub horsehead: &'a Path,
    /// Seed from which the random seeds of all record sets are derived.
    pub seed: u64,
    /// Time since the start of the run after which no further set is started.
    pub time_limit: Option<Duration>,
}

/// Difference between the first random seeds of two consecutive strata (classes of record sets).
const STRATUM_SEED_STRIDE: u64 = 1000;
/// Interval, in sets of one stratum, at which a set gets records of only two gauges (every fourth).
const TWO_GAUGE_PERIOD: u64 = 4;

impl Suite<'_> {
    /// Returns the path of the answer file, which holds the hidden effects of all record sets.
    pub fn answers(&self) -> PathBuf {
        self.out.join("answers.json")
    }

    /// Returns the path of the folder in which the verdict of each diagnosed set is stored.
    pub fn verdicts(&self) -> PathBuf {
        self.out.join("verdicts")
    }

    /// Makes and diagnoses the given number of record sets of each stratum, with the strata interleaved;
    /// reports each set through `say`. A failed diagnosis leaves its set without a verdict and is reported.
    ///
    /// # Errors
    /// File system errors; a machine whose simulation never completes; a program that cannot be started.
    pub fn run(
        &self,
        counts: &[(Stratum, u16)],
        say: &mut dyn FnMut(&str) -> anyhow::Result<()>,
    ) -> anyhow::Result<()> {
        for folder in [
            self.verdicts(),
            self.out.join("sets"),
            self.out.join("runs"),
        ] {
            fs::create_dir_all(&folder).with_context(|| format!("making {}", folder.display()))?;
        }
        let orders = self.orders(counts);
        let begun = Instant::now();
        let (mut done, total) = (0_usize, orders.len());
        for (number, order) in orders.iter().enumerate() {
            if self.time_limit.is_some_and(|until| begun.elapsed() > until) {
                return say(&format!(
                    "{number} of {total} sets done; the time limit (--hours) is reached"
                ));
            }
            let name = self.make_set(order)?;
            let verdict = self.verdicts().join(format!("{name}.json"));
            if verdict.is_file() {
                continue;
            }
            let what = self.diagnose(&name, &verdict)?;
            done += 1;
            let left = begun.elapsed() / u32::try_from(done)? * u32::try_from(total - number - 1)?;
            say(&format!(
                "{} of {total}: {} {name} {what}; about {} min left",
                number + 1,
                order.stratum.name(),
                left.as_secs() / 60
            ))?;
        }
        Ok(())
    }

    /// Returns the specifications of all requested record sets, with the strata interleaved so that a run
    /// stopped early has some sets of each stratum.
    fn orders(&self, counts: &[(Stratum, u16)]) -> Vec<SetSpec> {
        let place = |stratum: Stratum| {
            let all = Stratum::ALL.iter().position(|other| *other == stratum);
            all.map_or(0, |place| place as u64)
        };
        let all = counts.iter().flat_map(|&(stratum, count)| {
            (0..count).map(move |k| (f64::from(k) / f64::from(count), stratum, u64::from(k)))
        });
        let mut all: Vec<(f64, Stratum, u64)> = all.collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let order = |(_, stratum, k): (f64, Stratum, u64)| SetSpec {
            seed: self.seed + STRATUM_SEED_STRIDE * place(stratum) + k,
            stratum,
            requested_effects: Vec::new(),
            size_factor: None,
            noise: 1.0,
            cycles: 5,
            fineness: Resolution::FULL,
            tolerance: Tolerance::USUAL,
            channels: if k % TWO_GAUGE_PERIOD == TWO_GAUGE_PERIOD - 1 {
                Channels::TWO
            } else {
                Channels::default()
            },
        };
        all.into_iter().map(order).collect()
    }

    /// Makes the record set of a specification, unless the answer file already lists it; returns the set's
    /// name.
    fn make_set(&self, order: &SetSpec) -> anyhow::Result<String> {
        let mut sealed = Sealed::load_or_new(&self.answers())?;
        let same = |answer: &crate::plan::Answer| {
            answer.seed == order.seed && answer.stratum == order.stratum
        };
        if let Some((name, _)) = sealed.sets.iter().find(|(_, answer)| same(answer)) {
            return Ok(name.clone());
        }
        let name = sealed.name();
        let folder = self.out.join("sets").join(&name);
        if folder.exists() {
            fs::remove_dir_all(&folder)
                .with_context(|| format!("removing {}", folder.display()))?;
        }
        fs::create_dir_all(&folder).with_context(|| format!("making {}", folder.display()))?;
        let answer = make(&self.unit, order, &folder, &name)?;
        sealed.sets.insert(name.clone(), answer);
        sealed.save(&self.answers())?;
        Ok(name)
    }

    /// Diagnoses a set, writes its verdict, and returns a short description of the outcome.
    fn diagnose(&self, name: &str, verdict: &Path) -> anyhow::Result<String> {
        let begun = Instant::now();
        let run = self.out.join("runs").join(name);
        let part = verdict.with_extension("part");
        let mut command = Command::new(self.horsehead);
        command.arg("diagnose").arg(self.case);
        command
            .arg("--measured")
            .arg(self.out.join("sets").join(name));
        command.arg("--run").arg(&run);
        let status = json_into(&mut command, &part)?;
        if !status.success() {
            if status.code().is_none() {
                bail!("the diagnosis of {name} was stopped; run `truth run` again to continue it");
            }
            return Ok(format!("failed ({status}): see {}", run.display()));
        }
        fs::rename(&part, verdict).with_context(|| format!("writing {}", verdict.display()))?;
        // its journal takes tens of megabytes, and the verdict is all that is judged
        fs::remove_dir_all(&run).with_context(|| format!("removing {}", run.display()))?;
        Ok(format!("in {} s", begun.elapsed().as_secs()))
    }
}

/// Runs a command of the program under test with `--output json`, writes its output into a file and discards
/// its error output.
///
/// # Errors
/// A file that cannot be written; a program that cannot be started.
pub(crate) fn json_into(command: &mut Command, path: &Path) -> anyhow::Result<ExitStatus> {
    let file = fs::File::create(path).with_context(|| format!("writing {}", path.display()))?;
    command
        .args(["--output", "json"])
        .stdin(Stdio::null())
        .stdout(file)
        .stderr(Stdio::null())
        .status()
        .with_context(|| format!("starting {}", command.get_program().to_string_lossy()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::fs::PermissionsExt as _;

    fn suite<'a>(out: &'a Path, horsehead: &'a Path) -> Suite<'a> {
        Suite {
            unit: PumpingUnit::of(shipped()).expect("the case"),
            case: Path::new("case"),
            out,
            horsehead,
            seed: 5,
            time_limit: None,
        }
    }

    fn shipped() -> protocol::case::Case {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/cyjs10-5-37hb");
        case::load(&folder, &case::Overrides::default()).expect("the case")
    }

    #[test]
    fn strata_are_mixed_and_seeds_are_their_own() {
        let none = Path::new("none");
        let orders = suite(none, none).orders(&[(Stratum::Single, 30), (Stratum::Zero, 10)]);
        assert_eq!(orders.len(), 40);
        let zeros = |orders: &[SetSpec]| {
            let zero = orders.iter().filter(|order| order.stratum == Stratum::Zero);
            zero.count()
        };
        assert_eq!(zeros(&orders[..20]), 5);
        let seeds: std::collections::BTreeSet<u64> = orders.iter().map(|o| o.seed).collect();
        assert_eq!(seeds.len(), 40);
        let two = orders
            .iter()
            .filter(|order| order.channels == Channels::TWO);
        assert_eq!(two.count(), 9);
    }

    /// Checks, with a shell script as the program under test, that a verdict file gets its final name only
    /// after a successful diagnosis.
    #[test]
    fn a_verdict_gets_its_name_when_it_is_whole() {
        let scratch = tempfile::tempdir().expect("a folder");
        let program = scratch.path().join("judged");
        let text = "#!/bin/sh\nmkdir -p \"$6\"\necho '{\"verdict\": \"nothing_detected\"}'\n\
                    test ! -e \"$6/../fails\"\n";
        fs::write(&program, text).expect("a program");
        fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).expect("it may run");
        let suite = suite(scratch.path(), &program);
        fs::create_dir_all(suite.verdicts()).expect("a folder");
        let runs = scratch.path().join("runs");
        fs::create_dir(&runs).expect("a folder");
        fs::write(runs.join("fails"), "").expect("a file");
        let verdict = suite.verdicts().join("set.json");
        let said = suite.diagnose("set", &verdict).expect("it starts");
        assert!(said.contains("failed") && !verdict.exists(), "{said}");
        assert!(runs.join("set").exists(), "what failed can be looked at");
        fs::remove_file(runs.join("fails")).expect("a file");
        suite.diagnose("set", &verdict).expect("it starts");
        let read = crate::verdict::Verdict::load(&verdict).expect("a verdict");
        assert_eq!(read.verdict, "nothing_detected");
        assert!(!runs.join("set").exists());
    }
}
