//! External program prepared for a case, ready to evaluate any number of individuals.
use super::{
    fill::{Asked, Templates},
    gather::{Outputs, Readings, evaluate_equations},
    leftover_files,
    run::{self, RunPermit},
    scratch_folder::{self, ScratchFolder},
};
use crate::simulator::Model;
use exchange::allow::AllowEntry;
use protocol::{
    case::{Case, Channel},
    external::External,
    job::{
        Column, Counters, Derivative, Failure, Identifier, Observation, Per, Reached, SimulateSpec,
        Verdict, to_single_precision,
    },
};
use std::{
    collections::BTreeMap,
    path::PathBuf,
    sync::atomic::{AtomicU64, Ordering},
    time::Duration,
};

/// Failure kind reported when the program's results file itself reports a failure.
const FAIL: Identifier = Identifier::new("fail");

/// Number of failures per slot whose folder contents are sent along; a program that always fails needs no
/// more for its diagnosis.
const MAX_FOLDERS_SENT: u64 = 16;

/// External program prepared for a case.
#[derive(Debug)]
pub(super) struct Prepared {
    case: Case,
    external: External,
    entry: AllowEntry,
    /// Name of the program's entry in this computer's list of allowed programs.
    name: String,
    templates: Templates,
    readings: Readings,
    /// Directory in which the folders of evaluations are created.
    place: PathBuf,
    /// Exit statuses that mean a failed run rather than a crash, with the failure kind of each.
    verdicts: Vec<(i32, Identifier)>,
    /// Number of evaluations performed so far.
    evaluations: AtomicU64,
    /// Number of failures whose folder contents were sent.
    sent: AtomicU64,
}

