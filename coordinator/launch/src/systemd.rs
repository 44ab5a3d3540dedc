//! Launcher of a worker on this machine as a unit of the user's systemd, restarted with the machine.
use super::{
    plan::{LaunchPlan, PlanPart, PlanStep, STEP, StepInput},
    program::Program,
    shell::{line, settings},
    worker_options::WorkerOptions,
};
use std::path::{Path, PathBuf};
use support::Problem;

/// Name of the systemd unit.
const UNIT: &str = "horsehead-worker.service";

/// Plans to write the unit below `configuration` (`~/.config`) and to start it; `options` may be `slots=N`,
/// and `name` is the worker's key folder.
///
/// # Errors
/// If the options cannot be parsed.
pub fn up(
    order: &WorkerOptions,
    options: &str,
    program: &Program,
    name: Option<&str>,
    configuration: &Path,
) -> Result<LaunchPlan, Problem> {
    let mut order = order.clone();
    for (key, value) in settings("--systemd", options, &["slots"])? {
        let slots = value.parse().ok().filter(|n| (1..=4096).contains(n));
        order.slots = Some(slots.ok_or_else(|| {
            Problem::new(
                format!("--systemd {key}={value}: not a number of slots"),
                "write slots=N with N from 1 to 4096",
            )
        })?);
    }
    let systemctl = |what: &str, words: &[&str]| PlanStep::Run {
        what: what.to_owned(),
        command: ["systemctl", "--user"]
            .iter()
            .chain(words)
            .map(|word| (*word).to_owned())
            .collect(),
        input: StepInput::Nothing,
        only_if: None,
        asks: false,
        limit: STEP,
        remedy: "see that `systemctl --user status` works here; deploy/systemd has a unit for the \
                 whole machine"
            .to_owned(),
    };
    Ok(LaunchPlan {
        local_steps: Vec::new(),
        parts: vec![PlanPart {
            place: "this machine".to_owned(),
            success_message: format!(
                "{UNIT} runs; `journalctl --user -u {UNIT}` shows its log, `loginctl \
                 enable-linger` keeps it when you log out"
            ),
            steps: vec![
                PlanStep::Write {
                    path: configuration.join("systemd/user").join(UNIT),
                    content: unit(&order, program, name),
                },
                systemctl("have systemd read the unit", &["daemon-reload"]),
                systemctl("enable the unit", &["enable", UNIT]),
                systemctl("start the unit", &["restart", UNIT]),
            ],
        }],
    })
}

fn unit(order: &WorkerOptions, program: &Program, name: Option<&str>) -> String {
    let mut words = vec![program.path.display().to_string()];
    words.extend(order.arguments());
    if let (Some(folder), Some(name)) = (&order.tls, name) {
        let folder = std::path::absolute(folder).unwrap_or_else(|_| PathBuf::from(folder));
        words.extend(["--tls".to_owned(), folder.join(name).display().to_string()]);
    }
    // a percent sign is systemd's own
    let command = line(&words).replace('%', "%%");
    format!(
        "[Unit]\n\
         Description=Horsehead worker: computes simulations for a coordinator\n\
         \n\
         [Service]\n\
         ExecStart={command}\n\
         Restart=on-failure\n\
         RestartSec=5\n\
         # exit status 3: the coordinator refused this build or this certificate, or ended it\n\
         RestartPreventExitStatus=3\n\
         Nice=10\n\
         NoNewPrivileges=yes\n\
         LockPersonality=yes\n\
         RestrictRealtime=yes\n\
         SystemCallArchitectures=native\n\
         \n\
         [Install]\n\
         WantedBy=default.target\n"
    )
}
