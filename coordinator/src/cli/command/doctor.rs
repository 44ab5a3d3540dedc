//! `horsehead doctor`: finds the layer of the connection between workers and a coordinator that fails, and
//! its remedy.
use crate::cli::{
    argument::{
        case::{case_folder, load_case},
        output::OutputChoice,
    },
    output::{problem::EXIT_CODES, terminal},
};
use clap::Args;
use dispatch::runtime::{local_socket, locate::worker_program};
use launch::doctor::{Check, Layer, dial, listen, program};
use link::locator::Locator;
use run::session::dispatcher;
use serde::Serialize;
use std::path::PathBuf;

/// Say why workers do not reach a coordinator: the layer that fails, and the remedy.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Examples:
  horsehead doctor
  horsehead doctor --connect quic/head.example:7447 --tls worker-01
  horsehead doctor --listen quic/0.0.0.0:7447 --tls keys
  horsehead doctor --listen quic/0.0.0.0:7447 --tls keys --case cases/cyjs10-5-37hb

On a worker's machine, with the folder of a worker, --connect takes the steps that a worker
takes, up to the first word of a coordinator that runs. On the coordinator's machine, before it
runs, --listen looks whether it could listen there. Without either it looks whether this machine
can run workers of its own. Layers: case, program, certificate, clock, name, route, port,
firewall, version. Exit code 1 where one fails.

{EXIT_CODES}"))]
pub(super) struct Arguments {
    /// Address that workers dial.
    #[arg(long, value_name = "LOCATOR", env = "HORSEHEAD_CONNECT", conflicts_with = "listen", value_parser = Locator::parse)]
    connect: Option<Locator>,
    /// Address at which the coordinator is to listen.
    #[arg(long, value_name = "LOCATOR", env = "HORSEHEAD_LISTEN", value_parser = Locator::parse)]
    listen: Option<Locator>,
    /// Key material: of a worker with --connect, of the coordinator with --listen.
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_TLS")]
    tls: Option<PathBuf>,
    /// Case folder to check first.
    #[arg(long, value_name = "CASE", env = "HORSEHEAD_CASE", value_parser = case_folder)]
    case: Option<PathBuf>,
    #[command(flatten)]
    output: OutputChoice,
}

/// JSON object printed by `horsehead doctor --output json`.
#[derive(Debug, Serialize)]
struct DoctorOutput {
    /// Side that was checked: `worker`, `coordinator`, or `machine` if no address was given.
    side: &'static str,
    locator: String,
    /// Whether all checked layers of the connection work.
    healthy: bool,
    /// Result for each layer of the connection, in the order of checking; checking stops at the first
    /// failure.
    checks: Vec<Check>,
}

/// Checks the layers of the connection and prints the findings.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let mut checks = Vec::new();
    if let Some(case) = &arguments.case {
        checks.push(match load_case(case, None) {
            Ok(loaded) => Check::good(Layer::Case, loaded.case.name),
            Err(error) => {
                let remedy =
                    "`horsehead case check CASE` says more; correct the file that is named";
                Check::bad(Layer::Case, error.to_string(), remedy)
            }
        });
    }
    let tls = arguments.tls.as_deref();
    // without an address, what runs on this machine alone needs
    let (_folder, here) = local_socket()?;
    let (side, at) = match (&arguments.connect, &arguments.listen) {
        (_, Some(at)) => ("coordinator", at),
        (Some(at), None) => ("worker", at),
        (None, None) => ("machine", &here),
    };
    if side == "machine" {
        checks.push(program(worker_program()));
    }
    if checks.iter().all(|check| check.healthy) {
        checks.extend(match side {
            "coordinator" | "machine" => listen(at, tls),
            _ => dispatcher::block_on(async { Ok(dial(at, tls).await) })?,
        });
    }
    let object = DoctorOutput {
        side,
        locator: at.to_string(),
        healthy: checks.iter().all(|check| check.healthy),
        checks,
    };
    terminal::print(arguments.output.output, || table(&object), &object)?;
    match object.checks.iter().find(|check| !check.healthy) {
        Some(failed) => Err(anyhow::anyhow!(
            "{} fails: {}",
            failed.layer.as_str(),
            failed.found
        )),
        None => Ok(()),
    }
}

fn table(object: &DoctorOutput) -> String {
    let line = |check: &Check| {
        let state = if check.healthy { "ok" } else { "FAILS" };
        let mut text = format!("{:<12} {state:<6} {}\n", check.layer.as_str(), check.found);
        if !check.remedy.is_empty() {
            text.extend(["             remedy ", &check.remedy, "\n"]);
        }
        text
    };
    object.checks.iter().map(line).collect()
}
