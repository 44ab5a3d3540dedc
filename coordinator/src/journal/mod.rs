//! The append-only record of a run: what is in it is true, and nothing else is.
//!
//! ```text
//! record:  "HHJ1" | length u32 | crc32 u32 of length and body | body (an encoded Event)
//! ```
//!
//! Each record carries its own mark and checksum, so that a flipped byte, a zeroed block or a
//! torn tail costs the records it touched and no other. Readers are folds over the events
//! ([`fold`]). The writer ([`Journal`]) holds a lock, so that one run has one writer.
mod read;
mod write;

pub use read::{Damage, Entry, ReadReport, fold};
pub use write::{Appended, Begun, Journal};

use protocol::{event::RunHeader, wire::WireError};
use std::{io, path::PathBuf};

/// Name of the journal within a run's folder.
pub const FILE: &str = "journal.hhj";
/// Name of the lock within a run's folder.
pub const LOCK: &str = "lock";

const MARK: [u8; 4] = *b"HHJ1";
/// Bytes before a record's body.
const RECORD_HEADER: usize = 12;

/// Why a journal cannot be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum JournalError {
    /// A file cannot be read or written.
    #[error("cannot {doing} {}: {source}", path.display())]
    Io {
        /// What was tried.
        doing: &'static str,
        /// On what.
        path: PathBuf,
        /// The system's words.
        source: io::Error,
    },
    /// Another coordinator writes this run.
    #[error(
        "the run {} is in use by another coordinator: wait for it, stop it, or choose another run \
         folder",
        folder.display()
    )]
    Locked {
        /// The run's folder.
        folder: PathBuf,
    },
    /// The run was begun with something else.
    #[error(
        "the run {} was begun with another {}; choose another run folder, or repeat the command \
         as it was",
        folder.display(), what.join(", another ")
    )]
    Differs {
        /// The run's folder.
        folder: PathBuf,
        /// What differs, with both values.
        what: Vec<String>,
    },
    /// The first record, which says what the run is, is lost.
    #[error(
        "the journal {} has lost its first record, so it cannot be continued: choose another run \
         folder",
        path.display()
    )]
    Headless {
        /// The journal.
        path: PathBuf,
    },
    /// A record cannot be encoded or decoded.
    #[error(transparent)]
    Wire(#[from] WireError),
    /// The journal's thread has ended.
    #[error("the journal is closed")]
    Closed,
}

/// What differs between two runs, in words.
fn differences(was: &RunHeader, is: &RunHeader) -> Vec<String> {
    let mut what = Vec::new();
    if was.kind != is.kind {
        what.push(format!("command ({}, now {})", was.kind, is.kind));
    }
    if was.case != is.case {
        let (was, is) = (was.case.to_string(), is.case.to_string());
        let short = |hash: &str| hash.get(..12).unwrap_or_default().to_owned();
        what.push(format!(
            "case (content {}, now {})",
            short(&was),
            short(&is)
        ));
    }
    if was.settings != is.settings {
        what.extend(setting_differences(&was.settings, &is.settings));
    }
    what
}

fn setting_differences(was: &str, is: &str) -> Vec<String> {
    let read = |text: &str| serde_json::from_str::<serde_json::Map<_, _>>(text).ok();
    let (Some(was_map), Some(is_map)) = (read(was), read(is)) else {
        return vec![format!("setting ({was}, now {is})")];
    };
    let names: std::collections::BTreeSet<&String> = was_map.keys().chain(is_map.keys()).collect();
    let show = |value: Option<&serde_json::Value>| {
        value.map_or_else(|| "none".to_owned(), ToString::to_string)
    };
    names
        .into_iter()
        .filter(|name| was_map.get(*name) != is_map.get(*name))
        .map(|name| {
            format!(
                "{name} ({}, now {})",
                show(was_map.get(name)),
                show(is_map.get(name))
            )
        })
        .collect()
}

#[cfg(test)]
mod tests;
