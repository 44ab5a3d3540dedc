//! Writer of the Dakota parameters file that a driver reads.
use serde_json::json;
use std::fmt::Write as _;

/// Format of a Dakota parameters file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Dakota's standard format: `value label`.
    Standard,
    /// APREPRO format: `{ label = value }`.
    Aprepro,
    /// JSON format: one object.
    Json,
}

impl Form {
    /// Returns the format of a given name; `None` for an unknown name.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "standard" => Some(Self::Standard),
            "aprepro" => Some(Self::Aprepro),
            "json" => Some(Self::Json),
            _ => None,
        }
    }
}

/// Content of a parameters file.
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// Format of the file.
    pub form: Form,
    /// Labels and values of the variables.
    pub variables: &'a [(String, f64)],
    /// Labels of the response functions.
    pub functions: &'a [String],
    /// Whether the gradients of the functions by all variables are requested, in addition to their values.
    pub gradients: bool,
    /// Name of the driver to which the analysis components belong.
    pub driver: &'a str,
    /// Analysis components, texts that a case passes on to its driver.
    pub components: &'a [String],
    /// Number of the evaluation.
    pub evaluation: u64,
}

/// Formats a parameters file in the layout of Dakota's own writers (`src/*ParametersFileWriter.cpp` of its sources, May 2026), with
/// an empty list of metadata.
pub fn parameters(request: &Request<'_>) -> String {
    let Request {
        form,
        variables,
        functions,
        driver,
        components,
        evaluation,
        ..
    } = *request;
    let active_set = if request.gradients { 3 } else { 1 };
    if form == Form::Json {
        let labelled = |(label, value): &(String, f64)| json!({"label": label, "value": value});
        let wanted = |label: &String| json!({"label": label, "active_set": active_set});
        let of_driver = |text: &String| json!({"driver": driver, "component": text});
        let object = json!({
            "variables": variables.iter().map(labelled).collect::<Vec<_>>(),
            "responses": functions.iter().map(wanted).collect::<Vec<_>>(),
            "derivative_variables": (1..=variables.len()).collect::<Vec<_>>(),
            "analysis_components": components.iter().map(of_driver).collect::<Vec<_>>(),
            "eval_id": evaluation.to_string(),
            "metadata": [],
        });
        return format!("{object:#}\n");
    }
    let is_aprepro = form == Form::Aprepro;
    let mut text = String::new();
    // writing to a text does not fail
    let mut row = |label: &str, value: &str| {
        let _written = if is_aprepro {
            writeln!(text, "{:20}{{ {label:<15} = {value:>22} }}", "")
        } else {
            writeln!(text, "{:21}{value:>22} {label}", "")
        };
    };
    let name = |standard: &'static str, aprepro: &'static str| {
        if is_aprepro { aprepro } else { standard }
    };
    let count = variables.len().to_string();
    row(name("variables", "DAKOTA_VARS"), &count);
    for (label, value) in variables {
        row(label, &scientific(*value));
    }
    let asked = functions.len().to_string();
    row(name("functions", "DAKOTA_FNS"), &asked);
    for (at, label) in (1..).zip(functions) {
        row(&format!("ASV_{at}:{label}"), &active_set.to_string());
    }
    row(name("derivative_variables", "DAKOTA_DER_VARS"), &count);
    for (at, (label, _)) in (1..).zip(variables) {
        row(&format!("DVV_{at}:{label}"), &at.to_string());
    }
    let texts = components.len().to_string();
    row(name("analysis_components", "DAKOTA_AN_COMPS"), &texts);
    for (at, component) in (1..).zip(components) {
        let component = if is_aprepro {
            // the width is that of the quote in front of the text
            format!("{:>22}{component}\"", '"')
        } else {
            component.clone()
        };
        row(&format!("AC_{at}:{driver}"), &component);
    }
    row(name("eval_id", "DAKOTA_EVAL_ID"), &evaluation.to_string());
    row(name("metadata", "DAKOTA_METADATA"), "0");
    text
}

/// Formats a number with 16 digits and an exponent of two or more, as `std::scientific` does.
fn scientific(value: f64) -> String {
    let text = format!("{value:.15e}");
    let Some((digits, exponent)) = text.split_once('e') else {
        return text;
    };
    let (sign, exponent) = exponent
        .strip_prefix('-')
        .map_or(('+', exponent), |positive| ('-', positive));
    format!("{digits}e{sign}{exponent:0>2}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    /// Checks the files byte for byte against those that Dakota's own reader has accepted: `accept.py` beside them reads
    /// them with `dakota.interfacing`.
    #[test]
    fn files_are_those_that_dakotas_reader_accepts() {
        let variables = [("k".to_owned(), 2.5), ("zone:c".to_owned(), -1e-3)];
        let functions = ["w1".to_owned(), "w2".to_owned()];
        let components = ["mesh 1.exo".to_owned(), "b".to_owned()];
        for (form, name) in [
            (Form::Standard, "standard.in"),
            (Form::Aprepro, "aprepro.in"),
            (Form::Json, "json.in"),
        ] {
            let written = parameters(&Request {
                form,
                variables: &variables,
                functions: &functions,
                gradients: form != Form::Standard,
                driver: "drive.py",
                components: &components,
                evaluation: 7,
            });
            let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/external/dakota");
            let accepted = std::fs::read_to_string(folder.join(name)).unwrap();
            assert_eq!(written, accepted, "{name}");
        }
    }
}
