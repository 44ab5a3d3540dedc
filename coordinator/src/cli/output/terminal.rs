//! Terminal output: results on standard output, everything else on standard error.
use crate::cli::argument::output::Output;
use report::document::TerminalStyle;
use rustix::termios::tcgetwinsize;
use serde::Serialize;
use std::io::{self, IsTerminal as _, Write as _};

/// Sends log messages of level warning and above to standard error; `HORSEHEAD_LOG` selects another level,
/// for example `HORSEHEAD_LOG=info`. Messages of Zenoh are off by default, because it logs errors whenever a
/// session ends.
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

/// Prints a result on standard output: a text table or one JSON object.
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

/// Writes text to standard output; a pipe that its reader has closed, for example `head`, is not an error.
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

/// Returns how tables are printed: on a terminal fitted into its width, and in bold type unless `NO_COLOR` is set.
pub(crate) fn style() -> TerminalStyle {
    let stdout = io::stdout();
    if !stdout.is_terminal() {
        return TerminalStyle::default();
    }
    let size = tcgetwinsize(&stdout).ok();
    TerminalStyle {
        bold: !colourless(),
        width: size.map(|size| size.ws_col).filter(|width| *width > 0),
    }
}

fn colourless() -> bool {
    std::env::var_os("NO_COLOR").is_some_and(|set| !set.is_empty())
}
