//! Execution of a launch plan on many hosts concurrently; an error names the host, the step, the last line of
//! output and the remedy.
use super::plan::{LaunchPlan, PlanPart, PlanStep, StepInput};
use std::{
    fs::{self, File},
    io::{self, Read, Write as _},
    os::unix::process::CommandExt as _,
    path::Path,
    process::{Child, Command, ExitStatus, Output, Stdio},
    sync::{
        Mutex,
        atomic::{AtomicBool, Ordering},
        mpsc,
    },
    thread,
    time::{Duration, Instant},
};

/// Number of hosts on which a launch plan is executed concurrently; more would only compete for the outgoing
/// network of this machine.
const AT_A_TIME: usize = 32;

/// Interval at which a running command is looked at.
const LOOK: Duration = Duration::from_millis(20);

/// Cancellation of a launch plan that is being executed.
#[derive(Debug, Default)]
pub struct Cancellation {
    finishing: AtomicBool,
    killed: AtomicBool,
}

impl Cancellation {
    /// Lets the running steps end and begins no further one.
    pub fn finish(&self) {
        self.finishing.store(true, Ordering::Relaxed);
    }

    /// Kills the commands of the running steps and begins no further one.
    pub fn kill(&self) {
        self.finish();
        self.killed.store(true, Ordering::Relaxed);
    }

    fn is_finishing(&self) -> bool {
        self.finishing.load(Ordering::Relaxed)
    }

    /// Returns whether the running steps are killed.
    pub fn is_killed(&self) -> bool {
        self.killed.load(Ordering::Relaxed)
    }
}

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

/// Executes a launch plan and reports the result of each host as it ends. After a cancellation, the
/// remaining hosts are not reported.
///
/// # Errors
/// If one of the plan's initial steps on this machine fails; then nothing was done on any host.
pub fn execute_plan(
    plan: &LaunchPlan,
    cancelled: &Cancellation,
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
                    if !cancelled.is_finishing() {
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
    cancelled: &Cancellation,
) -> Result<String, LaunchError> {
    let mut answer = String::new();
    for step in steps {
        if cancelled.is_finishing() {
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
                limit,
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
                let output = call(command, input, *limit, cancelled).map_err(|error| {
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

/// Runs a command of a launch step with its standard input, waits for its end and returns its output. A command
/// that exceeds its time limit, or whose plan is cancelled, is killed and counts as failed.
fn call(
    command: &[String],
    input: &StepInput,
    limit: Duration,
    cancelled: &Cancellation,
) -> io::Result<Output> {
    let mut source = None;
    let stdin = match input {
        StepInput::Nothing => Stdio::null(),
        StepInput::Text(_) => Stdio::piped(),
        StepInput::File(path) => File::open(path)?.into(),
        StepInput::Command(words) => {
            let mut from = words_of(words)
                .stdin(Stdio::null())
                .stdout(Stdio::piped())
                .spawn()?;
            let output = from.stdout.take();
            source = Some(from);
            output.map_or_else(Stdio::null, Stdio::from)
        }
    };
    let mut child = words_of(command)
        .stdin(stdin)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        // Ctrl-C is for this program, which decides what becomes of the command
        .process_group(0)
        .spawn()?;
    if let Some(mut to) = child.stdin.take()
        && let StepInput::Text(text) = input
    {
        let text = text.clone();
        // a command that ends before it has read all says why itself
        thread::spawn(move || drop(to.write_all(text.as_bytes())));
    }
    let (stdout, stderr) = (read(child.stdout.take()), read(child.stderr.take()));
    let ends = Instant::now() + limit;
    let status = wait(&mut child, ends, cancelled);
    if let Some(mut source) = source {
        if status.is_err() {
            source.kill()?;
        }
        let supplied = source.wait()?.success();
        if !supplied && status.as_ref().is_ok_and(ExitStatus::success) {
            let message = "the command that supplies its input failed";
            return Err(io::Error::other(message));
        }
    }
    let status = status?;
    let left = || ends.saturating_duration_since(Instant::now());
    Ok(Output {
        status,
        // processes that it left behind may hold its output open
        stdout: stdout.recv_timeout(left()).unwrap_or_default(),
        stderr: stderr.recv_timeout(left()).unwrap_or_default(),
    })
}

/// Waits for the end of a command; kills it at the time `ends`, or if its plan is cancelled.
fn wait(child: &mut Child, ends: Instant, cancelled: &Cancellation) -> io::Result<ExitStatus> {
    let begun = Instant::now();
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(status);
        }
        let is_late = Instant::now() >= ends;
        if is_late || cancelled.is_killed() {
            child.kill()?;
            child.wait()?;
            let time = begun.elapsed().as_secs_f64();
            return Err(io::Error::other(if is_late {
                format!("no answer within {time:.0} s")
            } else {
                "interrupted".to_owned()
            }));
        }
        thread::sleep(LOOK);
    }
}

/// Reads an output of a command on a thread of its own; the result arrives on the returned channel.
fn read(from: Option<impl Read + Send + 'static>) -> mpsc::Receiver<Vec<u8>> {
    let (to, output) = mpsc::channel();
    thread::spawn(move || {
        let mut all = Vec::new();
        if let Some(mut from) = from {
            // what was read before an error is what there is
            drop(from.read_to_end(&mut all));
        }
        drop(to.send(all));
    });
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

#[cfg(test)]
mod tests {
    use super::{super::plan::STEP, *};
    use std::sync::Arc;

    fn words(script: &str) -> Vec<String> {
        ["sh", "-c", script].map(str::to_owned).to_vec()
    }

    /// Checks that a command that hangs ends at its limit, and at once when its plan is cancelled, also if its
    /// children hold its output open. Regression: a host whose shell hung kept the whole command from ending.
    #[test]
    fn a_command_that_hangs_is_killed_at_its_limit_and_when_its_plan_is_cancelled() {
        let hangs = words("sleep 600 & sleep 600");
        let minute = Duration::from_mins(1);
        let begun = Instant::now();
        let (nothing, never) = (StepInput::Nothing, Cancellation::default());
        let error = call(&hangs, &nothing, Duration::from_secs(1), &never).unwrap_err();
        assert_eq!(error.to_string(), "no answer within 1 s");
        let cancelled = Arc::new(Cancellation::default());
        let other = Arc::clone(&cancelled);
        let waits = thread::spawn(move || call(&hangs, &StepInput::Nothing, minute, &other));
        cancelled.finish();
        thread::sleep(Duration::from_millis(300));
        assert!(!waits.is_finished(), "what has begun may end");
        cancelled.kill();
        let error = waits.join().unwrap().unwrap_err();
        assert_eq!(error.to_string(), "interrupted");
        assert!(begun.elapsed() < minute);
    }

    #[test]
    fn a_command_gets_its_input_and_returns_its_output() {
        let text = StepInput::Text("one\n".repeat(100_000));
        let never = Cancellation::default();
        let output = call(&words("wc -l; echo bad >&2; exit 3"), &text, STEP, &never).unwrap();
        assert_eq!(output.status.code(), Some(3));
        assert_eq!(output.stdout, b"100000\n");
        assert_eq!(output.stderr, b"bad\n");
        let from = StepInput::Command(words("exit 1"));
        call(&words("cat"), &from, STEP, &never).unwrap_err();
    }
}
