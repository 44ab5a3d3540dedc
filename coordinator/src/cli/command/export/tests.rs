//! Tests of the export of whole runs: the tables agree with the search's evaluation log and with the journal.
use super::*;
use crate::{
    cli::{argument::output::Output, output::progress::Silent},
    read_back::{self, Tables, Value},
    test_evaluator::{TestEvaluator, case, physics},
};
use journal::event::{Asked, Event, Finished, JobReason, RunHeader};
use journal::{Journal, JournalEntry, StudyEntries};
use protocol::{
    id::{AttemptId, ContentHash, JobId, RunId, WorkerId},
    job::{Answer, Job},
    message::{Attempt, Cost},
    wire,
};
use run::{
    calibration::calibrate,
    manifest::{self, CALIBRATE, FORMAT},
    opened::Run,
    session::dispatcher,
};
use search::{
    space::Space,
    strategy::{SearchPlan, preset},
};
use std::{
    fs,
    io::{Read as _, Seek as _, SeekFrom, Write as _},
    path::Path,
};
use study::{
    CalibrationResult, Completed, Entry, EvaluationLog, Evaluator, EvaluatorError, Snapshot,
};
use support::Problem;

/// Evaluator that simulates with the test oracle and writes every result to a journal, as a run does; fails
/// after `left` results, to imitate an interrupted run.
struct JournalingEvaluator {
    oracle: TestEvaluator,
    journal: Journal,
    entries: StudyEntries,
    jobs: BTreeMap<JobId, Job>,
    left: usize,
}

impl Evaluator for JournalingEvaluator {
    fn submit(&mut self, id: JobId, job: Job, reason: JobReason) -> Result<(), EvaluatorError> {
        let asked = Asked::new(id, &job, reason.clone());
        self.journal.append(Event::Asked(Box::new(asked))).unwrap();
        self.jobs.insert(id, job.clone());
        self.oracle.submit(id, job, reason)
    }

    fn enter(&mut self, entry: &Entry) -> Result<(), EvaluatorError> {
        let event = self.entries.enter(wire::encode(entry).unwrap()).unwrap();
        if let Some(event) = event {
            self.journal.append(event).unwrap();
        }
        Ok(())
    }

    async fn next(&mut self) -> Result<Completed, EvaluatorError> {
        if self.left == 0 {
            return Err(EvaluatorError {
                message: "enough".to_owned(),
                help: None,
                can_go_on: true,
            });
        }
        self.left -= 1;
        let completed = self.oracle.next().await?;
        let id = completed.id;
        let finished = Finished {
            attempt: Attempt {
                job: id,
                attempt: AttemptId::new(1, u32::try_from(id.0 % 3).unwrap()),
            },
            work: self.jobs[&id].work_hash(),
            worker: Some(WorkerId(7)),
            cost: Cost {
                wall_us: 1000 + id.0,
                cpu_us: id.0,
            },
            outcome: completed.outcome.clone(),
        };
        let event = Event::Finished(Box::new(finished));
        self.journal.append(event).unwrap();
        Ok(completed)
    }

    fn snapshot(&self) -> Snapshot {
        Snapshot::default()
    }
}

/// Calibrates with a [`JournalingEvaluator`] until the journal holds the given number of results; returns the
/// result if the run finished.
fn run_with(folder: &Path, results: usize) -> (JournalingEvaluator, Option<CalibrationResult>) {
    let case = case();
    let space = Space::new(&case.unknowns).unwrap();
    let manifest = Manifest {
        kind: CALIBRATE.to_owned(),
        format: FORMAT,
        program: manifest::PROGRAM.to_owned(),
        command: "horsehead calibrate X".to_owned(),
        preset: "memetic".to_owned(),
        seed: 3,
        set: Vec::new(),
        settings: (preset("memetic").unwrap().settings)(&SearchPlan {
            space: &space,
            workers: 1,
        }),
        start: None,
        table: None,
        assessed: None,
        case_folder: folder.to_owned(),
        measured: "X".to_owned(),
        synthetic: false,
        notes: vec!["one".to_owned(), "two, \"quoted\"".to_owned()],
        effects: Vec::new(),
        wall_s: 1.5,
    };
    fs::create_dir_all(folder).unwrap();
    let run = Run::begin(&folder.join("."), manifest, case).unwrap();
    run.save(1.5).unwrap();
    let header = RunHeader {
        kind: CALIBRATE.to_owned(),
        case: ContentHash::of(b"case"),
        settings: run.manifest.settings_json().unwrap(),
    };
    let (journal, begun) = Journal::open(folder, &header, RunId(1), 5, |_| {}).unwrap();
    let mut scribe = JournalingEvaluator {
        oracle: TestEvaluator::new(&run.case, 11, physics),
        journal,
        entries: begun.entries,
        jobs: BTreeMap::new(),
        left: results,
    };
    let found = dispatcher::block_on(async {
        let mut stop = tokio::sync::watch::channel(false).1;
        let found = calibrate(&mut scribe, &run, &mut Silent, &mut stop).await?;
        scribe.enter(&Entry::Estimated(Vec::new()))?;
        anyhow::Ok(found)
    });
    (scribe, found.ok())
}

