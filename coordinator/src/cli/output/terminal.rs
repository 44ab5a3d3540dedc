//! Printing: results on standard output, everything else on standard error.
use crate::cli::argument::output::Output;
use serde::Serialize;
use std::{
    fmt,
    io::{self, IsTerminal as _, Write as _},
};

/// Sends warnings of the machinery to standard error; `HORSEHEAD_LOG` asks for more or less, as
/// `HORSEHEAD_LOG=info`. The bus itself is silent by default: it reports as errors what happens
/// whenever a session ends.
pub(crate) fn diagnostics() {
    let filter = tracing_subscriber::EnvFilter::try_from_env("HORSEHEAD_LOG")
        .unwrap_or_else(|_| tracing_subscriber::EnvFilter::new("warn,zenoh=off"));
    tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_writer(io::stderr)
        .with_ansi(io::stderr().is_terminal() && !colourless())
        .with_target(false)
        .without_time()
        .init();
}

/// Prints a line for people on standard error. A reader that has gone is nobody's problem.
pub(crate) fn tell(text: &str) {
    let _gone = writeln!(io::stderr().lock(), "{text}");
}

/// Prints notes for people on standard error, a line each.
pub(crate) fn note(notes: &[impl fmt::Display]) {
    for note in notes {
        tell(&format!("note: {note}"));
    }
}

/// Prints a result: a table for people or one object for programs.
pub(crate) fn print(
    output: Output,
    table: impl FnOnce() -> String,
    object: &impl Serialize,
) -> anyhow::Result<()> {
    let text = match output {
        Output::Table => {
            let mut text = table();
            if !text.ends_with('\n') {
                text.push('\n');
            }
            text
        }
        Output::Json => {
            let mut text = serde_json::to_string(object)?;
            text.push('\n');
            text
        }
    };
    write(&text)
}

/// Writes to standard output; a reader that has gone, as `head`, is no error.
pub(crate) fn write(text: &str) -> anyhow::Result<()> {
    let mut stdout = io::stdout().lock();
    match stdout
        .write_all(text.as_bytes())
        .and_then(|()| stdout.flush())
    {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(error.into()),
        Ok(()) | Err(_) => Ok(()),
    }
}

/// Whether tables may use bold type: only on a terminal, and not where `NO_COLOR` is set.
pub(crate) fn styled() -> bool {
    io::stdout().is_terminal() && !colourless()
}

fn colourless() -> bool {
    std::env::var_os("NO_COLOR").is_some_and(|set| !set.is_empty())
}
