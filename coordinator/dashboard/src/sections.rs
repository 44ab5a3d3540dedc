//! Sections of the page of a run that goes on: its progress, and the sections of the report as far as they are
//! known.
use super::state::{RunState, WorkerState};
use discrepancy::laboratory::Finding;
use report::{
    Block, ConditionResult, Individual, ScoredCurves, Section, Table,
    document::{Fact, Row},
    number::{MISSING, count, duration, fixed, percent, significant},
    words,
};
use run::{
    calibration::{CalibrationRun, history_point},
    manifest::RunIdentity as _,
    orthogonal::Orthogonal,
    sweep_file::SweptFile,
    view::AnyRun,
};
use std::path::Path;
use std::time::{Duration, SystemTime};

/// Runs of an individual: for each condition its index and the run.
type Runs = [(usize, ScoredCurves)];

/// Maximum number of workers that the table lists, those that left last.
const MOST_WORKERS: usize = 600;

/// Runs of the two individuals that the page of a calibration compares.
#[derive(Clone, Copy, Default)]
pub(super) struct ComparedRuns<'a> {
    pub(super) recommended: Option<&'a Runs>,
    pub(super) best: Option<(&'a [f64], &'a Runs)>,
}

/// Returns the title of a run's page.
pub(super) fn title(run: &AnyRun) -> String {
    match run {
        AnyRun::Calibration(run) => format!("Calibration of {}", run.case.name),
        AnyRun::Diagnosis(run) => format!("Diagnosis of {}", run.case.name),
        AnyRun::Identification(run) => format!("Identifiability of {}", run.case.name),
        AnyRun::Test(run) => format!("Orthogonal test of a search on {}", run.case.name),
        AnyRun::Sweep(run) => format!("Sweep on {}", run.case.name),
    }
}

/// Returns the title of the page of a run of another kind, such as requests of another program.
pub(super) fn other_title(kind: &str, path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    format!("{} of {name}", words::capitalised(kind))
}

/// Returns the sections of a run of another kind, such as requests of another program: its results and workers.
pub(super) fn other(kind: &str, state: &RunState) -> Vec<Section> {
    let facts = vec![
        Fact::code("command", format!("horsehead {kind}")),
        Fact::new("results", count(state.results)),
    ];
    vec![progress(vec![Block::Facts(facts)]), workers(state)]
}

/// Returns the section of notices, such as a damaged journal; without blocks if there are none.
pub(super) fn notices(state: &RunState, error: Option<&str>) -> Section {
    let mut lines: Vec<String> = error.map(ToOwned::to_owned).into_iter().collect();
    lines.extend(state.damage.iter().cloned());
    let some = (!lines.is_empty()).then_some(Block::Warning(lines));
    Section {
        id: "notices",
        title: "Notices",
        blocks: some.into_iter().collect(),
    }
}

/// Returns the sections of a run that is not finished.
pub(super) fn unfinished(
    run: &AnyRun,
    state: &RunState,
    compared: ComparedRuns<'_>,
) -> Vec<Section> {
    match run {
        AnyRun::Calibration(run) => {
            let mut sections = vec![search_progress(run, state)];
            sections.extend(calibration(run, state, compared));
            sections.push(workers(state));
            sections
        }
        AnyRun::Diagnosis(_) => vec![
            stage_progress(state),
            gaps(state),
            suspects(state),
            workers(state),
        ],
        AnyRun::Identification(_) => vec![stage_progress(state), workers(state)],
        AnyRun::Test(_) => other(Orthogonal::KIND, state),
        AnyRun::Sweep(_) => other(SweptFile::KIND, state),
    }
}

/// Returns the time since the last coordinator process began.
fn running_s(state: &RunState) -> f64 {
    let opened = SystemTime::UNIX_EPOCH + Duration::from_millis(state.opened_unix_ms);
    let passed = opened.elapsed().unwrap_or_default();
    if state.opened_unix_ms == 0 {
        0.0
    } else {
        passed.as_secs_f64()
    }
}

