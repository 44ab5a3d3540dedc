//! Execution of a launch plan on many hosts concurrently; an error names the host, the step, the last line of
//! output and the remedy.
use super::plan::{LaunchPlan, PlanPart, PlanStep, StepInput};
use std::{
    fs::{self, File},
    io::{self, Write as _},
    path::Path,
    process::{Child, Command, Output, Stdio},
    sync::{
        Mutex,
        atomic::{AtomicBool, Ordering},
    },
    thread,
};

/// Number of hosts on which a launch plan is executed concurrently; more would only compete for the outgoing
/// network of this machine.
const AT_A_TIME: usize = 32;

/// Failure of a step of a launch plan on one host.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{place}: cannot {step}: {why}")]
pub struct LaunchError {
    /// Host on which the step failed, or "this machine".
    pub place: String,
    /// Purpose of the failed step, as a verb phrase that completes the error message "cannot STEP".
    pub step: String,
    /// Last line of the step's error output, or its exit status.
    pub why: String,
    /// Advice to the user on how to remedy the failure.
    pub remedy: String,
}

/// Executes a launch plan and reports the result of each host as it ends. Once `cancelled` is set, no further
/// step starts, and the remaining hosts are not reported.
///
/// # Errors
/// If one of the plan's initial steps on this machine fails; then nothing was done on any host.
pub fn execute_plan(
    plan: &LaunchPlan,
    cancelled: &AtomicBool,
    tell: &(impl Fn(&PlanPart, Result<(), LaunchError>) + Sync),
) -> Result<(), LaunchError> {
    run("this machine", &plan.local_steps, cancelled)?;
    let waiting = Mutex::new(plan.parts.iter());
    let next = || {
        let mut waiting = waiting
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner);
        waiting.next()
    };
    thread::scope(|scope| {
        for _ in 0..plan.parts.len().min(AT_A_TIME) {
            scope.spawn(|| {
                while let Some(part) = next() {
                    let ended = run(&part.place, &part.steps, cancelled);
                    if !cancelled.load(Ordering::Relaxed) {
                        tell(part, ended.map(drop));
                    }
                }
            });
        }
    });
    Ok(())
}

/// Runs the steps of a plan for one host in order; returns the output of the last step with
/// [`Step::Run::asks`] set.
pub(super) fn run(
    place: &str,
    steps: &[PlanStep],
    cancelled: &AtomicBool,
) -> Result<String, LaunchError> {
    let mut answer = String::new();
    for step in steps {
        if cancelled.load(Ordering::Relaxed) {
            break;
        }
        match step {
            PlanStep::Write { path, content } => {
                write(path, content).map_err(|error| LaunchError {
                    place: place.to_owned(),
                    step: format!("write {}", path.display()),
                    why: error.to_string(),
                    remedy: "choose a folder for which you have write permission".to_owned(),
                })?;
            }
            PlanStep::Run { only_if, .. } if only_if.as_ref().is_some_and(|it| *it != answer) => {}
            PlanStep::Run {
                what,
                command,
                input,
                asks,
                remedy,
                ..
            } => {
                let failed = |why: String, remedy: String| LaunchError {
                    place: place.to_owned(),
                    step: what.clone(),
                    why,
                    remedy,
                };
                let program = command.first().map_or("", String::as_str);
                let output = call(command, input).map_err(|error| {
                    if error.kind() != io::ErrorKind::NotFound {
                        return failed(error.to_string(), remedy.clone());
                    }
                    failed(
                        format!("there is no {program} on this machine"),
                        format!(
                            "install {program}, or carry out what --dry-run prints where there is one"
                        ),
                    )
                })?;
                if !output.status.success() {
                    let said = String::from_utf8_lossy(&output.stderr);
                    let why = last_line(&said, output.status.code());
                    let remedy = refusal(program, &said).map_or(remedy.clone(), str::to_owned);
                    return Err(failed(why, remedy));
                }
                if *asks {
                    String::from_utf8_lossy(&output.stdout)
                        .trim()
                        .clone_into(&mut answer);
                }
            }
        }
    }
    Ok(answer)
}

fn write(path: &Path, content: &str) -> io::Result<()> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
    }
    fs::write(path, content)
}

/// Runs a command of a launch step with its standard input, waits for its end and returns its output.
fn call(command: &[String], input: &StepInput) -> io::Result<Output> {
    let mut from = None;
    let stdin = match input {
        StepInput::Nothing => Stdio::null(),
        StepInput::Text(_) => Stdio::piped(),
        StepInput::File(path) => File::open(path)?.into(),
        StepInput::Command(words) => {
            let mut source = words_of(words)
                .stdin(Stdio::null())
                .stdout(Stdio::piped())
                .spawn()?;
            let output = source.stdout.take();
            from = Some(source);
            output.map_or_else(Stdio::null, Stdio::from)
        }
    };
    let mut child = words_of(command)
        .stdin(stdin)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()?;
    let writer = child.stdin.take().map(|mut to| {
        let text = match input {
            StepInput::Text(text) => text.clone(),
            StepInput::Nothing | StepInput::File(_) | StepInput::Command(_) => String::new(),
        };
        // a command that ends before it has read all says why itself
        thread::spawn(move || drop(to.write_all(text.as_bytes())))
    });
    let output = child.wait_with_output();
    drop(writer.map(thread::JoinHandle::join));
    let source = from.as_mut().map(Child::wait).transpose()?;
    if source.is_some_and(|status| !status.success())
        && output.as_ref().is_ok_and(|o| o.status.success())
    {
        return Err(io::Error::other(
            "the command that supplies its input failed",
        ));
    }
    output
}

fn words_of(words: &[String]) -> Command {
    let mut words = words.iter();
    let mut command = Command::new(words.next().map_or("", String::as_str));
    command.args(words);
    command
}

/// Returns the last non-empty line of a command's error output, or else its exit status as text.
fn last_line(said: &str, code: Option<i32>) -> String {
    let line = said.lines().map(str::trim).rfind(|line| !line.is_empty());
    line.map_or_else(
        || match code {
            Some(code) => format!("exit status {code}"),
            None => "it was killed".to_owned(),
        },
        str::to_owned,
    )
}

/// Returns a remedy for known errors of ssh and for full disks, found in a command's output, whose last line
/// alone does not explain them.
fn refusal(program: &str, said: &str) -> Option<&'static str> {
    let has = |words: &str| said.contains(words);
    if has("No space left on device") || has("Disk quota exceeded") {
        return Some("make room in its ~/.cache/horsehead");
    }
    if program != "ssh" {
        return None;
    }
    if has("REMOTE HOST IDENTIFICATION HAS CHANGED") {
        return Some(
            "the host key has changed: ask its administrator; if the host was reinstalled, run \
             `ssh-keygen -R HOST` and log in once by hand",
        );
    }
    if has("Host key verification failed") {
        return Some(
            "the host key is unknown: log in once with `ssh HOST` and verify the fingerprint",
        );
    }
    if has("Permission denied") {
        return Some(
            "the host requires a password, and launches never prompt for one: run `ssh-copy-id HOST`, or start \
             ssh-agent and `ssh-add`",
        );
    }
    if has("Could not resolve hostname") {
        return Some("check the host name, or add an entry to ~/.ssh/config");
    }
    if has("Connection refused") || has("timed out") || has("No route to host") {
        return Some(
            "check with `ssh HOST true` that the host is running, and check its port and firewall",
        );
    }
    None
}
