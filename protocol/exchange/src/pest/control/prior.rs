//! Parser of prior information: `name factor * log(parameter) + factor * parameter = value weight group`.
use super::model::{PriorInformation, PriorTerm};
use crate::{Problem, number, problem::clip};

/// Parses one item of prior information, including its name; `refused` builds the error from the text found
/// and a description of the allowed text.
pub(super) fn read(
    text: &str,
    refused: &dyn Fn(String, &str) -> Problem,
) -> Result<PriorInformation, Problem> {
    const FORM: &str = "`name factor * log(parameter) + .. = value weight group`";
    let wrong = || refused(format!("`{}`", clip(text)), FORM);
    let (left, right) = text.split_once('=').ok_or_else(wrong)?;
    let (name, sum) = left
        .trim()
        .split_once(char::is_whitespace)
        .ok_or_else(wrong)?;
    let right: Vec<&str> = right.split_whitespace().collect();
    let [value, weight, group] = right[..] else {
        return Err(wrong());
    };
    let [Some(value), Some(weight)] = [value, weight].map(number) else {
        return Err(wrong());
    };
    Ok(PriorInformation {
        name: name.to_lowercase(),
        terms: terms(sum).ok_or_else(wrong)?,
        value,
        weight,
        group: group.to_lowercase(),
    })
}

/// Parses the left-hand side of a prior information equation: `factor * parameter` terms joined by `+` or
/// `-`.
fn terms(sum: &str) -> Option<Vec<PriorTerm>> {
    let mut terms = Vec::new();
    let mut words = sum.split_whitespace().flat_map(separate);
    let mut sign = 1.0;
    while let Some(word) = words.next() {
        if let ("+" | "-", false) = (word.as_str(), terms.is_empty()) {
            if word == "-" {
                sign = -sign;
            }
            continue;
        }
        let factor = number(&word)?;
        if words.next()? != "*" {
            return None;
        }
        let parameter = words.next()?.to_lowercase();
        let inside = parameter
            .strip_prefix("log(")
            .and_then(|rest| rest.strip_suffix(')'));
        terms.push(PriorTerm {
            factor: sign * factor,
            parameter: inside.unwrap_or(&parameter).trim().to_owned(),
            log: inside.is_some(),
        });
        sign = 1.0;
    }
    (!terms.is_empty()).then_some(terms)
}

/// Splits a word at `*`: `2.0*par` becomes `2.0`, `*`, `par`.
fn separate(word: &str) -> Vec<String> {
    let mut parts = Vec::new();
    for (at, part) in word.split('*').enumerate() {
        if at > 0 {
            parts.push("*".to_owned());
        }
        if !part.is_empty() {
            parts.push(part.to_owned());
        }
    }
    parts
}