fn arguments(run: &Path, format: Form, to: Option<&Path>) -> Arguments {
    Arguments {
        run: run.to_owned(),
        failed: false,
        format,
        to: to.map(Path::to_owned),
        force: false,
        output: OutputChoice {
            output: Output::Json,
        },
    }
}

fn files(paths: &[String]) -> BTreeMap<String, Vec<u8>> {
    let read = |path: &String| (path.clone(), fs::read(path).expect("it was written"));
    paths.iter().map(read).collect()
}

fn column<'a>(tables: &'a Tables, table: &str, column: &str) -> Vec<&'a Value> {
    let (names, rows) = &tables[table];
    let place = names.iter().position(|name| name == column).unwrap();
    rows.iter().map(|row| &row[place]).collect()
}

fn integers(tables: &Tables, table: &str, name: &str) -> Vec<i64> {
    let value = |value: &&Value| match value {
        Value::Integer(number) => Some(*number),
        Value::Null | Value::Real(_) | Value::Text(_) => None,
    };
    let values = column(tables, table, name);
    values.iter().map(value).map(Option::unwrap).collect()
}

/// Returns the results in a journal, in file order, read with `journal::fold`.
fn results(folder: &Path) -> Vec<(JournalEntry, Finished)> {
    let mut found = Vec::new();
    journal::fold(&folder.join(journal::FILE), |entry, event| {
        if let Event::Finished(finished) = event {
            found.push((entry, *finished));
        }
    })
    .unwrap();
    found
}

/// Asserts that the exported evaluations equal those of the search's log bit by bit.
fn expect_log(tables: &Tables, log: &EvaluationLog) {
    let case = case();
    let genes: Vec<Vec<&Value>> = (column(tables, "genes", "column").iter())
        .map(|name| match name {
            Value::Text(name) => column(tables, "evaluations", name),
            Value::Null | Value::Integer(_) | Value::Real(_) => Vec::new(),
        })
        .collect();
    assert_eq!(genes.len(), case.unknowns.len());
    let purposes = column(tables, "evaluations", "purpose");
    let fitness = column(tables, "evaluations", "fitness_mpa2");
    let jobs = integers(tables, "evaluations", "job");
    let at: BTreeMap<i64, usize> = jobs.iter().copied().zip(0..).collect();
    for entry in log.entries() {
        let row = at[&i64::try_from(entry.id).unwrap()];
        assert_eq!(
            *purposes[row],
            Value::Text(entry.purpose.as_str().to_owned())
        );
        assert_eq!(*fitness[row], Value::Real(entry.fitness));
        for (gene, value) in entry.genes.iter().enumerate() {
            assert_eq!(*genes[gene][row], Value::Real(*value));
        }
    }
}

