//! Entry point of `horsehead-worker`: see [`worker::program`].
use std::process::ExitCode;

fn main() -> ExitCode {
    worker::program::run(worker::SIMULATORS)
}
