//! Machines that an assessment compares, such as that of the life of a part, and their simulations: the machine of a case,
//! a calibration or a diagnosis, the same without each of its effects, and those beside it by which a quantity has an
//! interval.
use crate::{
    calibration::{self, CalibrationRun},
    diagnosis::{DiagnosisRun, inputs_at},
    folder::{GENES, RunFolder},
    hash::short_hash,
    manifest::{BALANCE, CALIBRATE, DIAGNOSE, LIFE, Manifest, RunIdentity, StartPoint},
    name::RunName,
    opened::Run,
};
use case::{DiagnoseEntry, Loaded, Overrides, load_with_notes};
use discrepancy::{
    diagnose::Estimate,
    estimate::neighbourhood::{Neighbourhood, NoNeighbourhood},
};
use protocol::{
    case::{Case, EffectSetting},
    job::{Curves, Verdict},
};
use report::words;
use search::strategy::family::rivals;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use study::{CompareRequest, Compared, Evaluator, NamedIndividual, StageView, Stop, Watch};
use support::Problem;

/// Settings of an assessment: the machines that it simulates.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Machines {
    /// Machines that are compared; the last one is assessed in full.
    compared: Vec<NamedIndividual>,
    /// Fits of other families that a calibration saw, best first.
    others: Vec<Vec<f64>>,
}

/// Settings of an assessment of the life of a part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LifeSettings(pub Machines);

/// Settings of an assessment of the balance of a drive.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BalanceSettings(pub Machines);

impl RunIdentity for LifeSettings {
    const KIND: &'static str = LIFE;
    const SEEDED: bool = false;
}

impl RunIdentity for BalanceSettings {
    const KIND: &'static str = BALANCE;
    const SEEDED: bool = false;
}

/// Source of the individuals about the assessed machine.
enum Uncertainty {
    /// None: nothing was fitted, or the case has changed since the run.
    Unknown,
    /// An estimate from the records of the case, at parameters that were fitted to them.
    Estimate(Box<Loaded>, Vec<f64>),
    /// The answer of a diagnosis; `None` where it came to none.
    Answer(Option<Result<Neighbourhood, NoNeighbourhood>>),
}

/// Case, calibration or diagnosis that is assessed.
pub struct AssessmentTarget {
    /// Folder of the case.
    pub folder: PathBuf,
    /// Case, with the effects that a diagnosis found.
    pub case: Case,
    machines: Machines,
    /// Run that is assessed; `None` for a case.
    pub run: Option<PathBuf>,
    /// Parameters that replace the recommended ones of a case.
    start: Option<StartPoint>,
    uncertainty: Uncertainty,
    measured: Option<PathBuf>,
    /// Notes on the case and its records.
    pub notes: Vec<String>,
    synthetic: bool,
}

impl AssessmentTarget {
    /// Reads a case folder, with the parameters of a gene file if one is given, or a finished calibration or diagnosis.
    ///
    /// # Errors
    /// If the case, the gene file or the run cannot be read, or the run is of another kind or not finished.
    pub fn read(target: &Path, genes: Option<&Path>) -> anyhow::Result<Self> {
        let folder = RunFolder::new(target);
        if !folder.is_begun() {
            return Self::of_case(target, genes);
        }
        if genes.is_some() {
            return Err(Problem {
                message: "--genes is given with a run, whose parameters are its own".to_owned(),
                remedy: "leave --genes out, or name the case folder instead of the run".to_owned(),
            }
            .into());
        }
        match folder.head()?.kind.as_str() {
            CALIBRATE => Self::of_calibration(target),
            DIAGNOSE => Self::of_diagnosis(target),
            other => Err(Problem {
                message: format!("{} holds a run of `horsehead {other}`", target.display()),
                remedy: "name a case folder, or the folder of a calibration or a diagnosis"
                    .to_owned(),
            }
            .into()),
        }
    }

    fn of_case(target: &Path, genes: Option<&Path>) -> anyhow::Result<Self> {
        let mut loaded = load_with_notes(target, &Overrides::default())?;
        let start = genes.map(|file| StartPoint::read(file, &mut loaded));
        let start = start.transpose()?;
        let name = genes.map_or_else(
            || "recommended".to_owned(),
            |file| file.display().to_string(),
        );
        let values = start.as_ref();
        let values = values.map_or_else(|| loaded.case.start(), |start| start.genes.clone());
        Ok(Self {
            folder: target.to_owned(),
            case: loaded.case.clone(),
            machines: Machines {
                compared: with_and_without(&loaded.case, &name, &values),
                others: Vec::new(),
            },
            run: None,
            notes: loaded.notes.iter().map(ToString::to_string).collect(),
            synthetic: loaded.synthetic,
            uncertainty: if start.is_some() {
                Uncertainty::Estimate(Box::new(loaded), values)
            } else {
                Uncertainty::Unknown
            },
            start,
            measured: None,
        })
    }