#[test]
fn three_forms_hold_what_the_search_saw_and_leave_no_trace() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path().join("run");
    let (scribe, found) = run_with(&folder, usize::MAX);
    drop(scribe);
    let (log, before) = (
        found.unwrap().calibrated.log,
        fs::read(folder.join(journal::FILE)).unwrap(),
    );
    let mut all = Vec::new();
    for form in [Form::Sqlite, Form::Csv, Form::Parquet] {
        let made = export(&arguments(&folder, form, None)).unwrap();
        assert!(made.complete, "{:?}", made.notes);
        let first = files(&made.files);
        let tables = read_back::tables(&folder.join(Format::from(form).usual_name()), form.into());
        // again, over the first one
        let again = export(&arguments(&folder, form, None)).unwrap();
        assert_eq!(files(&again.files), first, "{form:?}");
        for (name, rows) in &made.rows {
            assert_eq!(tables[*name].1.len() as u64, *rows, "{form:?} {name}");
        }
        assert_eq!(tables.len(), made.rows.len());
        all.push(tables);
    }
    assert_eq!(fs::read(folder.join(journal::FILE)).unwrap(), before);
    assert_eq!(all[0], all[1]);
    assert_eq!(all[0], all[2]);
    let tables = &all[0];
    expect_log(tables, &log);
    let recorded = results(&folder);
    assert!(log.len() > 500, "{}", log.len());
    // both parameter sets are scored and simulated under both conditions
    assert_eq!(recorded.len(), log.len() + 8);
    assert_eq!(tables["evaluations"].1.len(), recorded.len());
    let jobs = integers(tables, "results", "job");
    let attempts = integers(tables, "results", "attempts");
    for (row, (_, finished)) in recorded.iter().enumerate() {
        assert_eq!(jobs[row], i64::try_from(finished.job().0).unwrap());
        assert_eq!(attempts[row], jobs[row] % 3 + 1);
    }
    let scored = recorded.iter().map(|(_, finished)| {
        if let Some(evaluation) = finished.outcome.answer().and_then(Answer::evaluation) {
            evaluation.channels.len()
        } else {
            0
        }
    });
    assert_eq!(tables["scores"].1.len(), scored.sum::<usize>());
    let kinds: std::collections::BTreeSet<String> = column(tables, "evaluations", "verdict")
        .iter()
        .map(|verdict| format!("{verdict:?}"))
        .collect();
    assert!(kinds.len() > 1, "no simulation failed: {kinds:?}");
}

/// Checks that the query in the manual runs and returns the best individuals.
#[test]
fn the_query_of_the_manual_finds_the_best_individuals() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path().join("run");
    let (_, found) = run_with(&folder, usize::MAX);
    export(&arguments(&folder, Form::Sqlite, None)).unwrap();
    let manual = include_str!("../../../../../docs/calibrate.md");
    let (_, behind) = manual.split_once("run.sqlite \"").unwrap();
    let (query, _) = behind.split_once('"').unwrap();
    let database = rusqlite::Connection::open(folder.join("run.sqlite")).unwrap();
    let mut statement = database.prepare(query).unwrap();
    let mut rows = statement.query([]).unwrap();
    let mut best = Vec::new();
    while let Some(row) = rows.next().unwrap() {
        best.push(row.get::<_, f64>("fitness_mpa2").unwrap());
    }
    let log = found.unwrap().calibrated.log;
    let complete = log
        .entries()
        .filter(|entry| entry.ending == study::EvaluationOutcome::Complete);
    let mut expected: Vec<f64> = complete.map(|entry| entry.fitness).collect();
    expected.sort_by(f64::total_cmp);
    expected.truncate(best.len());
    assert!(best.len() >= 5 && best == expected, "{best:?} {expected:?}");
}

#[test]
fn a_run_that_goes_on_is_exported_as_far_as_it_got() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path().join("run");
    let (mut scribe, found) = run_with(&folder, 300);
    assert!(found.is_none());
    // its coordinator is alive: it holds the lock and is in the middle of a record
    scribe.journal.close();
    let path = folder.join(journal::FILE);
    let mut file = fs::OpenOptions::new().append(true).open(&path).unwrap();
    file.write_all(&journal::MARK).unwrap();
    let made = export(&arguments(&folder, Form::Csv, None)).unwrap();
    assert!(!made.complete);
    assert_eq!((made.rows["results"], made.rows["damage"]), (300, 1));
    assert_eq!(made.rows["evaluations"], 300);
    let words = made.notes.join(" ");
    assert!(
        words.contains("unfinished record") && words.contains("have no result in the journal"),
        "{words}"
    );
    let tables = read_back::tables(&folder.join("csv"), Format::Csv);
    let jobs = integers(&tables, "evaluations", "job");
    // the look at the recommended individual comes first, under numbers beyond the search's
    let searched: Vec<&i64> = jobs.iter().filter(|job| **job < 1 << 40).collect();
    assert_eq!(jobs.len(), searched.len() + 4);
}