fn search_progress(run: &CalibrationRun, state: &RunState) -> Section {
    let log = state.reading.log();
    let (generations, planned) = state.plan;
    let (completed, failed) = (log.len() as u64, log.failed() as u64);
    let unit = words::square_after(run.case.objective_unit());
    let mut facts = vec![Fact::new(
        "evaluations",
        format!(
            "{} of about {}",
            count(completed),
            count(planned.max(completed))
        ),
    )];
    if generations > 1 {
        facts.push(Fact::new(
            "generation or stage",
            format!(
                "{} of {}",
                state.generation,
                generations.max(state.generation)
            ),
        ));
    }
    if let Some(best) = state.best() {
        facts.push(Fact::new(
            "best objective",
            format!(
                "{}{unit}, individual {}",
                significant(best.fitness),
                best.id
            ),
        ));
    }
    facts.push(Fact::new("did not complete", count(failed)));
    let ahead = planned.saturating_sub(completed);
    facts.extend((ahead > 0).then(|| time_left(state, ahead)).flatten());
    facts.push(Fact::code("command", run.manifest.command.clone()));
    progress(vec![Block::Facts(facts)])
}

/// Estimates the time for the remaining evaluations from the rate since the last coordinator process began.
fn time_left(state: &RunState, ahead: u64) -> Option<Fact> {
    let passed_s = running_s(state);
    let busy_s: f64 = state.workers.values().map(|worker| worker.busy_s).sum();
    if state.closed || state.results == 0 || passed_s <= 0.0 || busy_s <= 0.0 {
        return None;
    }
    let slots: u32 = connected(state).map(|worker| worker.slots).sum();
    let one_s = busy_s / state.results as f64;
    let left_s = ahead as f64 * one_s / f64::from(slots.max(1));
    Some(Fact::new("at least left", duration(left_s)))
}

fn connected(state: &RunState) -> impl Iterator<Item = &WorkerState> {
    let workers = state.workers.values();
    workers.filter(|worker| worker.left.is_none())
}

const fn progress(blocks: Vec<Block>) -> Section {
    Section {
        id: "progress",
        title: "Progress",
        blocks,
    }
}

/// Returns the section on the stages of a diagnosis or identification.
fn stage_progress(state: &RunState) -> Section {
    let Some(present) = state.stage else {
        return progress(vec![Block::Text("No stage has begun yet.".to_owned())]);
    };
    let rows = state.budget.iter().map(|(stage, budget)| {
        let own = state.stages.get(stage).copied();
        let words = match own {
            None => "not begun",
            Some(_) if *stage == present => "running",
            Some(_) => "done",
        };
        let left = own.map(|own| (budget - own.spent).max(0.0));
        let left = left.filter(|left| left.is_finite());
        let left = left.map_or_else(|| MISSING.to_owned(), |left| fixed(left, 0));
        let own = own.unwrap_or_default();
        let open = own.asked.saturating_sub(own.done);
        Row::new(
            stage.name(),
            [words.to_owned(), count(own.done), count(open), left],
        )
    });
    let table = Table::new(
        "Stages",
        ["stage", "state", "simulations", "open", "budget left"],
        rows.collect(),
    )
    .with_notes(["Budget left: in simulations without derivatives; a stage ends sooner where it finds its answer."]);
    let facts = vec![
        Fact::new("stage", present.name()),
        Fact::new("simulations", count(state.results)),
    ];
    progress(vec![Block::Facts(facts), Block::Table(table)])
}

/// Returns the section on the gap as it closes: one row for each model that was tested.
fn gaps(state: &RunState) -> Section {
    let mut models: Vec<&Finding> = state.findings.values().collect();
    models.dedup_by(|one, other| one.added == other.added);
    let first = models.first().map_or(0.0, |finding| finding.gap);
    let rows = models.iter().map(|finding| {
        let name = if finding.added.is_empty() {
            "the recalibrated model".to_owned()
        } else {
            format!("with {}", finding.added.join(", "))
        };
        let closed = 1.0 - finding.gap / first;
        let closed = closed.is_finite().then(|| percent(closed));
        Row::new(
            name,
            [
                format!("{}\u{a0}%", significant(100.0 * finding.gap)),
                closed.unwrap_or_else(|| MISSING.to_owned()),
            ],
        )
    });
    let table = Table::new("The gap so far", ["", "gap", "closed"], rows.collect());
    let table = table.with_notes([
        "Gap on the cycles that are fitted: mean squared residual above the noise of the averaged record, over the \
         variance of the measured curve. The verdict also needs cycles and conditions that are held out.",
    ]);
    Section {
        id: "gaps",
        title: "The gap as it closes",
        blocks: table.non_empty().map(Block::Table).into_iter().collect(),
    }
}

/// Formats a p-value; very small ones as a bound.
fn p_value(p: f64) -> String {
    if p < 1e-12 {
        "< 10⁻¹²".to_owned()
    } else {
        significant(p)
    }
}

