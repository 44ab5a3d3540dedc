//! Reader of the Dakota results file that a driver writes.
use crate::{Problem, number, problem::clip};

/// Result of an evaluation as reported by a driver.
#[derive(Clone, Debug, PartialEq)]
pub enum Results {
    /// Value of each response function and, if the file contains them, gradients.
    Values {
        /// Values of the response functions, in the order of the functions.
        values: Vec<f64>,
        /// Derivatives of each function with respect to the variables; empty if the file contains none.
        gradients: Vec<Vec<f64>>,
    },
    /// Failed evaluation: the file begins with `fail`.
    Fail,
}

/// Reads a results file: `value [label]` for each function, then `[ gradient ]`; Hessians (`[[ .. ]]`) are
/// ignored. Labels are compared without regard to case.
///
/// # Errors
/// Too few or too many values, a label that does not match its function, or a number that is not finite.
pub fn results(file: &str, text: &str, functions: &[String]) -> Result<Results, Problem> {
    let first = text.trim_start();
    let is_fail = first
        .get(..4)
        .is_some_and(|word| word.eq_ignore_ascii_case("fail"));
    if is_fail {
        return Ok(Results::Fail);
    }
    // a label may have brackets itself
    let mut lines = text.split_inclusive('\n');
    let before = lines
        .by_ref()
        .take_while(|line| !line.trim_start().starts_with('['));
    let (values, rest) = text.split_at(before.map(str::len).sum());
    let lines = values
        .lines()
        .enumerate()
        .filter(|(_, line)| !line.trim().is_empty());
    let mut read = Vec::new();
    for (at, line) in lines {
        let refused = |found: String, allowed: String| {
            Problem::at(
                file,
                at + 1,
                found,
                allowed,
                "check the program's results file",
            )
        };
        let mut words = line.split_whitespace();
        let value = words.next().and_then(number).ok_or_else(|| {
            refused(
                format!("`{}`", clip(line)),
                "a finite number, with or without its label".to_owned(),
            )
        })?;
        let Some(function) = functions.get(read.len()) else {
            return Err(refused(
                "one value more".to_owned(),
                format!("{} values", functions.len()),
            ));
        };
        if let Some(label) = words
            .next()
            .filter(|label| !label.eq_ignore_ascii_case(function))
        {
            return Err(refused(
                format!("label `{}`", clip(label)),
                format!("`{function}`"),
            ));
        }
        read.push(value);
    }
    if read.len() < functions.len() {
        return Err(Problem {
            file: file.to_owned(),
            line: None,
            found: format!("{} values", read.len()),
            allowed: format!("{} values, one for each function", functions.len()),
            remedy: "check that the program has finished writing the file".to_owned(),
        });
    }
    Ok(Results::Values {
        gradients: gradients(file, rest, read.len())?,
        values: read,
    })
}

/// Parses the gradients, which are lists of the same length in single brackets: none, or one for each function. Stops at the
/// first Hessian.
fn gradients(file: &str, text: &str, functions: usize) -> Result<Vec<Vec<f64>>, Problem> {
    let plain = text.split("[[").next().unwrap_or_default();
    let lists = plain.split('[').skip(1);
    let list = |list: &str| {
        let inside = list.split(']').next().unwrap_or_default();
        let numbers = inside.split_whitespace().map(number);
        numbers
            .collect::<Option<Vec<f64>>>()
            .ok_or_else(|| Problem {
                file: file.to_owned(),
                line: None,
                found: format!("gradient `[{}]`", clip(list)),
                allowed: "finite numbers between brackets".to_owned(),
                remedy: "check the program's results file".to_owned(),
            })
    };
    let all: Vec<Vec<f64>> = lists.map(list).collect::<Result<_, Problem>>()?;
    let [first, ..] = all.as_slice() else {
        return Ok(all);
    };
    let length = first.len();
    if all.len() == functions && all.iter().all(|own| own.len() == length) {
        return Ok(all);
    }
    Err(Problem {
        file: file.to_owned(),
        line: None,
        found: format!("{} gradients, the first of {length} entries", all.len()),
        allowed: format!("{functions} gradients of the same length, one for each function"),
        remedy: "check the program's results file".to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_and_gradients_are_read_and_a_failure_is_one() {
        let functions = ["w1".to_owned(), "w2".to_owned()];
        let of = |text: &str| results("r", text, &functions);
        let expected = Results::Values {
            values: vec![1.5, 2000.0],
            gradients: vec![vec![1.0, 2.0], vec![3.0, 4.0]],
        };
        assert_eq!(
            of(" 1.5 W1\n2.0D3\n[ 1 2 ]\n[3 4]\n[[ 1 2 3 4 ]]\n"),
            Ok(expected)
        );
        assert_eq!(of(" FAIL: no convergence\n"), Ok(Results::Fail));
        for (text, words) in [
            ("", "0 values"),
            ("1.5\n", "1 values"),
            ("1\n2\n3\n", "one value more"),
            ("1 w2\n2\n", "label `w2`"),
            ("nan\n2\n", "line 1"),
            ("1\n2\n[ x ]\n", "gradient"),
            ("1\n2\n[ 1 2 ]\n", "1 gradients"),
            ("1\n2\n[ 1 2 ]\n[ 3 ]\n", "of the same length"),
        ] {
            let error = of(text).unwrap_err().to_string();
            assert!(error.contains(words), "{text:?}: {error}");
        }
    }
}
