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

/// Formats a parameters file: variables, one active-set entry per function (requesting values only),
/// derivative variables, no analysis components, and the number of the evaluation.
pub fn parameters(
    form: Form,
    variables: &[(String, f64)],
    functions: &[String],
    evaluation: u64,
) -> String {
    if form == Form::Json {
        let labelled = |(label, value): &(String, f64)| json!({"label": label, "value": value});
        let wanted = |label: &String| json!({"label": label, "active_set": 1});
        let object = json!({
            "variables": variables.iter().map(labelled).collect::<Vec<_>>(),
            "responses": functions.iter().map(wanted).collect::<Vec<_>>(),
            "derivative_variables": variables.iter().map(|(label, _)| label).collect::<Vec<_>>(),
            "analysis_components": [],
            "eval_id": evaluation.to_string(),
        });
        return format!("{object:#}\n");
    }
    let mut text = String::new();
    let mut row = |value: String, label: String| {
        // writing to a text does not fail
        let _written = match form {
            Form::Aprepro => writeln!(text, "{{ {label} = {value} }}"),
            Form::Standard | Form::Json => writeln!(text, "{value:>24} {label}"),
        };
    };
    let (count, asked) = (variables.len(), functions.len());
    let own = |aprepro: &str, standard: &str| match form {
        Form::Aprepro => aprepro.to_owned(),
        Form::Standard | Form::Json => standard.to_owned(),
    };
    row(count.to_string(), own("DAKOTA_VARS", "variables"));
    for (label, value) in variables {
        row(format!("{value:.15e}"), label.clone());
    }
    row(asked.to_string(), own("DAKOTA_FNS", "functions"));
    for (at, label) in functions.iter().enumerate() {
        row("1".to_owned(), format!("ASV_{}:{label}", at + 1));
    }
    row(
        count.to_string(),
        own("DAKOTA_DER_VARS", "derivative_variables"),
    );
    for (at, (label, _)) in variables.iter().enumerate() {
        row((at + 1).to_string(), format!("DVV_{}:{label}", at + 1));
    }
    row(
        "0".to_owned(),
        own("DAKOTA_AN_COMPS", "analysis_components"),
    );
    row(evaluation.to_string(), own("DAKOTA_EVAL_ID", "eval_id"));
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_form_says_the_same() {
        let variables = [("k".to_owned(), 2.5), ("c".to_owned(), -1e-3)];
        let functions = ["w".to_owned()];
        let of = |form| parameters(form, &variables, &functions, 7);
        let standard = of(Form::Standard);
        let rows: Vec<Vec<&str>> = standard
            .lines()
            .map(|line| line.split_whitespace().collect())
            .collect();
        assert_eq!(rows[0], ["2", "variables"]);
        assert_eq!((crate::number(rows[1][0]), rows[1][1]), (Some(2.5), "k"));
        assert_eq!(rows.last().unwrap(), &["7", "eval_id"]);
        assert_eq!(rows.len(), 1 + 2 + 1 + 1 + 1 + 2 + 1 + 1);
        assert!(of(Form::Aprepro).contains("{ k = 2.5"));
        let object: serde_json::Value = serde_json::from_str(&of(Form::Json)).unwrap();
        assert_eq!(object["variables"][1]["value"], -1e-3);
    }
}
