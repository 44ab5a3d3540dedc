//! POSIX shell scripts run on hosts, literal and complete.
use super::super::{
    program::Program,
    shell::{line, lines},
    worker_options::WorkerOptions,
};
use std::fmt::Write as _;

/// Preamble of every script run on a host: strict error handling, private files, and the variable `home` with
/// the folder of worker files.
const HOME: &str =
    "set -eu\numask 077\nhome=${XDG_CACHE_HOME:-$HOME/.cache}/horsehead\nmkdir -p \"$home\"\n";

/// Script fragment that sets `process` to the worker's process id if the worker runs; the executable is
/// checked, since the id may have been reused.
const RUNNING: &str = r#"process=$(cat "$folder/process" 2>/dev/null || true)
case "$(readlink "/proc/${process:-none}/exe" 2>/dev/null || true)" in
"$home"/worker-*) ;;
*) process= ;;
esac
"#;

/// Script fragment that ends the worker process found by `RUNNING`, by force after five seconds.
const END: &str = r#"if [ -n "$process" ]; then
  kill "$process"
  for _ in 1 2 3 4 5; do
    if kill -0 "$process" 2>/dev/null; then sleep 1; fi
  done
  if kill -0 "$process" 2>/dev/null; then kill -9 "$process"; fi
fi
"#;

/// Returns a script that prints "have" if the right worker program is present on the host, otherwise "need
/// MACHINE", and fails if the host cannot run a worker.
pub(super) fn probe(programs: &[Program]) -> String {
    let mut script = format!("{HOME}system=$(uname -sm)\ncase \"$system\" in\n");
    let mut machines = Vec::new();
    for program in programs {
        machines.push(program.machine.as_str());
        let (machine, glibc) = (&program.machine, program.glibc_text());
        let (hash, bytes) = (&program.hash, program.bytes);
        let _written = writeln!(
            script,
            "'Linux {machine}') need={glibc} worker=$home/worker-{hash} bytes={bytes} ;;"
        );
    }
    let machines = machines.join(", ");
    let _written = write!(
        script,
        r#"*)
  echo "the host runs \"$system\", but worker programs exist only for Linux on {machines}" >&2
  exit 10
  ;;
esac
library=$(getconf GNU_LIBC_VERSION 2>/dev/null || true)
if [ "$need" != 0 ]; then
  case "$library" in
  'glibc '*) ;;
  *)
    echo "it has no glibc, and the worker needs $need" >&2
    exit 11
    ;;
  esac
  older=$(printf '%s\n' "$need" "${{library#glibc }}" | sort -V | head -n 1)
  if [ "$older" != "$need" ]; then
    echo "it has $library, and the worker needs $need" >&2
    exit 11
  fi
fi
if [ -x "$worker" ] && [ "$(wc -c < "$worker")" -eq "$bytes" ]; then
  echo have
else
  echo "need $(uname -m)"
fi
"#
    );
    script
}

/// Returns a script that receives a program on its standard input and renames it into place only when
/// complete.
pub(super) fn copy(program: &Program) -> String {
    let Program { hash, bytes, .. } = program;
    format!(
        r#"{HOME}part=$home/worker-{hash}.$$
if ! cat > "$part"; then
  rm -f "$part"
  exit 12
fi
if [ "$(wc -c < "$part")" -ne {bytes} ]; then
  echo "only $(wc -c < "$part") of {bytes} bytes arrived" >&2
  rm -f "$part"
  exit 12
fi
chmod 700 "$part"
mv "$part" "$home/worker-{hash}"
"#
    )
}

/// Returns a script that starts the worker detached in a session of its own. It leaves a worker running that
/// has the same command line, or that was launched by another owner.
pub(super) fn start(order: &WorkerOptions, folder: &str, programs: &[Program]) -> String {
    let mut choice = String::from("case \"$(uname -m)\" in\n");
    for Program { machine, hash, .. } in programs {
        let _written = writeln!(choice, "{machine}) worker=$home/worker-{hash} ;;");
    }
    let arguments = line(&order.arguments());
    let tls = order.tls.as_deref().map_or("", |_| " --tls \"$folder\"");
    format!(
        r#"{prologue}{HOME}{choice}esac
folder=$home/{folder}
mkdir -p "$folder"
chmod 700 "$folder"
set -- "$worker" {arguments}{tls} --status "$folder/status"
{RUNNING}owner={owner}
if [ -n "$process" ]; then
  if [ "$(cat "$folder/command")" = "$*" ]; then
    echo "it runs already, as process $process" >&2
    exit 0
  fi
  if [ -n "$owner" ] && [ "$(cat "$folder/owner" 2>/dev/null || true)" != "$owner" ]; then
    echo "it runs already, launched by somebody else, as process $process" >&2
    exit 0
  fi
fi
{END}echo "$*" > "$folder/command"
echo "$owner" > "$folder/owner"
rm -f "$folder/status"
cd /
setsid nohup "$@" > "$folder/log" 2>&1 < /dev/null &
echo $! > "$folder/process"
"#,
        prologue = lines(&order.prologue),
        owner = line(std::slice::from_ref(&order.owner)),
    )
}

/// Returns a script that waits until the worker states that the coordinator has admitted it, or has ended; the
/// process may be missing during the first second. On failure it says what the worker states, or else the last
/// line of its log.
pub(super) fn watch(folder: &str, wait_s: u64) -> String {
    format!(
        r#"{HOME}folder=$home/{folder}
waited=0
while :; do
  status=$(cat "$folder/status" 2>/dev/null || true)
  case "$status" in
  admitted) exit 0 ;;
  ended*) waited={wait_s} ;;
  esac
  {running}  if [ "$waited" -ge {wait_s} ] || {{ [ -z "$process" ] && [ "$waited" -ge 2 ]; }}; then
    if [ -n "$status" ]; then echo "$status" >&2; else tail -n 1 "$folder/log" >&2; fi
    exit 13
  fi
  sleep 1
  waited=$((waited + 1))
done
"#,
        running = RUNNING.replace('\n', "\n  ").trim_end_matches(' '),
    )
}

/// Returns a script that ends the workers in those folders whose names end with `mark`: those launched by
/// `owner` (empty for workers that no run owns), or all of them.
pub(super) fn end(mark: &str, owner: Option<&str>) -> String {
    let others = owner.map_or_else(String::new, |owner| {
        let owner = line(&[owner.to_owned()]);
        format!(
            "if [ \"$(cat \"$folder/owner\" 2>/dev/null || true)\" != {owner} ]; then\n  continue\nfi\n"
        )
    });
    format!(
        r#"{HOME}for folder in "$home"/worker-*{mark}/; do
{others}{RUNNING}{END}done
"#
    )
}

/// Returns a script that shows the end of the worker logs.
pub(super) fn tail() -> String {
    format!("{HOME}tail -n 100 \"$home\"/worker-*/log\n")
}

/// Returns a script that unpacks a worker's keys from a tar archive on its standard input.
pub(super) fn take_keys(folder: &str) -> String {
    format!(
        "{HOME}mkdir -p \"$home/{folder}\"\nchmod 700 \"$home/{folder}\"\n\
         tar -xf - -C \"$home/{folder}\"\n"
    )
}