/// Returns the section on the suspects of the last model that was tested.
fn suspects(state: &RunState) -> Section {
    let rows = state
        .findings
        .values()
        .last()
        .into_iter()
        .flat_map(|finding| {
            finding.suspects.iter().map(|suspect| {
                let gain = suspect.gain.map(|gain| fixed(gain, 1));
                Row::new(
                    suspect.id.as_str(),
                    [
                        suspect.title.clone(),
                        p_value(suspect.p_value),
                        gain.unwrap_or_else(|| MISSING.to_owned()),
                    ],
                )
            })
        });
    let table = Table::new(
        "Effects that the record may speak for",
        [
            "effect",
            "title",
            "p of its own test",
            "gain after a refit [nats]",
        ],
        rows.collect(),
    );
    let table = table.with_notes([
        "Not a verdict: an effect is named only when all rounds are over, its rivals are rejected and held-out data \
         agree.",
    ]);
    Section {
        id: "suspects",
        title: "Suspects",
        blocks: table.non_empty().map(Block::Table).into_iter().collect(),
    }
}

/// Returns the sections of the report of a calibration that goes on.
fn calibration(run: &CalibrationRun, state: &RunState, compared: ComparedRuns<'_>) -> Vec<Section> {
    let Some(best) = state.best() else {
        return Vec::new();
    };
    let account = state.account.clone().finish(Vec::new());
    let shown = compared.best.map_or(&best.genes[..], |(genes, _)| genes);
    let log = state.reading.log();
    let entry = log.entries().find(|entry| entry.genes == shown);
    let data = report::Calibration {
        case: run.case.clone(),
        origin: match run.origin(String::new()) {
            Ok(origin) => origin,
            Err(_) => return Vec::new(),
        },
        recommended: Individual {
            id: None,
            genes: run.case.start(),
        },
        optimised: Individual {
            id: entry.map(|entry| entry.id),
            genes: shown.to_vec(),
        },
        history: log
            .entries()
            .map(|entry| history_point(entry, state.costs.get(&entry.id).copied()))
            .collect(),
        workers: account.workers,
        presence: account.presence,
        spent: account.spent,
        wall_s: running_s(state),
        finish: String::new(),
        conditions: match (compared.recommended, compared.best) {
            (Some(recommended), Some((_, best))) => pair(recommended, best),
            _ => Vec::new(),
        },
        identifiability: Vec::new(),
        rivals: Vec::new(),
        assessments: Vec::new(),
        notes: [&run.manifest.notes[..], &state.notes].concat(),
    };
    report::running_calibration(&data)
}

/// Pairs the runs of the recommended and of another individual by condition.
pub(super) fn pair(
    recommended: &[(usize, ScoredCurves)],
    other: &[(usize, ScoredCurves)],
) -> Vec<ConditionResult> {
    let pair = |(condition, run): &(usize, ScoredCurves)| {
        let (_, optimised) = other.iter().find(|(own, _)| own == condition)?;
        Some(ConditionResult {
            condition: *condition,
            recommended: run.clone(),
            optimised: optimised.clone(),
        })
    };
    recommended.iter().filter_map(pair).collect()
}

/// Returns the section on the workers of a run that goes on.
fn workers(state: &RunState) -> Section {
    let mut all: Vec<_> = state.workers.iter().collect();
    all.sort_by_key(|(_, worker)| worker.left.is_some());
    let rows = all.iter().take(MOST_WORKERS).map(|(id, worker)| {
        Row::new(
            id.to_string(),
            [
                worker.host.clone(),
                count(u64::from(worker.slots)),
                count(worker.done),
                count(worker.failed),
                duration(worker.busy_s),
                worker
                    .left
                    .clone()
                    .unwrap_or_else(|| "connected".to_owned()),
            ],
        )
    });
    let table = Table::new(
        "Workers",
        [
            "worker",
            "host",
            "slots",
            "results",
            "failed",
            "computing",
            "state",
        ],
        rows.collect(),
    );
    let slots: u64 = connected(state).map(|worker| u64::from(worker.slots)).sum();
    let lead = format!(
        "{} workers with {} slots are connected; {} have left.",
        connected(state).count(),
        count(slots),
        all.len() - connected(state).count()
    );
    Section {
        id: "live-workers",
        title: "Workers",
        blocks: if all.is_empty() {
            vec![Block::Text("No worker has joined yet.".to_owned())]
        } else {
            vec![Block::Text(lead), Block::Table(table)]
        },
    }
}
