//! Names of things that travel: numbers that cannot be mistaken for one another.
//!
//! An id is only a name: this module knows neither who hands them out nor what they stand for.
use serde::{Deserialize, Serialize};
use std::fmt;

/// Declares a number that is a name.
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
    /// One unit of work of a run; handed out by whoever asks for the work, from 0 on.
    JobId(u64),
    "{}"
);
number!(
    /// One try at a job; grows with each offer of the same job, from 0 on.
    AttemptId(u32),
    "{}"
);
number!(
    /// One worker process; drawn when it starts, so that a restarted worker is another one.
    WorkerId(u64),
    "{:016x}"
);
number!(
    /// One run, in whichever coordinator process; drawn when its journal is begun.
    RunId(u64),
    "{:016x}"
);

/// BLAKE3 hash of some bytes: their name wherever they are kept.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct ContentHash(pub [u8; 32]);

impl ContentHash {
    /// The name of `bytes`.
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

/// A new number that no one else has drawn: mixes what differs between processes and moments.
///
/// The caller supplies both, because this crate reads no clock: `place` names the process
/// (host, pid), `nanos` the moment.
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