    fn of_calibration(target: &Path) -> anyhow::Result<Self> {
        let run = CalibrationRun::open(target)?;
        let (loaded, notes) = match run.loaded() {
            Ok(loaded) => (Some(loaded), Vec::new()),
            Err(error) => (None, vec![format!("there are no intervals: {error}")]),
        };
        let found = calibration::recorded(run.expect_parameters()?)?
            .result
            .calibrated;
        let best = found.best.genes.clone();
        let space = run.manifest.space(&run.case)?;
        let others = rivals(
            &space,
            (&best, found.best.fitness),
            &found.descent_ends,
            |_| true,
        );
        let mut compared = vec![NamedIndividual::new("recommended", run.case.start())];
        compared.extend(with_and_without(&run.case, "optimised", &best));
        Ok(Self {
            machines: Machines {
                compared,
                others: others
                    .into_iter()
                    .map(|own| own.end.genes.clone())
                    .collect(),
            },
            uncertainty: loaded.map_or(Uncertainty::Unknown, |loaded| {
                Uncertainty::Estimate(Box::new(loaded), best)
            }),
            run: Some(target.to_owned()),
            start: None,
            folder: run.manifest.case_folder.clone(),
            measured: run.manifest.replaced_records().map(ToOwned::to_owned),
            notes,
            synthetic: run.manifest.synthetic,
            case: run.case,
        })
    }

    fn of_diagnosis(target: &Path) -> anyhow::Result<Self> {
        let run = DiagnosisRun::open(target)?;
        let diagnosis = crate::diagnosis::recorded(run.expect_parameters()?)?
            .result
            .diagnosis;
        let before_found = run.case.clone();
        let mut loaded = Loaded {
            case: run.case,
            notes: Vec::new(),
            cycles: Vec::new(),
            synthetic: run.manifest.synthetic,
            effects: run.manifest.effects.clone(),
            diagnose: DiagnoseEntry::default(),
        };
        // notes on the gene file tell what the diagnosis found
        let start = StartPoint::read(&run.folder.file(GENES), &mut loaded)?;
        let case = loaded.case;
        let added = diagnosis.after.iter().flat_map(|fit| &fit.added);
        let added: Vec<&Estimate> = added
            .filter_map(|id| diagnosis.effects.iter().find(|own| own.id == *id))
            .collect();
        let plain = |name: &str, genes: &[f64]| {
            added
                .iter()
                .fold(NamedIndividual::new(name, genes.to_vec()), |own, found| {
                    without(own, found, &before_found)
                })
        };
        let mut compared = vec![plain("recommended", &case.start())];
        let before = diagnosis.before.as_ref().filter(|_| !added.is_empty());
        let with_found = |own: &[f64]| {
            let mut genes = start.genes.clone();
            genes[..own.len()].copy_from_slice(own);
            genes
        };
        compared.extend(before.map(|before| plain("recalibrated", &with_found(&before.genes))));
        let switched = added.iter().filter(|found| !found.unknowns.is_empty());
        compared.extend(switched.map(|found| {
            let name = format!("diagnosed without {}", found.id);
            without(
                NamedIndividual::new(name, start.genes.clone()),
                found,
                &before_found,
            )
        }));
        compared.extend(with_and_without(&case, "diagnosed", &start.genes));
        // as the diagnosis simulated them: its answer may need more iterations than the case's budget has
        let thresholds = &run.manifest.settings.thresholds;
        let (numerics, _) = case::kind::of(&case).diagnosis_numerics(
            &case,
            thresholds.step,
            thresholds.refinement,
        )?;
        for own in &mut compared {
            own.numerics = numerics.clone();
        }
        // individuals of the fit state what was added as effects; genes of the case have it as unknowns
        let neighbourhood = diagnosis.neighbourhood.map(|mut own| {
            for individual in own.iter_mut().flat_map(|own| &mut own.individuals) {
                individual.genes = with_found(&individual.genes);
            }
            own
        });
        Ok(Self {
            folder: run.manifest.case_folder.clone(),
            case,
            machines: Machines {
                compared,
                others: Vec::new(),
            },
            run: Some(target.to_owned()),
            start: None,
            uncertainty: Uncertainty::Answer(neighbourhood),
            measured: run.manifest.replaced_records().map(ToOwned::to_owned),
            notes: run.manifest.notes.clone(),
            synthetic: run.manifest.synthetic,
        })
    }

