//! Fills the input files of an external program with the values of an individual.
use exchange::{Problem, dakota, pest};
use protocol::external::{InputFile, InputFormat};
use std::collections::BTreeMap;

/// Template of an input file, parsed once and filled for every individual.
#[derive(Debug)]
pub(super) struct Template {
    /// Path of the filled file, relative to the program's folder.
    pub(super) file: String,
    form: Form,
}

#[derive(Debug)]
enum Form {
    Pest(pest::Template),
    Braces(dakota::Template),
    Dakota(dakota::Form, Vec<String>),
}

/// What a Dakota parameters file says besides the values.
#[derive(Clone, Copy, Debug)]
pub(super) struct Asked<'a> {
    /// Functions that the results file must contain.
    pub(super) functions: &'a [String],
    /// Whether their gradients are requested.
    pub(super) gradients: bool,
    /// Name of the program.
    pub(super) driver: &'a str,
    /// Number of the evaluation.
    pub(super) evaluation: u64,
}

/// Templates of all input files of an external program.
#[derive(Debug)]
pub(super) struct Templates {
    all: Vec<Template>,
    /// Width in characters of the narrowest PEST field of each parameter, which limits the digits of its
    /// value.
    widths: BTreeMap<String, usize>,
}

impl Templates {
    /// Parses the templates of a case's input files.
    pub(super) fn new(fills: &[InputFile]) -> Result<Self, Problem> {
        let all: Vec<Template> = fills.iter().map(template).collect::<Result<_, _>>()?;
        let mut widths = BTreeMap::new();
        for template in &all {
            if let Form::Pest(own) = &template.form {
                for (name, field) in own.fields() {
                    let narrowest = widths.entry(name).or_insert(field.width);
                    *narrowest = field.width.min(*narrowest);
                }
            }
        }
        Ok(Self { all, widths })
    }

    /// Returns path and text of every filled input file, for given parameter values. A value is rounded to
    /// its parameter's narrowest PEST field in all files, so that every file holds the same number.
    pub(super) fn filled(
        &self,
        values: &[(String, f64)],
        asked: &Asked<'_>,
    ) -> Result<Vec<(&str, String)>, Problem> {
        let mut texts = BTreeMap::new();
        let mut written = Vec::new();
        for (name, value) in values {
            let text = match self.widths.get(&name.to_lowercase()) {
                None => Some(value.to_string()),
                Some(width) => pest::fit(*value, *width),
            };
            let text = text.ok_or_else(|| Problem {
                file: "the templates".to_owned(),
                line: None,
                found: format!("{name} = {value} does not fit into its narrowest field"),
                allowed: "a field that holds the number".to_owned(),
                remedy: "widen the field between its markers".to_owned(),
            })?;
            written.push((name.clone(), exchange::number(&text).unwrap_or(*value)));
            texts.insert(name.to_lowercase(), text.clone());
            texts.insert(name.clone(), text);
        }
        let fill = |template: &Template| match &template.form {
            Form::Pest(own) => own.fill(&texts),
            Form::Braces(own) => own.fill(&texts),
            Form::Dakota(form, components) => Ok(dakota::parameters(&dakota::Request {
                form: *form,
                variables: &written,
                functions: asked.functions,
                gradients: asked.gradients,
                driver: asked.driver,
                components,
                evaluation: asked.evaluation,
            })),
        };
        let files = self.all.iter();
        files
            .map(|template| Ok((template.file.as_str(), fill(template)?)))
            .collect()
    }
}

fn template(fill: &InputFile) -> Result<Template, Problem> {
    let form = match &fill.form {
        InputFormat::Pest(text) => Form::Pest(pest::Template::parse(&fill.file, text)?),
        InputFormat::Braces(text) => Form::Braces(dakota::Template::parse(&fill.file, text)?),
        InputFormat::Dakota { form, components } => {
            let known = dakota::Form::named(form).ok_or_else(|| Problem {
                file: fill.file.clone(),
                line: None,
                found: format!("form `{form}` of Dakota's parameters"),
                allowed: "standard, aprepro or json".to_owned(),
                remedy: "correct the form of this input in the case".to_owned(),
            })?;
            Form::Dakota(known, components.clone())
        }
    };
    Ok(Template {
        file: fill.file.clone(),
        form,
    })
}