#[test]
fn damage_costs_what_it_touched() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path().join("run");
    drop(run_with(&folder, usize::MAX));
    let recorded = results(&folder);
    let whole = export(&arguments(&folder, Form::Csv, None)).unwrap();
    let (entry, lost) = &recorded[recorded.len() / 2];
    let mut file = fs::OpenOptions::new()
        .read(true)
        .write(true)
        .open(folder.join(journal::FILE))
        .unwrap();
    let mut byte = [0];
    file.seek(SeekFrom::Start(entry.at)).unwrap();
    file.read_exact(&mut byte).unwrap();
    file.seek(SeekFrom::Start(entry.at)).unwrap();
    file.write_all(&[byte[0] ^ 0x10]).unwrap();
    let made = export(&arguments(&folder, Form::Csv, None)).unwrap();
    assert!(!made.complete && made.notes.join(" ").contains("are damaged"));
    assert_eq!(made.rows["results"], whole.rows["results"] - 1);
    assert_eq!(made.rows["damage"], 1);
    let tables = read_back::tables(&folder.join("csv"), Format::Csv);
    let jobs = integers(&tables, "evaluations", "job");
    let lost = i64::try_from(lost.job().0).unwrap();
    assert!(!jobs.contains(&lost) && jobs.contains(&(lost - 1)));
    assert_eq!(made.rows["evaluations"], made.rows["results"]);
}

#[test]
fn a_run_without_results_has_empty_tables_and_another_folder_is_refused() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path().join("run");
    drop(run_with(&folder, 0));
    let made = export(&arguments(&folder, Form::Parquet, None)).unwrap();
    assert_eq!((made.rows["evaluations"], made.rows["results"]), (0, 0));
    assert_eq!(made.rows["genes"], 10);
    let tables = read_back::tables(&folder.join("parquet"), Format::Parquet);
    assert!(tables["evaluations"].1.is_empty() && tables["dictionary"].1.len() > 50);
    fs::remove_file(folder.join(journal::FILE)).unwrap();
    let error = export(&arguments(&folder, Form::Csv, None)).unwrap_err();
    assert!(error.to_string().contains("has no journal yet"), "{error}");
    let error = export(&arguments(scratch.path(), Form::Csv, None)).unwrap_err();
    assert!(error.to_string().contains("is no run folder"), "{error}");
    assert!(error.is::<Problem>());
    let left: Vec<_> = fs::read_dir(scratch.path()).unwrap().collect();
    assert_eq!(left.len(), 1, "only the run: {left:?}");
}

/// Checks that the tables follow from the journal alone: settings in `run.json` that were edited, or that this version
/// cannot read, change no row of the results.
#[test]
fn the_manifest_decides_nothing_about_results() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path().join("run");
    drop(run_with(&folder, 200));
    let results = || {
        export(&arguments(&folder, Form::Csv, None)).unwrap();
        let mut tables = read_back::tables(&folder.join("csv"), Format::Csv);
        tables.remove("run");
        tables
    };
    let before = results();
    assert_eq!(before["evaluations"].1.len(), 200);
    let file = folder.join("run.json");
    let mut manifest: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(&file).unwrap()).unwrap();
    manifest["seed"] = 4.into();
    manifest["settings"] = "of another version".into();
    fs::write(&file, manifest.to_string()).unwrap();
    assert_eq!(results(), before);
}

/// Checks that the journal states the result of a calibration, and that one without its conclusion, or without a result
/// that the search used, is refused.
#[test]
fn a_calibration_is_read_as_it_was_found() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path().join("run");
    let (scribe, found) = run_with(&folder, usize::MAX);
    drop(scribe);
    let path = folder.join(journal::FILE);
    let read = study::read_calibration(&path, &case()).unwrap();
    assert_eq!(Some(read.result), found);
    assert_eq!(read.costs.len(), results(&folder).len());

    let bytes = fs::read(&path).unwrap();
    let (entry, _) = results(&folder)[100];
    let mut damaged = bytes;
    damaged[usize::try_from(entry.at).unwrap()] ^= 1;
    fs::write(&path, damaged).unwrap();
    let refused = study::read_calibration(&path, &case()).unwrap_err();
    assert!(
        matches!(refused, study::RecordError::Incomplete),
        "{refused}"
    );

    let unfinished = scratch.path().join("unfinished");
    drop(run_with(&unfinished, 300));
    let refused = study::read_calibration(&unfinished.join(journal::FILE), &case()).unwrap_err();
    assert!(
        matches!(refused, study::RecordError::Unfinished),
        "{refused}"
    );
}