    /// Begins or resumes the run of an assessment: in `folder`, else inside the run that is assessed, else in a folder
    /// below `runs/` that belongs to this case and these parameters.
    ///
    /// # Errors
    /// As [`Run::begin`].
    pub fn begin<S: RunIdentity>(
        &self,
        folder: Option<&Path>,
        settings: impl FnOnce(Machines) -> S,
    ) -> anyhow::Result<Run<S>> {
        let path = match (folder, &self.run) {
            (Some(folder), _) => folder.to_owned(),
            (None, Some(run)) => run.join(S::KIND),
            (None, None) => RunName {
                case_folder: &self.folder,
                case: &self.case,
                what: S::KIND,
                set: &[short_hash(&(&self.case, &self.machines))?],
                measured: None,
                seed: 0,
            }
            .path()?,
        };
        let manifest = self.manifest(settings(self.machines.clone()))?;
        Run::begin(&path, manifest, self.case.clone())
    }

    /// Returns the machine that is assessed in full.
    pub fn assessed(&self) -> Option<&NamedIndividual> {
        self.machines.compared.last()
    }

    fn manifest<S: RunIdentity>(&self, settings: S) -> anyhow::Result<Manifest<S>> {
        let measured = self.measured.as_ref().unwrap_or(&self.folder);
        Ok(Manifest {
            measured: measured.display().to_string(),
            synthetic: self.synthetic,
            notes: self.notes.clone(),
            assessed: self.run.as_ref().map(std::path::absolute).transpose()?,
            start: self.start.clone(),
            ..Manifest::new(&self.folder, 0, settings)?
        })
    }

    /// Returns the individuals about the assessed machine, or the reason why there are none, if one is known.
    async fn neighbourhood<E: Evaluator>(
        &self,
        evaluator: &mut E,
        watch: &mut dyn Watch<StageView>,
        stop: &mut Stop,
    ) -> anyhow::Result<Result<Neighbourhood, Option<String>>> {
        let found = match &self.uncertainty {
            Uncertainty::Unknown => return Ok(Err(None)),
            Uncertainty::Estimate(loaded, genes) => {
                let manifest = self.manifest(LifeSettings(self.machines.clone()))?;
                let inputs = inputs_at(loaded, &manifest, genes)?;
                match study::neighbourhood_at_start_on(evaluator, &inputs, watch, stop).await? {
                    Some(found) => found,
                    None => return Ok(Err(None)),
                }
            }
            Uncertainty::Answer(Some(found)) => found.clone(),
            Uncertainty::Answer(None) => {
                let reason = "the diagnosis ended before it came to an answer";
                return Ok(Err(Some(reason.to_owned())));
            }
        };
        Ok(found.map_err(|reason| {
            Some(match reason {
                NoNeighbourhood::Undetermined => {
                    "the record does not determine all unknowns".to_owned()
                }
                NoNeighbourhood::Misfit(ratio) => format!(
                    "the fit leaves {ratio:.1} times the noise, so that its numbers are not those of the machine; \
                     `horsehead diagnose` finds what the model lacks"
                ),
            })
        }))
    }
}

/// Returns a machine without each of the case's effects, then with all.
fn with_and_without(case: &Case, name: &str, genes: &[f64]) -> Vec<NamedIndividual> {
    let each = case.effects.iter().map(|own| NamedIndividual {
        effects: vec![absent(&own.id)],
        ..NamedIndividual::new(format!("{name} without {}", own.id), genes.to_vec())
    });
    each.chain([NamedIndividual::new(name, genes.to_vec())])
        .collect()
}

/// Returns a machine without an effect that a diagnosis added: without that of the library, or with the unknowns that it
/// switched on at their values in the case as it was before.
fn without(mut machine: NamedIndividual, found: &Estimate, before: &Case) -> NamedIndividual {
    if found.unknowns.is_empty() {
        machine.effects.push(absent(&found.id));
    }
    let off = before.start();
    for &position in &found.unknowns {
        machine.genes[position] = off[position];
    }
    machine
}

/// Returns the setting of an effect that is absent: no parameter is stated.
fn absent(id: &str) -> EffectSetting {
    EffectSetting::new(id, &[])
}

/// Machine with its simulated curves.
#[derive(Clone, Debug)]
pub struct SimulatedMachine {
    /// Name of the machine in results.
    pub name: String,
    /// Curves under each condition of the request.
    pub curves: Vec<Curves>,
}

/// Simulations of an assessment.
#[derive(Clone, Debug)]
pub struct SimulatedMachines {
    /// Machines that are compared; the last one is assessed in full.
    pub compared: Vec<SimulatedMachine>,
    /// Fits of other families.
    pub others: Vec<SimulatedMachine>,
    /// Machines about the last one, by which a quantity has an interval, in the order of the individuals, without drawn
    /// ones that did not complete; `None` where a quantity has no interval.
    pub about: Option<(Neighbourhood, Vec<SimulatedMachine>)>,
    /// Reasons why machines were left out, or why quantities have no interval.
    pub notes: Vec<String>,
}

