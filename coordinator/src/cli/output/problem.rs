//! Error output of commands: message, causes, remedies and the exit code.
use case::CaseError;
use run::{message, session::interrupt::INTERRUPTED};
use std::process::ExitCode;
use study::{EvaluatorError, StudyError};
use support::Problem;

/// Line of exit codes at the end of every command's help.
pub(crate) const EXIT_CODES: &str =
    "Exit codes: 0 done, 1 failed, 2 usage or bad input, 130 interrupted.";

const FAILED: u8 = 1;
/// Exit code of a wrong command line or wrong input, such as a [`Problem`].
pub(crate) const BAD_INPUT: u8 = 2;
/// Prints an error with its causes and remedies, and returns its exit code.
pub(crate) fn explain(error: &anyhow::Error) -> ExitCode {
    message::print(&describe(error));
    ExitCode::from(code(error))
}

/// Error messages of the standard library about unparsable numbers, each with its replacement in plain words.
const NUMBERS: [(&str, &str); 6] = [
    ("invalid digit found in string", "not a whole number"),
    ("invalid float literal", "not a number"),
    (
        "cannot parse integer from empty string",
        "there is no number",
    ),
    ("cannot parse float from empty string", "there is no number"),
    ("number too large to fit in target type", "it is too large"),
    ("number too small to fit in target type", "it is too small"),
];

/// Replaces the standard library's number parsing messages in a command line error by plain words; `None` if
/// it contains none of them.
pub(crate) fn in_plain_words(message: &str) -> Option<String> {
    let replace = |text: String, (from, to): &(&str, &str)| text.replace(from, to);
    let plain = NUMBERS.iter().fold(message.to_owned(), replace);
    (plain != message).then_some(plain)
}

fn code(error: &anyhow::Error) -> u8 {
    let mut code = FAILED;
    for cause in error.chain() {
        if cause.is::<Problem>() || cause.is::<CaseError>() {
            code = BAD_INPUT;
        }
        match cause.downcast_ref::<StudyError>() {
            Some(
                StudyError::Settings(_)
                | StudyError::Column { .. }
                | StudyError::Misconfigured { .. },
            ) => code = BAD_INPUT,
            Some(StudyError::Interrupted) => code = INTERRUPTED,
            _ => {}
        }
    }
    code
}

/// Formats an error as `error:` with its causes, followed by `help:` lines.
fn describe(error: &anyhow::Error) -> String {
    let mut causes: Vec<String> = error.chain().map(ToString::to_string).collect();
    causes.dedup();
    let mut text = format!("error: {}", causes.join("\n  caused by: "));
    for cause in error.chain() {
        let study = cause
            .downcast_ref::<StudyError>()
            .and_then(StudyError::help);
        let evaluator = cause
            .downcast_ref::<EvaluatorError>()
            .and_then(|e| e.help.clone());
        let problem = cause
            .downcast_ref::<Problem>()
            .map(|problem| problem.remedy.clone());
        for help in study
            .or(evaluator)
            .or(problem)
            .into_iter()
            .filter(|help| !help.is_empty())
        {
            let line = format!("\nhelp: {help}");
            if !text.contains(&line) {
                text.push_str(&line);
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use anyhow::Context as _;

    #[test]
    fn causes_and_remedies_are_told_and_the_code_tells_whose_fault_it_is() {
        let usage = Problem {
            message: "no such condition".into(),
            remedy: "it has: 5rpm".into(),
        };
        let error = Err::<(), _>(usage).context("cannot verify").unwrap_err();
        assert_eq!(
            describe(&error),
            "error: cannot verify\n  caused by: no such condition\nhelp: it has: 5rpm"
        );
        assert_eq!(code(&error), 2);
        let lost = EvaluatorError {
            message: "no worker".into(),
            help: Some("start one".into()),
            can_go_on: true,
        };
        let error = anyhow::Error::from(StudyError::from(lost));
        assert_eq!(describe(&error), "error: no worker\nhelp: start one");
        assert_eq!(code(&error), 1);
        assert_eq!(code(&anyhow::Error::from(StudyError::Interrupted)), 130);
    }
}
