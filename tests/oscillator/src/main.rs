//! A worker that simulates oscillators: the suites' own, never shipped.
use oscillator::simulator::Oscillators;
use std::process::ExitCode;

fn main() -> ExitCode {
    worker::program::run(&[&Oscillators])
}