/// Simulates the machines of an assessment under several conditions, with a number of snapshots of the motion. Machines
/// beside the assessed one that do not complete are left out.
///
/// # Errors
/// If the simulation of the assessed machine ends early, one cannot be done, no evaluator is left, or the user stops.
pub async fn simulate_machines<E: Evaluator>(
    evaluator: &mut E,
    target: &AssessmentTarget,
    wanted: (&[usize], u32),
    watch: &mut dyn Watch<StageView>,
    stop: &mut Stop,
) -> anyhow::Result<SimulatedMachines> {
    let Machines { compared, others } = &target.machines;
    let mut individuals = compared.clone();
    let assessed = individuals.len().saturating_sub(1);
    let further = (1..).zip(others);
    individuals.extend(
        further.map(|(k, genes)| NamedIndividual::new(format!("other fit {k}"), genes.clone())),
    );
    let position = individuals.len();
    let all = simulate(evaluator, &target.case, wanted, (0, individuals), stop).await?;
    let mut simulated = SimulatedMachines {
        compared: Vec::new(),
        others: Vec::new(),
        about: None,
        notes: Vec::new(),
    };
    for (k, machine) in all.into_iter().enumerate() {
        match machine {
            Ok(machine) if k <= assessed => simulated.compared.push(machine),
            Ok(machine) => simulated.others.push(machine),
            Err(problem) if k == assessed => return Err(problem.into()),
            Err(problem) => simulated
                .notes
                .push(format!("left out: {}", problem.message)),
        }
    }
    let found = target.neighbourhood(evaluator, watch, stop).await?;
    let neighbourhood = match found {
        Ok(neighbourhood) => neighbourhood,
        Err(reason) => {
            let note = reason.map(|own| format!("there are no intervals: {own}"));
            simulated.notes.extend(note);
            return Ok(simulated);
        }
    };
    let numerics = target.assessed().map(|own| own.numerics.clone());
    let numerics = numerics.unwrap_or_default();
    let individuals = (1..).zip(&neighbourhood.individuals);
    let individuals = individuals.map(|(number, own)| NamedIndividual {
        name: format!("neighbour {number}"),
        genes: own.genes.clone(),
        effects: own.effects.clone(),
        numerics: numerics.clone(),
    });
    let individuals = (position, individuals.collect());
    let mut about = simulate(evaluator, &target.case, wanted, individuals, stop).await?;
    let drawn = about.split_off(neighbourhood.along_parameters());
    match about.into_iter().collect::<Result<Vec<_>, Problem>>() {
        Ok(mut about) => {
            about.extend(drawn.into_iter().flatten());
            simulated.about = Some((neighbourhood, about));
        }
        Err(problem) => {
            let note = format!("there are no intervals: {}", problem.message);
            simulated.notes.push(note);
        }
    }
    Ok(simulated)
}

/// Simulates individuals under several conditions, with a number of snapshots, the first of them in a position of its own
/// among those of the run. A machine that does not complete is an error of its own.
async fn simulate<E: Evaluator>(
    evaluator: &mut E,
    case: &Case,
    (conditions, frames): (&[usize], u32),
    (first, individuals): (usize, Vec<NamedIndividual>),
    stop: &mut Stop,
) -> anyhow::Result<Vec<Result<SimulatedMachine, Problem>>> {
    let request = |&condition: &usize| CompareRequest {
        condition,
        first,
        individuals: individuals.clone(),
        frames,
        columns: Vec::new(),
    };
    let wanted: Vec<CompareRequest> = conditions.iter().map(request).collect();
    let groups = study::compare(evaluator, case, &wanted, stop).await?;
    let machines = individuals.iter().enumerate();
    let machine = |(k, own): (usize, &NamedIndividual)| {
        Ok(SimulatedMachine {
            name: own.name.clone(),
            curves: curves(case, &groups, k)?,
        })
    };
    Ok(machines.map(machine).collect())
}

/// Collects the curves of individual `k` under all conditions.
///
/// # Errors
/// If a simulation ended early.
pub fn curves(case: &Case, groups: &[Compared], k: usize) -> Result<Vec<Curves>, Problem> {
    let each = groups
        .iter()
        .filter_map(|group| Some((group, group.individuals.get(k)?)));
    let complete = each.map(|(group, own)| {
        if own.drawn.verdict == Verdict::Complete {
            return Ok(own.drawn.clone());
        }
        let condition = &case.conditions[group.condition].name;
        Err(Problem {
            message: format!(
                "the simulation of the {} parameters at {condition} {}",
                own.name,
                words::verdict(&own.drawn.verdict)
            ),
            remedy:
                "an assessment needs a whole revolution; `horsehead simulate` shows how far it came"
                    .to_owned(),
        })
    });
    complete.collect()
}
