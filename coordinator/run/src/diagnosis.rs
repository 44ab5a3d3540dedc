//! Work of a diagnosis: its settings, its inputs (case and measured cycles) and its execution.
use crate::{
    command_line::quote,
    manifest::{self, DIAGNOSE, Manifest},
    opened::Run,
};
use case::Loaded;
use discrepancy::{
    baseline::discretisation_check::Preflight, diagnose::Inputs, model::InactiveUnknowns,
    thresholds::Thresholds,
};
use protocol::{announce::EffectDescriptor, case::Case};
use report::diagnosis::DiagnosisInput;
use search::space::Space;
use serde::{Deserialize, Serialize};
use study::{self, Entry, Evaluator, RecordedDiagnosis, StageView, Stop, Watch};
use support::Problem;

/// Run of `horsehead diagnose`.
pub type DiagnosisRun = Run<DiagnosisSettings>;

/// Settings that determine the result of a diagnosis, besides case, seed and start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DiagnosisSettings {
    /// Thresholds of the statistical tests and limits of the diagnosis.
    pub thresholds: Thresholds,
    /// Whether every derivative is a finite difference of whole simulations.
    pub differences: bool,
}

impl manifest::RunIdentity for DiagnosisSettings {
    const KIND: &'static str = DIAGNOSE;

    fn arguments(&self) -> String {
        let mut words = format!(" --rounds {}", self.thresholds.rounds);
        if !self.thresholds.without.is_empty() {
            words.extend([" --without ", &quote(&self.thresholds.without.join(","))]);
        }
        if self.differences {
            words.push_str(" --differences");
        }
        words
    }
}

/// Requests the library of effects from the workers and runs the diagnosis; enters records, notes and result.
///
/// # Errors
/// If an effect to be excluded is unknown; otherwise as [`study::diagnose_on`].
pub async fn diagnose<E: Evaluator>(
    evaluator: &mut E,
    manifest: &Manifest<DiagnosisSettings>,
    loaded: &Loaded,
    watch: &mut dyn Watch<StageView>,
    stop: &mut Stop,
) -> anyhow::Result<()> {
    let (library, notes) = begin(evaluator, loaded, watch, stop).await?;
    let off = InactiveUnknowns::of(&loaded.case.unknowns);
    for id in &manifest.settings.thresholds.without {
        let mut known = library.iter().chain(off.iter().map(|off| &off.candidate));
        if known.all(|suspect| suspect.id != *id) {
            let names = library.iter().filter(|e| !e.generic).map(|e| e.id.as_str());
            let known: Vec<&str> = names.collect();
            return Err(Problem {
                message: format!("the workers know no effect `{id}`"),
                remedy: format!("they know: {}", known.join(", ")),
            }
            .into());
        }
    }
    let own = &manifest.settings;
    let inputs = Inputs {
        differences: own.differences,
        ..inputs(
            loaded,
            manifest,
            &own.thresholds,
            (library, basin_search_preset(&loaded.case)),
        )?
    };
    let mut diagnosed = study::diagnose_on(evaluator, &inputs, watch, stop).await?;
    diagnosed.notes = notes;
    let result = &diagnosed.diagnosis;
    let check = result
        .preflight_after
        .as_ref()
        .or(result.preflight.as_ref());
    if check.is_some_and(Preflight::is_rough) {
        let finer =
            case::kind::of(&loaded.case).finer_settings(&loaded.case, own.thresholds.refinement)?;
        if !finer.is_empty() {
            let lines: Vec<String> = finer.iter().map(|line| format!("`{line}`")).collect();
            diagnosed.notes.push(format!(
                "what lowers the numerical error, at the cost of longer simulations: {} in case.toml",
                lines.join(", ")
            ));
        }
    }
    Ok(evaluator.enter(&Entry::Diagnosed(Box::new(diagnosed)))?)
}

/// Enters the records, requests the library of effects and checks the records; shows and enters the notes of the check,
/// and returns library and notes.
///
/// # Errors
/// As [`study::library`] and [`study::check_records`], or if an entry cannot be written.
pub(crate) async fn begin<E: Evaluator>(
    evaluator: &mut E,
    loaded: &Loaded,
    watch: &mut dyn Watch<StageView>,
    stop: &mut Stop,
) -> anyhow::Result<(Vec<EffectDescriptor>, Vec<String>)> {
    for record in Entry::records(&loaded.cycles) {
        evaluator.enter(&record)?;
    }
    let library = study::library(evaluator, stop).await?;
    let notes = study::check_records(evaluator, &loaded.case, &loaded.cycles, stop).await?;
    watch.noted(&notes);
    evaluator.enter(&Entry::Noted(notes.clone()))?;
    Ok((library, notes))
}

