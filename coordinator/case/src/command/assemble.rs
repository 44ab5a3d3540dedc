//! Assembly of the description of a program that is sent to the workers from the case file's entries. All
//! names are cross-checked here, so that errors are reported when the case is read and not by a worker.
use super::{
    field_width::hidden_step,
    file::{ChannelEntry, CommandCaseFile, InputEntry, ModelEntry, OutputEntry, SourceEntry},
    files,
};
use crate::{
    document::{Document, DocumentStep, nearest, short},
    error::{CaseError, damaged},
    file,
    source::RecordFolder,
};
use exchange::{Problem, dakota, decoded, object, pest, table};
use protocol::{
    case::Case,
    external::{
        ChannelSource as From, Equation, EquationTerm, External, InputFile, InputFormat,
        OutputFile, OutputFormat, Parameter,
    },
};
use std::{
    collections::{BTreeMap, BTreeSet},
    path::Path,
};

/// Assembles the complete description of a case's program.
///
/// # Errors
/// Returns an error for a file that cannot be read, a name that is not defined, or a channel without a valid
/// source.
pub(super) fn assemble(
    source: &RecordFolder<'_>,
    own: &CommandCaseFile,
    case: &Case,
) -> Result<External, CaseError> {
    let assembly = Assembly {
        document: source.document,
        folder: source.folder,
        model: &own.model,
    };
    let parameters = assembly.parameters(case)?;
    let conditions: Vec<Vec<(String, f64)>> = own
        .conditions
        .iter()
        .map(|entry| entry.values.clone().into_iter().collect())
        .collect();
    let mut known: BTreeSet<String> = parameters.iter().map(|p| p.name.clone()).collect();
    for (index, values) in conditions.iter().enumerate() {
        assembly.check_same_names(index, values, &conditions[0])?;
        known.extend(values.iter().map(|(name, _)| name.clone()));
    }
    let fills = assembly.input_files(&known, (case, &parameters))?;
    let (readings, mut named) = assembly.output_files()?;
    let mut plain: BTreeSet<String> = case.unknowns.iter().map(|own| own.name.clone()).collect();
    plain.extend(conditions.iter().flatten().map(|(name, _)| name.clone()));
    let equations = assembly.equations(&plain)?;
    named.extend(equations.iter().map(|equation| equation.name.clone()));
    let curves = own.channels.iter().enumerate();
    let curve = |(index, channel): (usize, &ChannelEntry)| {
        let curve = assembly.channel_source(index, channel, &readings, &named)?;
        assembly.check_range(index, &curve, &readings, case)?;
        Ok(curve)
    };
    Ok(External {
        files: files::read(source.document, source.folder, &own.model.files)?,
        fills,
        curves: curves.map(curve).collect::<Result<_, CaseError>>()?,
        readings,
        equations,
        parameters,
        conditions,
        verdicts: assembly.verdicts()?,
    })
}

struct Assembly<'a> {
    document: &'a Document,
    folder: &'a Path,
    model: &'a ModelEntry,
}

/// Returns the remedy for an unknown name: the known one that is most like it, if there is one.
fn remedy(name: &str, known: &[&str]) -> String {
    nearest(name, known.iter().copied()).map_or("correct the name".to_owned(), |near| {
        format!("did you mean `{near}`?")
    })
}

