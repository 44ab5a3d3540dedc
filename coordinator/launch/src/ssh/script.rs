//! What hosts are told: scripts of the POSIX shell, whole and literal.
use super::super::{
    program::Program,
    shell::{line, lines},
    worker_options::WorkerOptions,
};
use std::fmt::Write as _;

/// What every script on a host begins with.
const HOME: &str =
    "set -eu\numask 077\nhome=${XDG_CACHE_HOME:-$HOME/.cache}/horsehead\nmkdir -p \"$home\"\n";

/// Sets `process` to the worker's process, if it runs: a number alone may have become another's.
const RUNNING: &str = r#"process=$(cat "$folder/process" 2>/dev/null || true)
case "$(readlink "/proc/${process:-none}/exe" 2>/dev/null || true)" in
"$home"/worker-*) ;;
*) process= ;;
esac
"#;

/// Ends that process, by force if it does not within five seconds.
const END: &str = r#"if [ -n "$process" ]; then
  kill "$process"
  for _ in 1 2 3 4 5; do
    if kill -0 "$process" 2>/dev/null; then sleep 1; fi
  done
  if kill -0 "$process" 2>/dev/null; then kill -9 "$process"; fi
fi
"#;

/// Answers "have" or "need MACHINE"; fails where no worker runs.
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
  echo "it is a machine of \"$system\", and there are workers for Linux on {machines} alone" >&2
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

/// Takes a program from its input; half a program never lies under its name.
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

/// Starts the worker in a session of its own; one that runs with the same command line goes on, and so does one that
/// a run finds and has not launched.
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
set -- "$worker" {arguments}{tls}
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
cd /
setsid nohup "$@" > "$folder/log" 2>&1 < /dev/null &
echo $! > "$folder/process"
"#,
        prologue = lines(&order.prologue),
        owner = line(std::slice::from_ref(&order.owner)),
    )
}

/// Waits until the worker says that it takes part, or has ended; in its first second it may not be
/// there yet.
pub(super) fn watch(folder: &str, wait_s: u64) -> String {
    format!(
        r#"{HOME}folder=$home/{folder}
waited=0
while ! grep -q 'admitted run=' "$folder/log"; do
  {running}  if [ "$waited" -ge {wait_s} ] || {{ [ -z "$process" ] && [ "$waited" -ge 2 ]; }}; then
    tail -n 1 "$folder/log" >&2
    exit 13
  fi
  sleep 1
  waited=$((waited + 1))
done
"#,
        running = RUNNING.replace('\n', "\n  ").trim_end_matches(' '),
    )
}

/// Ends the workers in the folders of a host whose names end like `mark`, of those only what `owner` has launched; all
/// of them if both are empty.
pub(super) fn end(mark: &str, owner: &str) -> String {
    let owner = line(&[owner.to_owned()]);
    format!(
        r#"{HOME}owner={owner}
for folder in "$home"/worker-*{mark}/; do
if [ -n "$owner" ] && [ "$(cat "$folder/owner" 2>/dev/null || true)" != "$owner" ]; then
  continue
fi
{RUNNING}{END}done
"#
    )
}

/// Shows the end of what its workers said.
pub(super) fn tail() -> String {
    format!("{HOME}tail -n 100 \"$home\"/worker-*/log\n")
}

/// Takes a worker's keys, as tar writes them, from its input.
pub(super) fn take_keys(folder: &str) -> String {
    format!(
        "{HOME}mkdir -p \"$home/{folder}\"\nchmod 700 \"$home/{folder}\"\n\
         tar -xf - -C \"$home/{folder}\"\n"
    )
}
