//! Identifiers used in messages, as distinct types so that they cannot be confused.
//!
//! This module is independent of how ids are assigned and of what they denote.
use serde::{Deserialize, Serialize};
use std::fmt;

/// Declares an identifier type that wraps a number, with its display format.
macro_rules! number {
    ($(#[$doc:meta])* $name:ident($inner:ty), $format:literal) => {
        $(#[$doc])*
        #[derive(
            Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
        )]
        pub struct $name(pub $inner);

        impl fmt::Display for $name {
            fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(to, $format, self.0)
            }
        }
    };
}

number!(
    /// Id of a job of a run; assigned by the caller that requests the job, from 0.
    JobId(u64),
    "{}"
);
number!(
    /// Number of an attempt at a job; increases with each dispatch of the job, from 0.
    AttemptId(u32),
    "{}"
);
number!(
    /// Id of a worker process; drawn when the process starts, so that a restarted worker has a new id.
    WorkerId(u64),
    "{:016x}"
);

impl AttemptId {
    /// Attempt id of a failure that the coordinator itself records, without any dispatch to a worker.
    pub const COORDINATOR: Self = Self(u32::MAX);

    /// Creates the id of an attempt from the epoch (number of the coordinator process, from 1) and the number of
    /// earlier dispatches of the job by that process; ids of different processes of a run never coincide.
    pub const fn new(epoch: u32, number: u32) -> Self {
        Self(epoch << 16 | (number & 0xffff))
    }

    /// Returns the epoch and the number of which [`AttemptId::new`] made the id; `None` for a failure that the
    /// coordinator itself recorded.
    pub fn epoch_and_number(self) -> Option<(u32, u32)> {
        (self != Self::COORDINATOR).then_some((self.0 >> 16, self.0 & 0xffff))
    }
}
number!(
    /// Id of a run, the same in all its coordinator processes; drawn when its journal is created.
    RunId(u64),
    "{:016x}"
);

/// BLAKE3 hash of a content (case, job, file), by which the content is identified wherever it is stored.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct ContentHash(pub [u8; 32]);

impl ContentHash {
    /// Computes the hash of `bytes`.
    pub fn of(bytes: &[u8]) -> Self {
        Self(*blake3::hash(bytes).as_bytes())
    }
}

impl fmt::Display for ContentHash {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(to, "{byte:02x}"))
    }
}

impl fmt::Debug for ContentHash {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(to, "ContentHash({self})")
    }
}

/// Draws a number that is unique with overwhelming probability, by hashing the process and the time.
///
/// The caller supplies both, because this crate reads no clock: `place` identifies the process (host, pid),
/// `nanos` the time.
pub fn draw(place: &str, nanos: u128) -> u64 {
    let mut hasher = blake3::Hasher::new();
    hasher.update(place.as_bytes());
    hasher.update(&nanos.to_le_bytes());
    let mut first = [0; 8];
    hasher.finalize_xof().fill(&mut first);
    u64::from_le_bytes(first)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_are_shown_as_people_write_them() {
        assert_eq!(JobId(17).to_string(), "17");
        assert_eq!(WorkerId(0xab).to_string(), "00000000000000ab");
        let hash = ContentHash::of(b"");
        assert_eq!(
            hash.to_string(),
            "af1349b9f5f9a1a6a0404dea36dcc9499bcb25c9adc112b7cc9a93cae41f3262"
        );
    }

    #[test]
    fn drawn_numbers_differ_in_place_and_moment() {
        assert_ne!(draw("a:1", 5), draw("a:1", 6));
        assert_ne!(draw("a:1", 5), draw("a:2", 5));
        assert_eq!(draw("a:1", 5), draw("a:1", 5));
    }
}