impl Assembly<'_> {
    fn field_error(
        &self,
        keys: &[DocumentStep<'_>],
        value: impl std::fmt::Display,
        allowed: &str,
        help: &str,
    ) -> CaseError {
        self.document.field(keys, value, allowed, help)
    }

    /// Builds the error for an undefined name, with the most similar defined name as a suggestion.
    fn unknown(
        &self,
        keys: &[DocumentStep<'_>],
        name: &str,
        allowed: &str,
        names: &[&str],
    ) -> CaseError {
        let help = remedy(name, names);
        self.field_error(keys, format!("\"{name}\""), allowed, &help)
    }

    /// Returns the error for an unknown name in a template, with its place there.
    fn unknown_in(
        &self,
        template: &Path,
        text: &str,
        (name, allowed): (&str, &str),
        names: &[&str],
    ) -> CaseError {
        let help = remedy(name, names);
        let template = Document::new(self.folder.join(template), text.to_owned());
        // the marker of a PEST template ends its first line, `ptf ~`
        let first = text.lines().next().unwrap_or_default().trim_end();
        let marker = first
            .chars()
            .next_back()
            .filter(|_| first.starts_with("ptf"));
        let begins_field = |letter: char| letter == '{' || Some(letter) == marker;
        let is_field = |at: &usize| {
            let before = text.get(..*at).unwrap_or_default().trim_end();
            let before = before.chars().next_back();
            before.is_some_and(begins_field)
        };
        let lower = text.to_ascii_lowercase();
        let name_lower = name.to_ascii_lowercase();
        let mut places = lower.match_indices(&name_lower).map(|(at, _)| at);
        let at = places.find(is_field);
        template.place(at.unwrap_or(0), name, allowed, &help)
    }

    /// Returns the name, factor and offset with which each unknown of the case is written to the program's
    /// input files.
    fn parameters(&self, case: &Case) -> Result<Vec<Parameter>, CaseError> {
        let names = || case.unknowns.iter().map(|unknown| unknown.name.as_str());
        let stated = self.model.parameters.keys();
        if let Some(strange) = stated
            .into_iter()
            .find(|key| names().all(|name| name != *key))
        {
            let keys = ["model", "parameters", strange].map(DocumentStep::Key);
            return Err(self.unknown(
                &keys,
                strange,
                "the name of an unknown of the case",
                &names().collect::<Vec<_>>(),
            ));
        }
        let written = names().map(|name| {
            let entry = self.model.parameters.get(name);
            let other = entry.and_then(|entry| entry.name.clone());
            Parameter {
                name: other.unwrap_or_else(|| name.to_owned()),
                factor: entry.map_or(1.0, |entry| entry.factor),
                offset: entry.map_or(0.0, |entry| entry.offset),
            }
        });
        Ok(written.collect())
    }

    /// Checks that a condition sets the same value names as the first one, because all conditions share the
    /// same templates.
    fn check_same_names(
        &self,
        index: usize,
        values: &[(String, f64)],
        first: &[(String, f64)],
    ) -> Result<(), CaseError> {
        let names = |all: &[(String, f64)]| -> Vec<String> {
            all.iter().map(|(name, _)| name.clone()).collect()
        };
        if names(values) == names(first) {
            return Ok(());
        }
        let keys = [
            DocumentStep::Key("conditions"),
            DocumentStep::Index(index),
            DocumentStep::Key("values"),
        ];
        Err(self.field_error(
            &keys,
            names(values).join(", "),
            &format!(
                "the names that the first condition sets: {}",
                names(first).join(", ")
            ),
            "set the same names under every condition",
        ))
    }

    /// Reads a file in the case's folder as text.
    fn text(&self, path: &Path, role: &str) -> Result<String, CaseError> {
        let path = self.folder.join(path);
        file::text(&path, file::read(&path, role)?)
    }

    /// Checks that the fields of a template show the difference steps of the unknowns.
    fn check_widths(
        &self,
        path: &Path,
        fields: &BTreeMap<String, pest::TemplateField>,
        (case, parameters): (&Case, &[Parameter]),
    ) -> Result<(), CaseError> {
        for (index, parameter) in parameters.iter().enumerate() {
            let Some(field) = fields.get(&parameter.name.to_lowercase()) else {
                continue;
            };
            let Some(hidden) = hidden_step(case, index, parameter, *field) else {
                continue;
            };
            let (value, moved) = (short(hidden.value), short(hidden.moved));
            return Err(damaged(
                &self.folder.join(path),
                format!(
                    "line {}: the field of `{}` has {} characters, in which a difference step from {value} to {moved} does \
                     not show, so that no search sees it",
                    field.line, parameter.name, field.width
                ),
                &format!(
                    "widen the field to {} characters, including its two markers",
                    hidden.needed
                ),
            ));
        }
        Ok(())
    }

    /// Checks the analysis components of an input file.
    fn check_components(
        &self,
        keys: &[DocumentStep<'_>],
        input: &InputEntry,
    ) -> Result<(), CaseError> {
        if input.dakota.is_none() && !input.components.is_empty() {
            let allowed = "absent, unless the file is a parameters file of Dakota";
            let help = "state `dakota` for the file, or remove `components`";
            let stated = input.components.join(", ");
            return Err(self.field_error(keys, stated, allowed, help));
        }
        let is_breaking = |text: &&String| text.contains(['"', '\n', '\r']);
        if let Some(text) = input.components.iter().find(is_breaking) {
            let allowed =
                "texts of one line without double quotes, which are signs of the file's form";
            let help = "write the component without them";
            return Err(self.field_error(keys, text.escape_debug(), allowed, help));
        }
        Ok(())
    }

    fn input_files(
        &self,
        known: &BTreeSet<String>,
        written: (&Case, &[Parameter]),
    ) -> Result<Vec<InputFile>, CaseError> {
        let inputs = self.model.inputs.iter().enumerate();
        let fill = |(index, input): (usize, &InputEntry)| {
            let keys = |key| {
                let list = [DocumentStep::Key("model"), DocumentStep::Key("inputs")];
                [
                    list[0],
                    list[1],
                    DocumentStep::Index(index),
                    DocumentStep::Key(key),
                ]
            };
            self.check_components(&keys("components"), input)?;
            let (form, names) = match (&input.template, &input.braces, &input.dakota) {
                (Some(path), None, None) => {
                    let text = self.text(path, "a template that `inputs` names")?;
                    let template = pest::Template::parse(&path.to_string_lossy(), &text);
                    let template =
                        template.map_err(|problem| self.problem(&keys("template"), &problem))?;
                    let fields = template.fields();
                    self.check_widths(path, &fields, written)?;
                    (InputFormat::Pest(text), fields.into_keys().collect())
                }
                (None, Some(path), None) => {
                    let text = self.text(path, "a text file that `inputs` names")?;
                    let template = dakota::Template::parse(&path.to_string_lossy(), &text);
                    let template =
                        template.map_err(|problem| self.problem(&keys("braces"), &problem))?;
                    (
                        InputFormat::Braces(text),
                        template.fields().into_iter().collect(),
                    )
                }
                (None, None, Some(form)) if dakota::Form::named(form).is_some() => {
                    let form = InputFormat::Dakota {
                        form: form.clone(),
                        components: input.components.clone(),
                    };
                    (form, Vec::new())
                }
                (None, None, Some(form)) => {
                    let allowed = "standard, aprepro or json";
                    return Err(self.field_error(&keys("dakota"), form, allowed, "correct it"));
                }
                _ => {
                    let allowed = "exactly one of template, braces and dakota";
                    let help =
                        "state exactly one of `template`, `braces` and `dakota` for the file";
                    return Err(self.field_error(&keys("file"), &input.file, allowed, help));
                }
            };
            for name in &names {
                let is_known = known.iter().any(|own| own.eq_ignore_ascii_case(name));
                if !is_known {
                    let allowed =
                        "a field with the name of an unknown, or of a value of the conditions";
                    let known: Vec<&str> = known.iter().map(String::as_str).collect();
                    let template = input.template.as_ref().or(input.braces.as_ref());
                    if let (Some(path), InputFormat::Pest(text) | InputFormat::Braces(text)) =
                        (template, &form)
                    {
                        return Err(self.unknown_in(path, text, (name, allowed), &known));
                    }
                    return Err(self.unknown(&keys("file"), name, allowed, &known));
                }
            }
            Ok(InputFile {
                file: input.file.clone(),
                form,
            })
        };
        inputs.map(fill).collect()
    }

    /// Reads the case file's entries about the program's output files; returns them with the names of all
    /// single values that they define.
    fn output_files(&self) -> Result<(Vec<OutputFile>, BTreeSet<String>), CaseError> {
        let mut named = BTreeSet::new();
        let outputs = self.model.outputs.iter().enumerate();
        let reading = |(index, output): (usize, &OutputEntry)| {
            let keys = |key| {
                let list = [DocumentStep::Key("model"), DocumentStep::Key("outputs")];
                [
                    list[0],
                    list[1],
                    DocumentStep::Index(index),
                    DocumentStep::Key(key),
                ]
            };
            if output.gradients && output.dakota.is_none() {
                let allowed = "absent, unless the file is a results file of Dakota";
                let help = "state `dakota` for the file, or remove `gradients`";
                return Err(self.field_error(&keys("gradients"), true, allowed, help));
            }
            let form = match (&output.instructions, &output.dakota) {
                (Some(path), None) => {
                    let text = self.text(path, "instructions that `outputs` names")?;
                    let read = pest::Instructions::parse(&path.to_string_lossy(), &text);
                    let read =
                        read.map_err(|problem| self.problem(&keys("instructions"), &problem))?;
                    named.extend(read.observations());
                    OutputFormat::Pest(text)
                }
                (None, Some(functions)) => {
                    named.extend(functions.iter().cloned());
                    OutputFormat::Dakota {
                        functions: functions.clone(),
                        gradients: output.gradients,
                    }
                }
                (None, None)
                    if Path::new(&output.file)
                        .extension()
                        .is_some_and(|end| end == "json") =>
                {
                    OutputFormat::Object
                }
                (None, None) => OutputFormat::Table,
                (Some(_), Some(_)) => {
                    let allowed = "no more than one of instructions and dakota";
                    let help = "remove `instructions` or `dakota`";
                    return Err(self.field_error(&keys("file"), &output.file, allowed, help));
                }
            };
            Ok(OutputFile {
                file: output.file.clone(),
                form,
            })
        };
        let readings = outputs.map(reading).collect::<Result<_, _>>()?;
        Ok((readings, named))
    }

    fn equations(&self, known: &BTreeSet<String>) -> Result<Vec<Equation>, CaseError> {
        let equations = self.model.equations.iter().enumerate();
        let equation = |(index, entry): (usize, &super::file::EquationEntry)| {
            let term = |term: &super::file::TermEntry| {
                if !known.contains(&term.parameter) {
                    let keys = [
                        DocumentStep::Key("model"),
                        DocumentStep::Key("equations"),
                        DocumentStep::Index(index),
                    ];
                    let allowed = "the name of an unknown, or of a value of the conditions";
                    let known: Vec<&str> = known.iter().map(String::as_str).collect();
                    return Err(self.unknown(&keys, &term.parameter, allowed, &known));
                }
                Ok(EquationTerm {
                    parameter: term.parameter.clone(),
                    factor: term.factor,
                    log: term.log,
                })
            };
            Ok(Equation {
                name: entry.name.clone(),
                terms: entry.terms.iter().map(term).collect::<Result<_, _>>()?,
            })
        };
        equations.map(equation).collect()
    }

    /// Checks that the channel's abscissa points lie within the curve that a previous run of the program left
    /// in the case's folder, if there is one: a point outside the curve would fail every run.
    ///
    /// # Errors
    /// Returns an error for a channel that extends beyond that curve.
    fn check_range(
        &self,
        index: usize,
        curve: &From,
        readings: &[OutputFile],
        case: &Case,
    ) -> Result<(), CaseError> {
        let (reading, at, column) = match curve {
            From::Named(_) => return Ok(()),
            From::Column {
                reading,
                at,
                column,
            } => (*reading, at, Some(column)),
            From::Pointer { reading, at, .. } => (*reading, at, None),
        };
        let (Some(at), Some(channel)) = (at, case.channels.get(index)) else {
            return Ok(());
        };
        let left = &readings[reading].file;
        // what cannot be read there is no part of the case: the program writes it anew in its own folder
        let Ok(bytes) = std::fs::read(self.folder.join(left)) else {
            return Ok(());
        };
        let text = decoded(&bytes);
        let along = match column {
            None => object::values(left, &text, at),
            Some(column) => table::columns(left, &text, &[at.as_str(), column.as_str()])
                .map(|read| read.into_iter().next().unwrap_or_default()),
        };
        let Ok(along) = along else {
            return Ok(());
        };
        let places = &channel.abscissa.points;
        let (Some(first), Some(last)) = (along.first(), along.last()) else {
            return Ok(());
        };
        let (Some(&from), Some(&to)) = (places.first(), places.last()) else {
            return Ok(());
        };
        let slack = 1e-9 * (last - first).abs();
        if from >= first - slack && to <= last + slack {
            return Ok(());
        }
        let keys = [DocumentStep::Key("channels"), DocumentStep::Index(index)];
        let unit = &channel.abscissa.unit;
        Err(self.field_error(
            &keys,
            format!("channel `{}` from {from} to {to} {unit}", channel.name),
            &format!("abscissa values from {first} to {last} {unit}, the range of the program's curve in {left}"),
            &format!(
                "shorten the record, or let the program compute a longer curve; delete {left} from the case's folder if it is out of date"
            ),
        ))
    }

    /// Returns the source of a channel's values: named values, a table column or a JSON pointer.
    fn channel_source(
        &self,
        index: usize,
        channel: &ChannelEntry,
        readings: &[OutputFile],
        named: &BTreeSet<String>,
    ) -> Result<From, CaseError> {
        let keys = [
            DocumentStep::Key("channels"),
            DocumentStep::Index(index),
            DocumentStep::Key("source"),
        ];
        let allowed =
            "{ named = [..] }, { file, column } of a table or { file, values } of an object";
        let help = "state the output file and the values of it that form the channel";
        let Some(entry) = &channel.source else {
            let value = format!("absent of channel `{}`", channel.name);
            return Err(self.field_error(&keys, value, allowed, help));
        };
        let SourceEntry {
            named: names,
            file,
            column,
            values,
            at,
        } = entry;
        if let (Some(names), None, None, None, None) = (names, file, column, values, at) {
            if let Some(strange) = names.iter().find(|name| !named.contains(*name)) {
                let allowed = "a value that instructions, functions or equations name";
                let named: Vec<&str> = named.iter().map(String::as_str).collect();
                return Err(self.unknown(&keys, strange, allowed, &named));
            }
            return Ok(From::Named(names.clone()));
        }
        let (Some(file), None) = (file, names) else {
            return Err(self.field_error(&keys, "an invalid combination of keys", allowed, help));
        };
        let Some(reading) = readings.iter().position(|reading| reading.file == *file) else {
            let files: Vec<&str> = readings
                .iter()
                .map(|reading| reading.file.as_str())
                .collect();
            return Err(self.unknown(&keys, file, "the file of one of the outputs", &files));
        };
        match (&readings[reading].form, column, values) {
            (OutputFormat::Table, Some(column), None) => Ok(From::Column {
                reading,
                at: at.clone(),
                column: column.clone(),
            }),
            (OutputFormat::Object, None, Some(values)) => Ok(From::Pointer {
                reading,
                values: values.clone(),
                at: at.clone(),
            }),
            _ => Err(self.field_error(&keys, format!("file = \"{file}\""), allowed, help)),
        }
    }

    fn verdicts(&self) -> Result<Vec<(i32, String)>, CaseError> {
        let verdict = |(status, word): (&String, &String)| {
            let number = status
                .parse::<i32>()
                .ok()
                .filter(|number| (1..=255).contains(number));
            let is_word = protocol::job::Identifier::parse(word).is_some_and(|_| !word.is_empty());
            number
                .filter(|_| is_word)
                .map(|number| (number, word.clone()))
                .ok_or_else(|| {
                    let keys = ["model", "verdicts", status].map(DocumentStep::Key);
                    let allowed =
                        "an exit status from 1 to 255 with a word of lower-case letters, digits and `_`";
                    self.field_error(&keys, word, allowed, "as in verdicts = { 3 = \"diverged\" }")
                })
        };
        self.model.verdicts.iter().map(verdict).collect()
    }

    /// Converts a problem in a PEST template or instruction file to a case error.
    fn problem(&self, keys: &[DocumentStep<'_>], problem: &Problem) -> CaseError {
        let place = problem
            .line
            .map_or_else(String::new, |line| format!(", line {line}"));
        self.document.field(
            keys,
            format!("{}{place}: {}", problem.file, problem.found),
            problem.allowed.clone(),
            &problem.remedy,
        )
    }
}
