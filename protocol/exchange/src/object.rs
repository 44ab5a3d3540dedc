//! Extraction of numbers from a JSON object.
use crate::Problem;
use serde_json::Value;

/// Returns the number, or the list of numbers, at a JSON pointer (`/results/force`) or under a key of the
/// top-level object.
///
/// # Errors
/// The text is not JSON, the place does not exist, or a value is not a finite number.
pub fn values(file: &str, text: &str, place: &str) -> Result<Vec<f64>, Problem> {
    let problem = |line, found: String| Problem {
        file: file.to_owned(),
        line,
        found,
        allowed: format!("JSON with a number or a list of numbers at `{place}`"),
        remedy: "check the program's results file, and correct the place in the case".to_owned(),
    };
    let whole: Value = serde_json::from_str(text)
        .map_err(|error| problem(Some(error.line()), error.to_string()))?;
    let found = if place.is_empty() || place.starts_with('/') {
        whole.pointer(place)
    } else {
        whole.get(place)
    };
    let found = found.ok_or_else(|| problem(None, "nothing there".to_owned()))?;
    let list = found
        .as_array()
        .map_or_else(|| std::slice::from_ref(found), Vec::as_slice);
    let number = |value: &Value| {
        let number = value.as_f64().filter(|value| value.is_finite());
        number.ok_or_else(|| problem(None, crate::problem::clip(&value.to_string())))
    };
    let values = list
        .iter()
        .map(number)
        .collect::<Result<Vec<f64>, Problem>>()?;
    if values.is_empty() {
        return Err(problem(None, "an empty list".to_owned()));
    }
    Ok(values)
}

#[cfg(test)]
mod tests {
    use super::values;

    #[test]
    fn numbers_and_lists_are_found() {
        let text = r#"{"a": 1.5, "b": {"c": [1, 2, 3e2]}, "d": ["x"], "e": []}"#;
        assert_eq!(values("f", text, "a").unwrap(), [1.5]);
        assert_eq!(values("f", text, "/b/c").unwrap(), [1.0, 2.0, 300.0]);
        for (text, place, words) in [
            (text, "z", "nothing there"),
            (text, "d", "\"x\""),
            (text, "e", "empty list"),
            ("{\"a\": 1", "a", "line 1"),
            ("", "a", "EOF"),
        ] {
            let error = values("f", text, place).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        }
    }
}
