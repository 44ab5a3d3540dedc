//! Launch plan as plain data, and its rendering as a shell script.
use super::shell::line;
use std::{fmt, path::PathBuf, time::Duration};

/// Heredoc delimiter in a printed plan.
const END: &str = "HORSEHEAD_END";

/// Maximum time for a command of a launch plan that transfers little and waits for nothing.
pub(super) const STEP: Duration = Duration::from_mins(2);

/// Standard input of a command.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StepInput {
    /// Empty standard input.
    Nothing,
    /// Literal text, passed to the command as standard input.
    Text(String),
    /// Content of a file, passed to the command as standard input.
    File(PathBuf),
    /// Output of another command, by which key material reaches its destination without appearing in the
    /// plan.
    Command(Vec<String>),
}

/// Step of a launch plan: a file to write or a command to run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PlanStep {
    /// Writes a file, creating its parent folders.
    Write {
        /// Path of the file.
        path: PathBuf,
        /// Content of the file.
        content: String,
    },
    /// Runs a command.
    Run {
        /// Purpose of the command as a verb phrase that completes the error message "cannot WHAT".
        what: String,
        /// Command with its arguments.
        command: Vec<String>,
        /// Standard input of the command.
        input: StepInput,
        /// Output that the last command with [`PlanStep::Run::asks`] must have had for this command to run;
        /// `None` to run always.
        only_if: Option<String>,
        /// Whether the command's output decides which later steps run (see [`PlanStep::Run::only_if`]).
        asks: bool,
        /// Maximum time for the command, after which it is killed and counts as failed.
        limit: Duration,
        /// Advice to the user if the command fails.
        remedy: String,
    },
}

/// Steps of a launch plan for one host, in order; the first failure ends them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlanPart {
    /// Display name of the target on which the steps are executed, such as a host name.
    pub place: String,
    /// Message shown when all steps have succeeded, such as "joined as worker-01".
    pub success_message: String,
    /// Steps to execute for this target, in order.
    pub steps: Vec<PlanStep>,
}

/// Launch plan: initial steps on this machine, then one part per host; the parts are independent of one
/// another.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LaunchPlan {
    /// Steps run on this machine before those of all hosts.
    pub local_steps: Vec<PlanStep>,
    /// Steps for each host, one [`PlanPart`] per host.
    pub parts: Vec<PlanPart>,
}

/// Renders the plan as an equivalent POSIX shell script that handles the hosts one after the other.
impl fmt::Display for LaunchPlan {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(to, "#!/bin/sh\nset -eu")?;
        for step in &self.local_steps {
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

impl fmt::Display for PlanStep {
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
                if let StepInput::Command(from) = input {
                    write!(to, "{} | ", line(from))?;
                }
                write!(to, "{}", line(command))?;
                match input {
                    StepInput::Nothing => write!(to, " < /dev/null")?,
                    StepInput::Text(text) => {
                        write!(to, " <<'{END}'\n{}{END}\n", whole_lines(text))?;
                    }
                    StepInput::File(path) => {
                        write!(to, " < {}", line(&[path.display().to_string()]))?;
                    }
                    StepInput::Command(_) => {}
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
