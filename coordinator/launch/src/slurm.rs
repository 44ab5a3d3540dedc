//! Workers on Slurm: one per node of an allocation, started by one batch script passed to `sbatch`.
use super::{
    plan::{LaunchPlan, PlanPart, PlanStep, STEP, StepInput},
    program::Program,
    shell::{line, lines, settings},
    worker_options::WorkerOptions,
};
use support::Problem;

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

/// Returns the batch script: requeued if a node fails, with a signal to the workers half a minute before the
/// time limit.
fn script(order: &WorkerOptions, program: &Program, name: Option<&str>) -> String {
    let path = program.path.display().to_string();
    let mut worker = vec!["srun".to_owned(), path.clone()];
    worker.extend(order.arguments());
    let (mut keys, mut see) = (String::new(), format!("test -x {}", line(&[path])));
    if let (Some(folder), Some(name)) = (&order.tls, name) {
        let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.clone());
        let folder = line(&[folder.join(name).display().to_string()]);
        see = format!("{see}\ntest -r {folder}/worker.key");
        keys = format!(" --tls {folder}");
    }
    let slots = if order.slots.is_some() {
        ""
    } else {
        " --slots \"${SLURM_CPUS_ON_NODE:-1}\""
    };
    format!(
        "#!/bin/bash -l\n\
         #SBATCH --job-name=horsehead-workers\n\
         #SBATCH --ntasks-per-node=1\n\
         #SBATCH --exclusive\n\
         #SBATCH --requeue\n\
         #SBATCH --signal=TERM@30\n\
         {}set -eu\n\
         # both must lie where this node sees them\n\
         {see}\n\
         exec {}{slots}{keys}\n",
        lines(&order.prologue),
        line(&worker),
    )
}