impl Prepared {
    pub(super) fn new(
        case: &Case,
        external: External,
        entry: AllowEntry,
        name: &str,
    ) -> Result<Self, Failure> {
        let wrong = |field: &'static str| {
            move |problem: exchange::Problem| Failure::misconfigured(field, problem.to_string())
        };
        let lists = [
            ("unknowns", external.parameters.len(), case.unknowns.len()),
            (
                "conditions",
                external.conditions.len(),
                case.conditions.len(),
            ),
            ("channels", external.curves.len(), case.channels.len()),
        ];
        for (field, stated, needed) in lists {
            if stated != needed {
                let problem =
                    format!("the model section describes {stated}, but the case has {needed}");
                return Err(Failure::misconfigured(field, problem));
            }
        }
        let verdict = |(status, word): &(i32, String)| {
            let word = Identifier::parse(word).ok_or_else(|| {
                let problem =
                    format!("`{word}` must consist of lower-case letters, digits and `_`");
                Failure::misconfigured("model.verdicts", problem)
            });
            Ok((*status, word?))
        };
        let place = scratch_folder::parent(&entry);
        scratch_folder::clean(&place);
        Ok(Self {
            templates: Templates::new(&external.fills).map_err(wrong("model.inputs"))?,
            readings: Readings::new(&external.readings).map_err(wrong("model.outputs"))?,
            verdicts: external
                .verdicts
                .iter()
                .map(verdict)
                .collect::<Result<_, Failure>>()?,
            case: case.clone(),
            external,
            entry,
            name: name.to_owned(),
            place,
            evaluations: AtomicU64::new(0),
            sent: AtomicU64::new(0),
        })
    }

    /// Returns the values that fill the templates: those of the condition, and the unknowns after scaling
    /// (factor and offset).
    fn values(&self, spec: &SimulateSpec) -> Result<Vec<(String, f64)>, Failure> {
        let individual = &spec.individual;
        let condition = individual.condition;
        let own = self.external.conditions.get(condition).ok_or_else(|| {
            Failure::misconfigured("condition", format!("there is no condition {condition}"))
        })?;
        let parameters = self.external.parameters.iter().zip(&individual.genes);
        let unknowns = parameters.map(|(parameter, value)| {
            let written = parameter.factor * value + parameter.offset;
            (parameter.name.clone(), written)
        });
        Ok(own.iter().cloned().chain(unknowns).collect())
    }

    /// Returns the parameters on which the case's equations depend, by name: the condition's values and the
    /// unscaled unknowns.
    fn equation_parameters(&self, spec: &SimulateSpec) -> BTreeMap<String, f64> {
        let individual = &spec.individual;
        let own = self.external.conditions.get(individual.condition);
        let unknowns = self.case.unknowns.iter().zip(&individual.genes);
        let unknowns = unknowns.map(|(unknown, value)| (unknown.name.clone(), *value));
        own.into_iter().flatten().cloned().chain(unknowns).collect()
    }

    /// Returns the time limit of one run of the program: the case's deadline, but at most that of the
    /// program's entry.
    fn deadline(&self) -> Duration {
        let own = self.case.model.deadline_s.unwrap_or(f64::INFINITY);
        let seconds = own.min(self.entry.wall_s);
        Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX)
    }

    fn evaluate(&self, spec: &SimulateSpec) -> Result<Observation, Failure> {
        let crashed = Failure::crashed;
        let values = self.values(spec)?;
        let number = self.evaluations.fetch_add(1, Ordering::Relaxed) + 1;
        let functions = self.readings.functions();
        let program = self.entry.program.file_name();
        let asked = Asked {
            functions: &functions,
            gradients: self.returns_gradients(spec),
            driver: &program.unwrap_or_default().to_string_lossy(),
            evaluation: number,
        };
        let files = self
            .templates
            .filled(&values, &asked)
            .map_err(|problem| Failure::misconfigured("model.inputs", problem.to_string()))?;
        let turn = RunPermit::acquire(&self.place, &self.name, &self.entry)
            .map_err(|error| crashed(format!("{}: {error}", self.place.display())))?;
        let mut scratch = ScratchFolder::new(&self.place).map_err(|error| {
            crashed(format!(
                "cannot create a working folder in {}: {error}",
                self.place.display()
            ))
        })?;
        let prepared = scratch.unpack(&self.external.files).and_then(|()| {
            let mut files = files.iter();
            files.try_for_each(|(path, text)| scratch.write(path, text.as_bytes(), 0o600))
        });
        // what a case brings along as a result is none
        let prepared = prepared.and_then(|()| {
            self.readings.files().try_for_each(|file| {
                drop(std::fs::remove_file(scratch.inside(file)?));
                Ok(())
            })
        });
        prepared.map_err(|error| {
            crashed(format!("cannot fill the program's working folder: {error}"))
        })?;
        let outcome = self.run_program(spec, &scratch);
        drop(turn);
        outcome.map_err(|failure| self.attach_files(failure, &mut scratch))
    }

    /// Runs the program in a prepared folder and reads its output files.
    fn run_program(
        &self,
        spec: &SimulateSpec,
        scratch: &ScratchFolder,
    ) -> Result<Observation, Failure> {
        let status = run::run(&self.entry, scratch, self.deadline())?;
        let shown = self.entry.program.display();
        if !status.success() {
            let code = status.code();
            let verdict = self.verdicts.iter().find(|(own, _)| Some(*own) == code);
            return match verdict {
                Some((_, word)) => Ok(failed(*word)),
                None => Err(Failure::crashed(format!(
                    "{shown} {}",
                    run::describe_status(status, scratch)
                ))),
            };
        }
        let unusable = |what: String| {
            Failure::crashed(format!(
                "{shown} exited with status 0, but {what}{}",
                run::output_tail(scratch)
            ))
        };
        let left = |file: &str| run::read_output(scratch, file, &self.entry);
        let mut left = self.readings.read(left).map_err(unusable)?;
        if left.is_fail {
            return Ok(failed(FAIL));
        }
        if self.returns_gradients(spec) {
            let variables = self.values(spec)?.len();
            left.check_gradients(variables).map_err(unusable)?;
        }
        left.named.extend(evaluate_equations(
            &self.external.equations,
            &self.equation_parameters(spec),
        ));
        let condition = spec.individual.condition;
        let channels = self.case.channels_of(condition);
        let curve = |(at, channel): (usize, &Channel)| {
            let source = self.external.curves.get(at);
            let source = source
                .ok_or_else(|| format!("channel {at} has no source in the model's outputs"))?;
            self.readings.curve(source, channel, &left)
        };
        let curves: Vec<Vec<f64>> = channels
            .map(curve)
            .collect::<Result<_, _>>()
            .map_err(unusable)?;
        Ok(Observation {
            verdict: Verdict::Complete,
            counters: Counters::default(),
            curves,
            columns: self.columns(spec, &left),
        })
    }

    /// Returns whether the program is asked for gradients: a job that requests no derivatives needs none.
    fn returns_gradients(&self, spec: &SimulateSpec) -> bool {
        !spec.columns.is_empty() && self.readings.has_gradients()
    }

    /// Returns the requested derivatives, from the gradients by the variables that the program was given: the values of the
    /// condition, then the unknowns.
    fn columns(&self, spec: &SimulateSpec, left: &Outputs) -> Vec<Derivative> {
        if !self.returns_gradients(spec) {
            return Derivative::none(&spec.columns);
        }
        let condition = spec.individual.condition;
        let stated = self.external.conditions.get(condition).map_or(0, Vec::len);
        let column = |column: &Column| {
            let mut unknowns = self.case.unknowns.iter();
            let found = unknowns.position(|unknown| unknown.name == column.name);
            let found = found.and_then(|at| Some((at, self.external.parameters.get(at)?)));
            let Some((at, parameter)) = found else {
                return Derivative::Missing {
                    reason: format!("`{}` is no variable of the program", column.name),
                };
            };
            let curve = |(at_channel, _): (usize, &Channel)| {
                let source = self.external.curves.get(at_channel);
                let by = source.map(|source| left.derivative(source, stated + at));
                let by = by.unwrap_or_default().into_iter();
                to_single_precision(by.map(|by| parameter.factor * by))
            };
            Derivative::Curves {
                per: Per::Unit(self.case.unknowns[at].unit.clone()),
                curves: self.case.channels_of(condition).map(curve).collect(),
            }
        };
        spec.columns.iter().map(column).collect()
    }

    /// Adds the files of the working folder to a failure, and keeps the folder if the program's entry asks
    /// for it.
    fn attach_files(&self, mut failure: Failure, scratch: &mut ScratchFolder) -> Failure {
        if let Failure::Crashed { left, .. } | Failure::Deadline { left, .. } = &mut failure
            && self.sent.fetch_add(1, Ordering::Relaxed) < MAX_FOLDERS_SENT
        {
            *left = leftover_files::collect(scratch.root(), &self.external.files);
        }
        if self.entry.keep_failed {
            let kept = scratch.keep().display();
            if let Failure::Crashed { how, .. } = &mut failure {
                *how = format!("{how}\n  its folder is kept: {kept}");
            } else {
                tracing::info!("{failure}; its folder is kept: {kept}");
            }
        }
        failure
    }
}

/// Returns the outcome of a run that the program itself reports as failed, with the failure kind.
fn failed(kind: Identifier) -> Observation {
    Observation {
        verdict: Verdict::Failed {
            kind,
            reached: Reached::TimeFraction(0.0),
        },
        counters: Counters::default(),
        curves: Vec::new(),
        columns: Vec::new(),
    }
}

impl Model for Prepared {
    fn observe(&self, spec: &SimulateSpec, _: bool) -> Result<Observation, Failure> {
        self.evaluate(spec)
    }
}
