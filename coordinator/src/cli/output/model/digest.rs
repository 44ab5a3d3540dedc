//! Digest of a simulation: equal digests mean bitwise equal results.
use protocol::job::{Counters, Reached, Verdict};

/// BLAKE3 digest over the outcome of a simulation, its counters, and every number of its curves, little
/// endian.
#[derive(Debug)]
pub(crate) struct Digest(blake3::Hasher);

impl Digest {
    /// Begins the digest of a simulation from its verdict; for a failed simulation this includes the load or
    /// time fraction that was reached.
    pub(crate) fn of(verdict: Verdict) -> Self {
        let mut digest = Self(blake3::Hasher::new());
        if let Verdict::Failed { reached, .. } = verdict {
            let (Reached::LoadFraction(share) | Reached::TimeFraction(share)) = reached;
            digest.number(share);
        }
        digest
    }

    /// Adds the bit pattern of a number to the digest.
    pub(crate) fn number(&mut self, value: f64) {
        self.bytes(&value.to_bits().to_le_bytes());
    }

    /// Adds a curve to the digest, preceded by its length.
    pub(crate) fn curve(&mut self, curve: &[f64]) {
        self.number(curve.len() as f64);
        for value in curve {
            self.number(*value);
        }
    }

    pub(crate) fn bytes(&mut self, bytes: &[u8]) {
        self.0.update(bytes);
    }

    /// Adds counters and verdict, and returns the digest as 64 hexadecimal digits.
    pub(crate) fn end(mut self, verdict: Verdict, counters: &Counters) -> String {
        for (_, _, count) in counters.labelled() {
            self.bytes(&count.to_le_bytes());
        }
        let word = match &verdict {
            Verdict::Complete => "complete",
            Verdict::Failed { kind, .. } => kind.as_str(),
        };
        self.bytes(word.as_bytes());
        self.0.finalize().to_hex().to_string()
    }
}
