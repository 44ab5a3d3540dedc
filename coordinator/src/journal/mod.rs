//! The append-only record of a run: what is in it is true, and nothing else is.
//!
//! ```text
//! record:  "HHJ" version | length u32 | crc32 u32 of length and body | body (an encoded Event)
//! ```
//!
//! Each record carries its own mark and checksum, so that a flipped byte, a zeroed block or a
//! torn tail costs the records it touched and no other. What the run *is* stands in the first
//! record, in every later opening's, and in a file of its own ([`HEAD`]): no single damage makes
//! a run impossible to continue. The version is that of the wire, since a record holds what came
//! over it; a journal of another one is refused as such and not taken for damage. Readers are folds over the events ([`fold`]). The writer
//! ([`Journal`]) holds a lock, so that one run has one writer; on a full disk it waits.
mod head;
mod index;
mod open;
mod read;
mod recording;
#[cfg(test)]
pub(crate) mod sample;
mod write;

pub use open::{Begun, Journal};
pub use read::{Damage, Entry, ReadReport, fold, words};
pub use recording::Recording;
pub use write::Appended;

use protocol::{
    event::RunHeader,
    wire::{VERSION, WireError},
};
use serde_json::Value;
use std::{
    collections::{BTreeMap, BTreeSet},
    io,
    path::PathBuf,
};

/// Name of the journal within a run's folder.
pub const FILE: &str = "journal.hhj";
/// Name of the copy of the journal's first record within a run's folder.
pub const HEAD: &str = "journal.head";
/// Name of the lock within a run's folder.
pub const LOCK: &str = "lock";

/// Most differing settings that are named one by one.
const MOST_NAMED: usize = 3;

/// What each record begins with; the last byte is the version, as a digit.
pub const MARK: [u8; 4] = [b'H', b'H', b'J', b'0' + VERSION];
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
    /// It was written by another version of this program.
    #[error(
        "the journal {} is of version {found}, and this build reads version {VERSION}: go on with \
         the build that began the run, or choose another run folder",
        path.display()
    )]
    Version {
        /// The journal.
        path: PathBuf,
        /// Its version.
        found: u8,
    },
    /// Every record that says what the run is, is lost, and so is the copy beside the journal.
    #[error(
        "nothing says any more what run the journal {} belongs to (every copy of its first record \
         is lost), so it cannot be continued: choose another run folder",
        path.display()
    )]
    Headless {
        /// The journal.
        path: PathBuf,
    },
    /// Somebody deleted it while the run went on.
    #[error(
        "the journal {} was deleted while the run went on: its results cannot be kept, so the run \
         stops; leave run folders alone until `horsehead` has ended",
        path.display()
    )]
    Deleted {
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
    let (was, is) = (leaves(was), leaves(is));
    let names: BTreeSet<&String> = was.keys().chain(is.keys()).collect();
    let show = |value: Option<&String>| value.map_or("none", String::as_str).to_owned();
    let mut what: Vec<String> = names
        .into_iter()
        .filter(|name| was.get(*name) != is.get(*name))
        .map(|name| {
            format!(
                "{name} ({}, now {})",
                show(was.get(name)),
                show(is.get(name))
            )
        })
        .collect();
    if what.len() > MOST_NAMED {
        let more = what.len() - MOST_NAMED;
        what.truncate(MOST_NAMED);
        what.push(format!("{more} settings more"));
    }
    if what.is_empty() {
        what.push("notation of its settings".to_owned());
    }
    what
}

/// Settings by the last words of their path, as `search.population`; a pair that begins with a
/// number is a seed with its settings.
fn leaves(text: &str) -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    match serde_json::from_str(text) {
        Ok(Value::Array(mut pair)) if pair.len() == 2 && pair[0].is_number() => {
            found.insert("seed".to_owned(), pair[0].to_string());
            collect("", &pair.swap_remove(1), &mut found);
        }
        Ok(value) => collect("", &value, &mut found),
        Err(_) => drop(found.insert("setting".to_owned(), text.to_owned())),
    }
    found
}

fn collect(path: &str, value: &Value, found: &mut BTreeMap<String, String>) {
    let below = |name: &str| match path {
        "" => name.to_owned(),
        _ => format!("{path}.{name}"),
    };
    match value {
        Value::Object(fields) => {
            for (name, value) in fields {
                collect(&below(name), value, found);
            }
        }
        Value::Array(values) => {
            for (index, value) in values.iter().enumerate() {
                collect(&below(&(index + 1).to_string()), value, found);
            }
        }
        Value::Null | Value::Bool(_) | Value::Number(_) | Value::String(_) => {
            let name = if path.is_empty() { "setting" } else { path };
            found.insert(name.to_owned(), value.to_string());
        }
    }
}

#[cfg(test)]
mod tests;
