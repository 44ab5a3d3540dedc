//! Worker program that simulates oscillators, used only by the test suites and never shipped.
use oscillator::simulator::Oscillators;
use std::process::ExitCode;

fn main() -> ExitCode {
    worker::program::run(&[&Oscillators])
}