/// Reads the result of a finished diagnosis from its journal.
///
/// # Errors
/// If the diagnosis is not finished, or its journal is missing or of another version.
pub fn recorded(run: &DiagnosisRun) -> anyhow::Result<RecordedDiagnosis> {
    let read = study::read_diagnosis(&run.expect_journal()?);
    let mut recorded = read.map_err(|error| run.unreadable(error))?;
    let of_case = run.manifest.notes.iter().cloned();
    recorded.result.notes.splice(..0, of_case);
    Ok(recorded)
}

/// Returns the preset of the search that finds the basin of attraction of the fit: `quick` if the case
/// declares a narrow minimum (valley), else `least-squares`, whose local descents find the basin with a
/// fraction of the simulations.
pub(crate) fn basin_search_preset(case: &Case) -> &'static str {
    let narrow = case.unknowns.iter().any(|unknown| unknown.valley.is_some());
    if narrow { "quick" } else { "least-squares" }
}

/// Builds the inputs of a fit: the measured records, that of the calibrated condition first; the library
/// without the effects that the case already has; and `entrance`, the preset of the search that finds the
/// basin of attraction.
///
/// # Errors
/// If the case has no space to search, or the data of its kind of model cannot be decoded.
pub(crate) fn inputs<S>(
    loaded: &Loaded,
    manifest: &Manifest<S>,
    thresholds: &Thresholds,
    (library, entrance): (Vec<EffectDescriptor>, &'static str),
) -> anyhow::Result<Inputs> {
    let case = &loaded.case;
    let space = Space::new(&case.unknowns)?;
    let calibrated = case.objective.condition;
    let mut records = loaded.cycles.clone();
    records.sort_by_key(|record| record.condition != calibrated);
    records.retain(|record| record.condition == calibrated || !record.cycles.is_empty());
    // effects that the case has already are ordinary physics, not suspects
    let library = library
        .into_iter()
        .filter(|effect| case.effects.iter().all(|own| own.id != effect.id))
        .collect();
    let (usual, finer) =
        case::kind::of(case).diagnosis_numerics(case, thresholds.step, thresholds.refinement)?;
    Ok(Inputs {
        conditions: case.conditions.iter().map(|own| own.name.clone()).collect(),
        unknowns: case.unknowns.clone(),
        start: manifest.start_genes().map(|genes| space.point(genes)),
        families: manifest.families().map(|all| {
            let points = all.iter().map(|genes| space.point(genes));
            points.collect()
        }),
        space,
        records,
        library,
        usual,
        finer,
        global_search: entrance,
        seed: manifest.seed,
        thresholds: thresholds.clone(),
        differentiates: !case::kind::of(case).is_program(),
        differences: false,
    })
}

/// Builds the inputs of an estimate at given values of the unknowns, such as [`study::estimate_at_start_on`].
///
/// # Errors
/// As [`inputs`].
pub(crate) fn inputs_at<S>(
    loaded: &Loaded,
    manifest: &Manifest<S>,
    genes: &[f64],
) -> anyhow::Result<Inputs> {
    let nothing = (Vec::new(), "");
    let inputs = inputs(loaded, manifest, &Thresholds::default(), nothing)?;
    Ok(Inputs {
        start: Some(inputs.space.point(genes)),
        ..inputs
    })
}

/// Builds the data of a finished diagnosis's report; its sessions took `wall_s` seconds in total.
///
/// # Errors
/// If the case cannot be encoded.
pub fn report_input<'a>(
    run: &'a DiagnosisRun,
    recorded: &'a RecordedDiagnosis,
    wall_s: f64,
) -> anyhow::Result<DiagnosisInput<'a>> {
    Ok(DiagnosisInput {
        case: &run.case,
        diagnosed: recorded,
        origin: run.origin(String::new())?,
        assessments: run.folder.assessments()?,
        wall_s,
    })
}
