//! Workers on hosts that `ssh` reaches: through the user's own `ssh`, with his configuration.
//!
//! On a host everything lies below `~/.cache/horsehead` (or `$XDG_CACHE_HOME`), for its owner alone:
//! programs by the hash of their content, copied once, and a folder per worker with its keys, log,
//! process and command line.
use super::{
    error::NodeError,
    host::Host,
    keys,
    order::Order,
    plan::{Input, Part, Plan, Step},
    program::Program,
    words::{line, lines},
};
use link::keys::{CA, WORKER};
use std::fmt::Write as _;

/// Options of every call: nothing is ever asked at the terminal, and a host that does not answer, or no
/// longer, ends the call.
const OPTIONS: [&str; 4] = [
    "BatchMode=yes",
    "ConnectTimeout=15",
    "ServerAliveInterval=5",
    "ServerAliveCountMax=3",
];

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

/// Brings up one worker per host, each with the program of its machine and keys of its own, and watches
/// for `wait_s` seconds that it takes part (0: not at all).
///
/// # Errors
/// [`NodeError`] if there are no keys for a host, or a host is named twice.
pub fn up(
    order: &Order,
    hosts: &[Host],
    programs: &[Program],
    wait_s: u64,
) -> Result<Plan, NodeError> {
    for (at, host) in hosts.iter().enumerate() {
        if hosts
            .iter()
            .take(at)
            .any(|other| other.to_string() == host.to_string())
        {
            return Err(NodeError::new(
                format!("{host} is named twice"),
                "a host has one worker with a slot for each of its cores",
            ));
        }
    }
    let (names, first) = match &order.tls {
        Some(folder) => keys::assign(folder, hosts)?,
        None => {
            let names = (1..=hosts.len()).map(|number| format!("worker-{number:02}"));
            (names.collect(), Vec::new())
        }
    };
    let parts = hosts.iter().zip(names).map(|(host, name)| {
        let order = Order {
            slots: host.slots.or(order.slots),
            ..order.clone()
        };
        part(&order, host, &name, programs, wait_s)
    });
    Ok(Plan {
        first,
        parts: parts.collect(),
    })
}

fn part(order: &Order, host: &Host, name: &str, programs: &[Program], wait_s: u64) -> Part {
    let mut steps = vec![Step::Run {
        what: "see whether a worker can run there".to_owned(),
        command: shell(host, "sh -s"),
        input: Input::Text(probe(programs)),
        only_if: None,
        asks: true,
        remedy: "name a program for it with --worker-program ARCH=PATH; deploy/portable.sh builds \
                 one for older systems"
            .to_owned(),
    }];
    steps.extend(programs.iter().map(|program| Step::Run {
        what: "copy the worker there".to_owned(),
        command: shell(host, &given(&copy(program))),
        input: Input::File(program.path.clone()),
        only_if: Some(format!("need {}", program.machine)),
        asks: false,
        remedy: "make room in its ~/.cache/horsehead, or set XDG_CACHE_HOME there".to_owned(),
    }));
    if let Some(folder) = &order.tls {
        let from = folder.join(name).display().to_string();
        let tar = ["tar", "-C", &from, "-cf", "-", CA, WORKER[0], WORKER[1]];
        let script = format!(
            "{HOME}mkdir -p \"$home/{name}\"\nchmod 700 \"$home/{name}\"\ntar -xf - -C \"$home/{name}\"\n"
        );
        steps.push(Step::Run {
            what: format!("give it the keys of {name}"),
            command: shell(host, &given(&script)),
            input: Input::Command(tar.map(str::to_owned).to_vec()),
            only_if: None,
            asks: false,
            remedy: format!("see what `horsehead keys check {from}` says; the host needs tar"),
        });
    }
    // what loads modules is written for bash and for logins
    let reader = if order.prologue.is_empty() {
        "sh -s"
    } else {
        "bash -l -s"
    };
    steps.push(Step::Run {
        what: "start the worker".to_owned(),
        command: shell(host, reader),
        input: Input::Text(start(order, name, programs)),
        only_if: None,
        asks: false,
        remedy: format!("see {}", log_command(host)),
    });
    if wait_s > 0 {
        steps.push(Step::Run {
            what: "see that it takes part in a run".to_owned(),
            command: shell(host, "sh -s"),
            input: Input::Text(watch(name, wait_s)),
            only_if: None,
            asks: false,
            remedy: format!(
                "it was started; its coordinator must run and be reached at {} from there. See {}",
                order.connect,
                log_command(host)
            ),
        });
    }
    Part {
        place: host.to_string(),
        then: if wait_s > 0 {
            format!("takes part as {name}")
        } else {
            format!("started as {name}")
        },
        steps,
    }
}

