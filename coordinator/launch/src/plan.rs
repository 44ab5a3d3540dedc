//! What a launch does, as plain data, and the same as a shell script for people.
use super::shell::line;
use std::{fmt, path::PathBuf};

/// Ends a text that a command reads in a printed plan.
const END: &str = "HORSEHEAD_END";

/// What a command reads.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Input {
    /// Nothing.
    Nothing,
    /// A text.
    Text(String),
    /// A file.
    File(PathBuf),
    /// What another command writes: so key material reaches its place without being in the plan.
    Command(Vec<String>),
}

/// One step.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Step {
    /// Make a file, and the folders above it.
    Write {
        /// Where.
        path: PathBuf,
        /// What is in it.
        content: String,
    },
    /// Run a command.
    Run {
        /// What it is for, as in "cannot WHAT".
        what: String,
        /// The command and its arguments.
        command: Vec<String>,
        /// What it reads.
        input: Input,
        /// It is run only if the step before it that [`Step::Run::asks`] was answered so.
        only_if: Option<String>,
        /// What it writes is an answer for later steps.
        asks: bool,
        /// What to do if it fails.
        remedy: String,
    },
}

/// Steps at one place, in order; a step that fails ends them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// The place, as a host.
    pub place: String,
    /// What is there at the end, as "joined as worker-01".
    pub then: String,
    /// The steps.
    pub steps: Vec<Step>,
}

/// A launch: some steps first, then any number of parts that do not wait for one another.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Plan {
    /// On this machine, before everything else.
    pub first: Vec<Step>,
    /// At every place.
    pub parts: Vec<Part>,
}

/// The plan as a script of the POSIX shell that does the same, one place after the other.
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

/// A text that ends with its last line.
fn whole_lines(text: &str) -> String {
    let end = if text.is_empty() || text.ends_with('\n') {
        ""
    } else {
        "\n"
    };
    format!("{text}{end}")
}
