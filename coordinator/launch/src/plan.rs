//! Launch plan as plain data, and its rendering as a shell script.
use super::shell::line;
use std::{fmt, path::PathBuf};

/// Heredoc delimiter in a printed plan.
const END: &str = "HORSEHEAD_END";

/// Standard input of a command.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Input {
    /// Empty input.
    Nothing,
    /// Literal text.
    Text(String),
    /// Content of a file.
    File(PathBuf),
    /// Output of another command; lets key material reach its destination without appearing in the plan.
    Command(Vec<String>),
}

/// Step of a plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Step {
    /// Writes a file, creating its parent folders.
    Write {
        /// Path of the file.
        path: PathBuf,
        /// Content of the file.
        content: String,
    },
    /// Runs a command.
    Run {
        /// Purpose of the command, completing "cannot WHAT".
        what: String,
        /// Command with its arguments.
        command: Vec<String>,
        /// Standard input of the command.
        input: Input,
        /// Answer that the last step with [`Step::Run::asks`] must have given for the command to run.
        only_if: Option<String>,
        /// Whether the command's output is an answer for later steps.
        asks: bool,
        /// Remedy in case of failure.
        remedy: String,
    },
}

/// Steps at one place, in order; the first failure ends them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// Name of the place, such as a host.
    pub place: String,
    /// Message on success, such as "joined as worker-01".
    pub then: String,
    /// Steps to run at the place.
    pub steps: Vec<Step>,
}

/// Launch plan: initial steps, then parts that are independent of one another.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Plan {
    /// Steps on this machine, run before all parts.
    pub first: Vec<Step>,
    /// Parts, one per place.
    pub parts: Vec<Part>,
}

/// Renders the plan as an equivalent POSIX shell script that handles the places one after the other.
impl fmt::Display for Plan {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(to, "#!/bin/sh\nset -eu")?;
        for step in &self.first {
            write!(to, "{step}")?;
        }
        for part in &self.parts {
            writeln!(to, "\n# {}", part.place)?;
            for step in &part.steps {
                write!(to, "{step}")?;
            }
        }
        Ok(())
    }
}

impl fmt::Display for Step {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Write { path, content } => {
                let file = |path: PathBuf| line(&[path.display().to_string()]);
                if let Some(folder) = path.parent() {
                    writeln!(to, "mkdir -p {}", file(folder.to_owned()))?;
                }
                writeln!(to, "cat > {} <<'{END}'", file(path.clone()))?;
                write!(to, "{}", whole_lines(content))?;
                writeln!(to, "{END}")
            }
            Self::Run {
                what,
                command,
                input,
                only_if,
                asks,
                ..
            } => {
                writeln!(to, "# {what}")?;
                if let Some(answer) = only_if {
                    writeln!(to, "if [ \"$answer\" = '{answer}' ]; then")?;
                }
                if *asks {
                    write!(to, "answer=$(")?;
                }
                if let Input::Command(from) = input {
                    write!(to, "{} | ", line(from))?;
                }
                write!(to, "{}", line(command))?;
                match input {
                    Input::Nothing => write!(to, " < /dev/null")?,
                    Input::Text(text) => {
                        write!(to, " <<'{END}'\n{}{END}\n", whole_lines(text))?;
                    }
                    Input::File(path) => {
                        write!(to, " < {}", line(&[path.display().to_string()]))?;
                    }
                    Input::Command(_) => {}
                }
                writeln!(to, "{}", if *asks { ")" } else { "" })?;
                if only_if.is_some() {
                    writeln!(to, "fi")?;
                }
                Ok(())
            }
        }
    }
}

/// Returns the text with a newline at its end, unless empty.
fn whole_lines(text: &str) -> String {
    let end = if text.is_empty() || text.ends_with('\n') {
        ""
    } else {
        "\n"
    };
    format!("{text}{end}")
}
