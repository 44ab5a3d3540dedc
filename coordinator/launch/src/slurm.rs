//! Workers on Slurm: one per node of an allocation, started by one batch script passed to `sbatch`.
use super::{
    plan::{LaunchPlan, PlanPart, PlanStep, STEP, StepInput},
    program::Program,
    shell::{line, lines, settings},
    worker_options::WorkerOptions,
};
use support::Problem;

/// Batch script of workers, whose settings come from the environment.
const SCRIPT: &str = include_str!("../../../deploy/slurm/workers.sbatch");
/// Line of the script after which settings are inserted; the users' shell lines go before it, since they may not
/// survive it.
const STRICT: &str = "set -euo pipefail\n";
/// Line of the script that starts the workers.
const WORKER: &str = "exec srun --export=ALL horsehead-worker --slots \"${SLURM_CPUS_ON_NODE:-1}\" --idle-timeout 600\n";

/// Plans the submission of a batch job; `--slurm` accepts every long option of `sbatch`.
///
/// `options` is `nodes=4,time=02:00:00`; `arguments` are passed to `sbatch` unchanged. The program and the
/// key folder must be visible on all nodes; the key folder `name` of one worker serves them all.
///
/// # Errors
/// If the options are not `KEY=VALUE`.
pub fn up(
    order: &WorkerOptions,
    options: &str,
    arguments: &[String],
    program: &Program,
    name: Option<&str>,
) -> Result<LaunchPlan, Problem> {
    let mut command = vec!["sbatch".to_owned()];
    for (key, value) in settings("--slurm", options, &[])? {
        let counts = |part: &str| !part.is_empty() && part.chars().all(|c| c.is_ascii_digit());
        if key == "nodes" && !value.split('-').all(counts) {
            return Err(Problem::new(
                format!("--slurm {options}: nodes={value} is no number of nodes"),
                "write how many, as nodes=4, or between which numbers, as nodes=2-4",
            ));
        }
        command.push(format!("--{key}={value}"));
    }
    command.extend(arguments.iter().cloned());
    let nodes = command
        .iter()
        .find_map(|word| word.strip_prefix("--nodes="));
    Ok(LaunchPlan {
        local_steps: Vec::new(),
        parts: vec![PlanPart {
            place: "Slurm".to_owned(),
            success_message: format!(
                "a job with workers on {} was handed in; `squeue --me` shows it, `scancel` ends it",
                nodes.map_or("one node".to_owned(), |nodes| format!("{nodes} nodes"))
            ),
            steps: vec![PlanStep::Run {
                what: "hand in a job".to_owned(),
                command: command.clone(),
                input: StepInput::Text(script(order, program, name)),
                only_if: None,
                asks: false,
                limit: STEP,
                remedy: format!(
                    "check the partitions with `sinfo`; pass further options with --sbatch-arg (command: {})",
                    line(&command)
                ),
            }],
        }],
    })
}

/// Fills the batch script of `deploy/slurm`: its settings, and the program and options of the workers.
fn script(order: &WorkerOptions, program: &Program, name: Option<&str>) -> String {
    let path = line(&[program.path.display().to_string()]);
    let connect = line(&[order.connect.to_string()]);
    let keys = order.tls.as_ref().zip(name).map(|(folder, name)| {
        let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.clone());
        let folder = line(&[folder.join(name).display().to_string()]);
        format!("export HORSEHEAD_TLS={folder}\n")
    });
    let begin = [
        &lines(&order.prologue),
        STRICT,
        &format!("export HORSEHEAD_CONNECT={connect}\n"),
        &keys.unwrap_or_default(),
    ]
    .concat();
    let slots = order.slots.map_or_else(
        || "\"${SLURM_CPUS_ON_NODE:-1}\"".to_owned(),
        |slots| slots.to_string(),
    );
    let idle = order
        .idle_timeout
        .map_or_else(String::new, |idle| format!(" --idle-timeout {idle}"));
    let worker = format!(
        "# it must lie where this node sees it\ntest -x {path}\nexec srun --export=ALL {path} --slots {slots}{idle}\n"
    );
    SCRIPT.replace(STRICT, &begin).replace(WORKER, &worker)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that everything that is replaced in the script stands in it.
    #[test]
    fn the_script_has_what_is_filled_in() {
        assert!(SCRIPT.contains(STRICT) && SCRIPT.ends_with(WORKER));
    }
}