/// Ends the workers of hosts, whatever their names.
pub fn down(hosts: &[Host]) -> Plan {
    let script = format!("{HOME}for folder in \"$home\"/worker-*/; do\n{RUNNING}{END}done\n");
    let parts = hosts.iter().map(|host| Part {
        place: host.to_string(),
        then: "its workers have ended".to_owned(),
        steps: vec![Step::Run {
            what: "end its workers".to_owned(),
            command: shell(host, "sh -s"),
            input: Input::Text(script.clone()),
            only_if: None,
            asks: false,
            remedy: "its workers end by themselves only with --idle-timeout".to_owned(),
        }],
    });
    Plan {
        first: Vec::new(),
        parts: parts.collect(),
    }
}

/// The command that shows the end of what a host's workers said.
pub fn logs(host: &Host) -> Vec<String> {
    let script = format!("{HOME}tail -n 100 \"$home\"/worker-*/log\n");
    shell(host, &given(&script))
}

/// What a person types to see it.
fn log_command(host: &Host) -> String {
    format!("`horsehead workers logs --ssh {host}`")
}

/// A call of ssh with a command for the host's login shell.
fn shell(host: &Host, command: &str) -> Vec<String> {
    let mut words = vec!["ssh".to_owned()];
    for option in OPTIONS {
        words.extend(["-o".to_owned(), option.to_owned()]);
    }
    if let Some(port) = host.port {
        words.extend(["-p".to_owned(), port.to_string()]);
    }
    words.extend([host.target.clone(), command.to_owned()]);
    words
}

/// A script as a command, for calls whose input is something else.
fn given(script: &str) -> String {
    line(&["sh".to_owned(), "-c".to_owned(), script.to_owned()])
}

/// Answers "have" or "need MACHINE"; fails where no worker runs.
fn probe(programs: &[Program]) -> String {
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
fn copy(program: &Program) -> String {
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

/// Starts the worker in a session of its own; one that runs with the same command line goes on.
fn start(order: &Order, name: &str, programs: &[Program]) -> String {
    let mut choice = String::from("case \"$(uname -m)\" in\n");
    for Program { machine, hash, .. } in programs {
        let _written = writeln!(choice, "{machine}) worker=$home/worker-{hash} ;;");
    }
    let arguments = line(&order.arguments());
    let tls = order.tls.as_deref().map_or("", |_| " --tls \"$folder\"");
    format!(
        r#"{prologue}{HOME}{choice}esac
folder=$home/{name}
mkdir -p "$folder"
chmod 700 "$folder"
set -- "$worker" {arguments}{tls}
{RUNNING}if [ -n "$process" ] && [ "$(cat "$folder/command")" = "$*" ]; then
  echo "it runs already, as process $process" >&2
  exit 0
fi
{END}echo "$*" > "$folder/command"
cd /
setsid nohup "$@" > "$folder/log" 2>&1 < /dev/null &
echo $! > "$folder/process"
"#,
        prologue = lines(&order.prologue),
    )
}

/// Waits until the worker says that it takes part, or has ended; in its first second it may not be
/// there yet.
fn watch(name: &str, wait_s: u64) -> String {
    format!(
        r#"{HOME}folder=$home/{name}
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
